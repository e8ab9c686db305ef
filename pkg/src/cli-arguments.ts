// The command line: what it means, and what is wrong with it.

import { parseArgs } from 'node:util';
import { VeroneseError } from './errors.js';

export const HELP = `veronese finds how many things move between two frames, how each moves, and which pixels belong to it.

  veronese pair FIRST SECOND [options]   two frames: PNG, JPEG, WebP, BMP or PNM
      --before FILE          the frame before FIRST, a third view that helps where something is hidden
      --motions auto|1..10   how many motions (default: auto)
      --quality fast|best    how much work (default: best)
      --grouped              labels.png and mask-K.png show groups: what belongs to one rigid background counts as one
      --mark-unknown         label 255 where a pixel is hidden or outside in SECOND, or where the data cannot tell
      --seed N               seed of every random choice (default: 1)
      --out DIR              write labels.png, result.json and mask-K.png into DIR
      --confidence           and confidence.png: how sure every pixel's label is, 255 times its probability
      --overlay              and overlay.png: the first frame with every motion in its colour

  veronese points FILE.json [options]    {"positions": [[x, y], ...], "derivatives": [[Ix, Iy, It], ...]}
      --motions auto|1..10   how many motions (default: auto)
      --method paper|best    the paper's own algorithm, or ours (default: best)
      --seed N               seed of every random choice (default: 1)

  veronese --help | --version

One line of JSON on stdout. Exit codes: 0 done, 1 the input could not be processed, 2 wrong usage, 130 cancelled.
`;

export type Command =
  | { name: 'help' }
  | { name: 'version' }
  | {
      name: 'pair';
      first: string;
      second: string;
      before?: string;
      options: { motions: 'auto' | number; quality: 'fast' | 'best'; markUnknown: boolean; confidence: boolean; seed: number };
      grouped: boolean;
      overlay: boolean;
      out?: string;
    }
  | {
      name: 'points';
      file: string;
      options: { motions: 'auto' | number; method: 'paper' | 'best'; seed: number };
    };

export type PairCommand = Extract<Command, { name: 'pair' }>;
export type PointsCommand = Extract<Command, { name: 'points' }>;
export type WorkCommand = PairCommand | PointsCommand;

/** The files that a command reads, in the order in which their contents are handed over. */
export function filesOf(command: WorkCommand): string[] {
  if (command.name === 'points') return [command.file];
  return [command.first, command.second, ...(command.before === undefined ? [] : [command.before])];
}

const OPTIONS = {
  help: { type: 'boolean', short: 'h' },
  version: { type: 'boolean' },
  before: { type: 'string' },
  motions: { type: 'string', default: 'auto' },
  quality: { type: 'string', default: 'best' },
  method: { type: 'string', default: 'best' },
  grouped: { type: 'boolean', default: false },
  'mark-unknown': { type: 'boolean', default: false },
  confidence: { type: 'boolean', default: false },
  seed: { type: 'string', default: '1' },
  out: { type: 'string' },
  overlay: { type: 'boolean', default: false },
} as const;

const ALLOWED: Readonly<Record<string, readonly string[]>> = {
  pair: ['before', 'motions', 'quality', 'grouped', 'mark-unknown', 'confidence', 'seed', 'out', 'overlay'],
  points: ['motions', 'method', 'seed'],
};

/** Throws a {@link VeroneseError} of code `usage`, or `invalid-option` for a value that an option cannot have. */
export function parseCommand(args: string[]): Command {
  const { values, positionals, tokens } = parsed(args);
  if (values.help) return { name: 'help' };
  if (values.version) return { name: 'version' };
  const [name, ...files] = positionals;
  if (name === undefined) throw usage('a command is missing');
  const allowed = ALLOWED[name];
  if (!allowed) throw usage(`there is no command '${name}'`);
  for (const token of tokens) {
    if (token.kind !== 'option') continue;
    if (!allowed.includes(token.name)) throw usage(`'${name}' has no option '--${token.name}'`);
    if (token.value === '') throw usage(`option '--${token.name}' is empty`);
  }
  const shared = { motions: motions(values.motions), seed: seed(values.seed) };
  if (name === 'points') {
    const [file] = exactly(1, files, "'points' takes one file");
    return { name, file: file as string, options: { ...shared, method: choice('method', values.method, 'paper', 'best') } };
  }
  const [first, second] = exactly(2, files, "'pair' takes two files");
  for (const name of ['overlay', 'confidence'] as const) {
    if (values[name] && values.out === undefined) throw usage(`'--${name}' needs '--out DIR'`);
  }
  return {
    name: 'pair',
    first: first as string,
    second: second as string,
    ...(values.before !== undefined && { before: values.before }),
    options: {
      ...shared,
      quality: choice('quality', values.quality, 'fast', 'best'),
      markUnknown: values['mark-unknown'],
      confidence: values.confidence,
    },
    grouped: values.grouped,
    overlay: values.overlay,
    ...(values.out !== undefined && { out: values.out }),
  };
}

function parsed(args: string[]) {
  try {
    return parseArgs({ args, options: OPTIONS, allowPositionals: true, tokens: true });
  } catch (thrown) {
    const text = thrown instanceof Error ? thrown.message : String(thrown);
    // The first sentence names the mistake; what follows explains how to quote.
    const sentence = text.split(/[.\n]\s/)[0]?.replace(/\.$/, '') ?? text;
    throw usage(sentence.charAt(0).toLowerCase() + sentence.slice(1));
  }
}

function exactly(count: number, files: string[], sentence: string): string[] {
  if (files.length !== count) throw usage(`${sentence}, found ${files.length}`);
  if (files.includes('')) throw usage("a file's name is empty");
  return files;
}

function motions(text: string): 'auto' | number {
  if (text === 'auto') return text;
  if (/^([1-9]|10)$/.test(text)) return Number(text);
  throw invalid('motions', "'auto' or a whole number from 1 to 10", text);
}

function seed(text: string): number {
  if (/^\d+$/.test(text) && Number.isSafeInteger(Number(text))) return Number(text);
  throw invalid('seed', `a whole number from 0 to ${Number.MAX_SAFE_INTEGER}`, text);
}

function choice<const T extends string>(name: string, text: string, ...choices: T[]): T {
  const found = choices.find((word) => word === text);
  if (found !== undefined) return found;
  throw invalid(name, choices.map((word) => `'${word}'`).join(' or '), text);
}

function invalid(name: string, wanted: string, found: string): VeroneseError {
  return new VeroneseError('invalid-option', `option '--${name}' must be ${wanted}, not '${found}'`);
}

function usage(sentence: string): VeroneseError {
  return new VeroneseError('usage', `${sentence}; see 'veronese --help'`);
}
