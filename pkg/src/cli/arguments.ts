// Parses the command line and reports what is wrong with it.

import { availableParallelism } from 'node:os';
import { parseArgs } from 'node:util';
import type { Format } from '../../types/formats.js';
import { FRAME_RATES, LONGEST_SIDE } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { FORMATS, isFormat } from '../formats/encode.js';
import { MOST_JOBS } from '../pool/segmenter.js';
import { BACK, type CommandName, COMMANDS, isCommand, meant, type Option, type OptionName, OPTIONS, optionsOf } from './commands.js';
import { type Shown, SHOWN, shownOf } from './showing.js';

/** Shortest side of a frame, and largest look-ahead, as in the core. */
const SHORTEST_SIDE = 16;
const LONGEST_LOOK_AHEAD = 8;

const EXACT = /^\d+$/;

/** Reads a value; undefined where it is not what is wanted, in words. */
function reader<const T>(wanted: string, read: (text: string) => T | undefined) {
  return (text: string, name: string): T => {
    const value = read(text);
    if (value !== undefined) return value;
    throw invalid(name, wanted, text);
  };
}

const within = (pattern: RegExp, least: number, most: number) => (text: string) =>
  pattern.test(text) && Number(text) >= least && Number(text) <= most ? Number(text) : undefined;
const whole = (least: number, most: number) => reader(`a whole number from ${least} to ${most}`, within(EXACT, least, most));
const decimal = (least: number, most: number) =>
  reader(`a number from ${least} to ${most}, in digits`, within(/^\d+(\.\d+)?$/, least, most));
const choice = <const T extends string>(...words: T[]) =>
  reader(words.map((word) => `'${word}'`).join(' or '), (text) => words.find((word) => word === text));
const index = reader('the number of a frame, from 0', within(/^\d{1,9}$/, 0, Infinity));

/** The readers of options with values. */
const READERS = {
  motions: reader("'auto' or a whole number from 1 to 10", (text) => (text === 'auto' ? text : within(/^[1-9]\d?$/, 1, 10)(text))),
  quality: choice('fast', 'best'),
  method: choice('paper', 'best'),
  seed: whole(0, Number.MAX_SAFE_INTEGER),
  every: whole(1, 1_000_000),
  'look-ahead': whole(0, LONGEST_LOOK_AHEAD),
  levels: reader("'exact' or a level from 1 to 65535", (text) => (text === 'exact' ? text : within(EXACT, 1, 65_535)(text))),
  'first-frame': choice('0', '1'),
  show: (text: string): Shown[] =>
    listed(text, (name) => shownOf(name) ?? missing('show', `nothing is known as '${name}'`, name, SHOWN, 'known')),
  'max-size': whole(SHORTEST_SIDE, LONGEST_SIDE),
  jobs: whole(1, MOST_JOBS),
  /** The part of all pairs to process is counted from 0. */
  shard: reader("'I/N', part I from 1 to N of N parts", (text) => {
    const [, part = 0, of = 0] = (/^(\d{1,9})\/(\d{1,9})$/.exec(text) ?? []).map(Number);
    return part >= 1 && part <= of ? { index: part - 1, of } : undefined;
  }),
  to: (text: string): Format[] | typeof BACK => {
    if (text === BACK) return BACK;
    if (text.split(',').includes(BACK)) throw usage(`'${BACK}' is read from annotations and cannot be with formats that are written`);
    const known = Object.keys(FORMATS);
    return listed(text, (name) => (isFormat(name) ? name : missing('to', `there is no format '${name}'`, name, known, 'the formats')));
  },
  tolerance: decimal(0, LONGEST_SIDE),
  from: index,
  until: index,
  shapes: choice('polygon', 'box'),
  'frame-rate': decimal(FRAME_RATES.least, FRAME_RATES.most),
};

type Texts = ReturnType<typeof parsed>['values'];
type Camel<name extends string> = name extends `${infer one}-${infer more}` ? `${one}${Capitalize<Camel<more>>}` : name;
/** The values by names as `lookAhead`. */
type Values = {
  [name in OptionName as Camel<name>]: name extends keyof typeof READERS
    ? ReturnType<(typeof READERS)[name]> | Extract<Texts[name], undefined>
    : Texts[name];
};

/** What each command makes of its values. */
const READ = { pair, batch, clip, convert, points };

