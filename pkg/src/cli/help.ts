// The texts of `veronese help` and `--help`.

import { ALWAYS, COMMANDS, type CommandName, type CommandText, OPTIONS, optionsOf } from './commands.js';

const WIDTH = 100;
/** Where texts begin beside names, and where they begin below them. */
const COLUMN = 30;

/** `bold` marks headings. */
export function help(what: CommandName | 'all' | undefined, bold: (text: string) => string): string {
  if (what === undefined) return overview(bold);
  if (what !== 'all') return ofCommand(what, bold);
  const commands = Object.keys(COMMANDS) as CommandName[];
  return [overview(bold), ...commands.map((name) => ofCommand(name, bold))].join('\n\n');
}

function overview(bold: (text: string) => string): string {
  const commands = Object.entries(COMMANDS).map(([name, { about }]) => beside(name, about, 14));
  return `${filled('veronese segments video frames by motion: how many motions there are, what each one is, and which pixels follow it.', '')}

${bold('Usage:')} veronese COMMAND [options]

${bold('Commands:')}
${commands.join('\n')}

${bold('Options of all commands:')}
${ALWAYS.map((name) => optionLine({ ...OPTIONS[name], name })).join('\n')}

'veronese help COMMAND' shows its options and examples, 'veronese --help' those of all.

Results are printed as JSON, everything else to standard error.
Exit codes: 0 done, 1 the input could not be processed, 2 wrong usage, 130 cancelled.
`;
}

function ofCommand(name: CommandName, bold: (text: string) => string): string {
  const { usage, about, more, examples }: CommandText = COMMANDS[name];
  const lines = usage.map((words, k) => `${k === 0 ? bold('Usage:') : '      '} veronese ${name} ${words}`);
  return `veronese ${name}: ${about}

${lines.join('\n')}
${more === undefined ? '' : `\n${filled(more, '')}\n`}
${bold('Options:')}
${optionsOf(name).map(optionLine).join('\n')}

${bold('Examples:')}
${examples.map(([purpose, line]) => `  ${purpose}:\n    ${line}`).join('\n')}
`;
}

type Line = ReturnType<typeof optionsOf>[number];

function optionLine({ name, short, value, text, default: otherwise }: Line): string {
  const names = `${short === undefined ? '   ' : `-${short},`} --${name}${value === undefined ? '' : ` ${value}`}`;
  return beside(names, typeof otherwise === 'string' ? `${text} (default: ${otherwise})` : text, COLUMN);
}

/** A name, and its text in a column of its own. */
function beside(name: string, text: string, column: number): string {
  const indent = ' '.repeat(column);
  const first = `  ${name}`;
  const lines = filled(text, indent);
  return first.length < column - 1 ? first + lines.slice(first.length) : `${first}\n${lines}`;
}

/** Lines of at most WIDTH letters. */
function filled(text: string, indent: string): string {
  const lines = [indent];
  for (const word of text.split(' ')) {
    const line = lines.at(-1) as string;
    if (line.length > indent.length && line.length + 1 + word.length > WIDTH) lines.push(indent + word);
    else lines[lines.length - 1] = line.length > indent.length ? `${line} ${word}` : line + word;
  }
  return lines.join('\n');
}
