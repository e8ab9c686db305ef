// What makes a shell complete the words of the program.
// cspell:ignore compdef compgen compreply cword esac funcstack

import { COMMANDS, type CommandName, optionsOf, SHELLS, valuesOf } from './commands.js';

type Shell = (typeof SHELLS)[number];

const names = Object.keys(COMMANDS) as CommandName[];
const commands = names.map((name) => ({ name, about: COMMANDS[name].about, options: optionsOf(name) }));
type Option = (typeof commands)[number]['options'][number];

const flags = ({ name, short }: Option): string[] => [...(short === undefined ? [] : [`-${short}`]), `--${name}`];
/** A text to its first halt. */
const brief = ({ text }: Option): string => text.replace(/[;:(].*/, '').trim();
/** Quoted for any of the shells. */
const quoted = (text: string, shell: Shell): string => `'${text.replaceAll("'", shell === 'fish' ? "\\'" : "'\\''")}'`;

export function completion(shell: Shell): string {
  return { bash, zsh, fish }[shell]();
}

/** What completes to nothing is a place, which bash knows. */
function bash(): string {
  const each = <T>(items: readonly T[], line: (item: T) => string): string => items.map((item) => `    ${line(item)}\n`).join('');
  const reply = (words: readonly string[]): string => `COMPREPLY=($(compgen -W '${words.join(' ')}' -- "$word"))`;
  const listed = [...new Map(commands.flatMap(({ options }) => options).map((option) => [option.name, option])).values()];
  const valued = listed.filter(({ type }) => type === 'string');
  return `_veronese() {
  local word="\${COMP_WORDS[COMP_CWORD]}" before="\${COMP_WORDS[COMP_CWORD-1]}" command="\${COMP_WORDS[1]}"
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    ${reply([...names, 'help', '--help', '--version'])}
    return
  fi
  case "$before" in
${each(valued, (option) => `${flags(option).join('|')}) ${valuesOf(option).length > 0 ? `${reply(valuesOf(option))}; ` : ''}return ;;`)}  esac
  case "$command $word" in
${each(commands, ({ name, options }) => `"${name} -"*) ${reply(options.map((option) => `--${option.name}`))} ;;`)}    "completion "*) ${reply(SHELLS)} ;;
    "help "*) ${reply(names)} ;;
  esac
}
complete -o default -F _veronese veronese
`;
}

function zsh(): string {
  const option = (one: Option): string => {
    const words = valuesOf(one);
    const places = one.value === 'DIR' ? '_files -/' : one.value === 'FILE' ? '_files' : ' ';
    const value = one.type === 'string' ? `:${one.value}:${words.length > 0 ? `(${words.join(' ')})` : places}` : '';
    const all = flags(one);
    return `${all.length > 1 ? `'(${all.join(' ')})'{${all.join(',')}}` : `'${all[0]}'`}${quoted(`[${brief(one)}]${value}`, 'zsh')}`;
  };
  const rest = (name: CommandName): string => (name === 'completion' ? `':shell:(${SHELLS.join(' ')})'` : "'*:file:_files'");
  return `#compdef veronese
_veronese() {
  local -a commands=(${[...commands, { name: 'help', about: 'show options and examples of a command' }].map(({ name, about }) => quoted(`${name}:${about}`, 'zsh')).join(' ')})
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command="$words[2]"
  shift words
  ((CURRENT--))
  case "$command" in
    help) _describe command commands ;;
${commands.map(({ name, options }) => `    ${name}) _arguments ${[...options.map(option), rest(name)].join(' ')} ;;\n`).join('')}  esac
}
if [[ "$funcstack[1]" = _veronese ]]; then _veronese "$@"; else compdef _veronese veronese; fi
`;
}

function fish(): string {
  const line = (condition: string, words: string): string => `complete -c veronese -n '${condition}' ${words}\n`;
  const option = (one: Option): string => {
    const short = one.short === undefined ? '' : `-s ${one.short} `;
    const words = valuesOf(one);
    const isPlace = one.value === 'DIR' || one.value === 'FILE';
    const value = one.type === 'boolean' ? '' : isPlace ? '-rF ' : `-x ${words.length > 0 ? `-a '${words.join(' ')}' ` : ''}`;
    return `${short}-l ${one.name} ${value}-d ${quoted(brief(one), 'fish')}`;
  };
  const first = [...commands, { name: 'help', about: 'show options and examples of a command' }];
  return [
    ...first.map(({ name, about }) => line('__fish_use_subcommand', `-f -a ${name} -d ${quoted(about, 'fish')}`)),
    ...commands.flatMap(({ name, options }) => options.map((one) => line(`__fish_seen_subcommand_from ${name}`, option(one)))),
    line('__fish_seen_subcommand_from completion', `-f -a '${SHELLS.join(' ')}'`),
    line('__fish_seen_subcommand_from help', `-f -a '${names.join(' ')}'`),
  ].join('');
}