export type PairCommand = ReturnType<typeof pair>;
export type PointsCommand = ReturnType<typeof points>;
export type ConvertCommand = Extract<ReturnType<typeof convert>, { name: 'convert' }>;
export type CorrectionsCommand = Extract<ReturnType<typeof convert>, { name: 'corrections' }>;
export type ClipCommand = ReturnType<typeof clip>;
export type BatchCommand = ReturnType<typeof batch>;
export type Command = { quiet?: boolean } & (
  | { name: 'help'; topic: CommandName | 'all' | undefined }
  | { name: 'version' }
  | ReturnType<(typeof READ)[keyof typeof READ]>
);

/**
 * Throws a {@link VeroneseError} with code `wrong-usage` for an option that the command does not have, `invalid-option` for an invalid value
 * of one, or `usage`.
 */
export function parseCommand(args: string[]): Command {
  const { values, positionals, tokens } = parsed(args);
  const [name, ...files] = positionals;
  if (values.version) return { name: 'version' };
  if (name === undefined && values.help) return { name: 'help', topic: args.includes('--help') ? 'all' : undefined };
  if (name === 'help') return { name: 'help', topic: files[0] === undefined ? undefined : commandNamed(files[0]) };
  if (name === undefined) throw usage(`a command is missing${hint(undefined)}`);
  const command = commandNamed(name);
  if (values.help) return { name: 'help', topic: command };
  const own = optionsOf(command).map((option) => option.name);
  const given = tokens.filter((token) => token.kind === 'option');
  for (const { name: option, value } of given) {
    if (!own.includes(option)) throw unknown(`'${command}' has no option`, `--${option}`, command);
    if (value === '') throw valueOf(option, command);
  }
  try {
    const entries = Object.entries(values).map(([name, value]) => {
      const read = READERS[name as keyof typeof READERS] as ((text: string, name: string) => unknown) | undefined;
      return [name.replace(/-(.)/g, (_, letter: string) => letter.toUpperCase()), read ? read(value as string, name) : value];
    });
    const names = given.map((option) => option.name);
    return READ[command](Object.fromEntries(entries) as Values, files, names);
  } catch (thrown) {
    if (!(thrown instanceof VeroneseError) || thrown.code !== 'usage') throw thrown;
    throw usage(`${thrown.message}${hint(command)}`);
  }
}

function commandNamed(name: string): CommandName {
  if (isCommand(name)) return name;
  const word = name === 'video' ? 'batch' : meant(name, Object.keys(COMMANDS));
  throw usage(`there is no command '${name}'${question(word) ?? hint(undefined)}`);
}

function points({ quiet, motions, seed, method }: Values, files: string[]) {
  const [file] = exactly(1, files, "'points' takes one file") as [string];
  return { name: 'points' as const, quiet, file, options: { motions, seed, method } };
}

function convert(values: Values, files: string[], given: readonly string[]) {
  const { to, out, from, until, firstFrame } = values;
  const [folder] = exactly(1, files, "'convert' takes one folder") as [string];
  if (to === undefined) throw usage("'convert' needs '--to FORMATS'");
  const back = to === BACK;
  for (const option of given) {
    const isOfBack = ['clip', 'levels', 'first-frame'].includes(option);
    if (back ? isOfBack || ['to', 'out', 'force', 'quiet'].includes(option) : !isOfBack) continue;
    throw usage(back ? `'--to ${BACK}' has no option '--${option}'` : `'--${option}' needs '--to ${BACK}'`);
  }
  if (back) {
    if (out === undefined) throw usage(`'--to ${BACK}' needs '--out DIR'`);
    return { ...values, name: BACK, source: folder, out, firstFrame: firstFrame && (Number(firstFrame) as 0 | 1) } as const;
  }
  if (until !== undefined && until < from) throw invalid('until', `a frame from ${from}, where '--from' is`, String(until));
  return { ...values, name: 'convert' as const, folder, to, range: { from, ...(until !== undefined && { until }) } };
}

function clip(values: Values, frames: string[]) {
  const { list, out, masks, corrections, levels, motions, quality, lookAhead = 'all' as const, markUnknown, subject, show, jobs } = values;
  checkFrames('clip', frames, list);
  if (out === undefined) throw usage("'clip' needs '--out DIR'");
  const isAnnotated = masks !== undefined || corrections !== undefined;
  if (lookAhead !== 'all' && isAnnotated)
    throw usage("'--look-ahead' goes without '--masks' and '--corrections', whose numbers are those of the whole clip");
  if (values.frameRate !== undefined && show === undefined) throw usage("'--frame-rate' needs '--show'");
  if (levels !== undefined && !isAnnotated) throw usage("'--levels' needs '--masks' or '--corrections'");
  const options = { motions, quality, lookAhead, markUnknown, subject };
  return { ...values, name: 'clip' as const, frames, out, options, show: show ?? [], jobs: jobs ?? availableParallelism() };
}

function pair(values: Values, files: string[]) {
  const settings = ofPairs(values);
  const [first, second] = exactly(2, files, "'pair' takes two files") as [string, string];
  return { ...settings, name: 'pair' as const, first, second };
}

function batch(values: Values, frames: string[]) {
  const settings = ofPairs(values);
  checkFrames('batch', frames, values.list);
  return { ...settings, name: 'batch' as const, frames, jobs: values.jobs ?? availableParallelism() };
}

function ofPairs(values: Values) {
  const { out, motions, quality, markUnknown, subject, confidence } = values;
  for (const name of ['overlay', 'confidence', 'force'] as const) {
    if (values[name] && out === undefined) throw usage(`'--${name}' needs '--out DIR'`);
  }
  // The subject's masks are of the whole of it.
  return { ...values, options: { motions, quality, markUnknown, subject, confidence }, grouped: values.grouped || subject };
}

function parsed(args: string[]) {
  try {
    return parseArgs({ args, options: OPTIONS, allowPositionals: true, tokens: true });
  } catch (thrown) {
    const command = args.find(isCommand);
    const text = thrown instanceof Error ? thrown.message : String(thrown);
    // Node's sentences begin with the mistake, and name the option.
    const [, option = ''] = /'(?:-\w, )?(--?[^' ]+)/.exec(text) ?? [];
    if ((thrown as NodeJS.ErrnoException).code === 'ERR_PARSE_ARGS_UNKNOWN_OPTION') throw unknown('unknown option', option, command);
    throw valueOf(option.slice(2) as OptionName, command);
  }
}

/** Of an option without its value, or with one that it does not have. */
function valueOf(name: OptionName, command: CommandName | undefined): VeroneseError {
  const { value }: Option = OPTIONS[name];
  return usage(`option '--${name}' ${value === undefined ? 'takes no value' : `needs ${value}`}${hint(command)}`);
}

function hint(command: CommandName | undefined): string {
  return `; see 'veronese help${command ? ` ${command}` : ''}'`;
}

function checkFrames(command: string, files: string[], list: string | undefined): void {
  if (files.length === 0 && list === undefined) throw usage(`'${command}' takes frames, a list of them, or a video`);
  if (files.includes('')) throw usage("a frame's name is empty");
}

function exactly(count: number, files: string[], sentence: string): string[] {
  if (files.length !== count) throw usage(`${sentence}, found ${files.length}`);
  if (files.includes('')) throw usage("a file's name is empty");
  return files;
}

/** Different names, separated by commas. */
function listed<T>(text: string, read: (name: string) => T): T[] {
  return [...new Set(text.split(','))].map(read);
}

function missing(option: string, sentence: string, name: string, known: readonly string[], all: string): never {
  const remedy = question(meant(name, known)) ?? `; ${all} are ${known.join(', ')}`;
  throw new VeroneseError('invalid-option', `option '--${option}': ${sentence}${remedy}`);
}

function invalid(name: string, wanted: string, found: string): VeroneseError {
  return new VeroneseError('invalid-option', `option '--${name}' must be ${wanted}, not '${found}'`);
}

function unknown(sentence: string, option: string, command: CommandName | undefined): VeroneseError {
  const words = (command ? optionsOf(command).map(({ name }) => name) : Object.keys(OPTIONS)).map((name) => `--${name}`);
  return new VeroneseError('wrong-usage', `${sentence} '${option}'${question(meant(option, words)) ?? hint(command)}`);
}

function question(word: string | undefined): string | undefined {
  return word && `; did you mean '${word}'?`;
}

function usage(sentence: string): VeroneseError {
  return new VeroneseError('usage', sentence);
}
