// Parses the command line and reports what is wrong with it.

import { availableParallelism } from 'node:os';
import { parseArgs } from 'node:util';
import { FRAME_RATES, LONGEST_SIDE } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { MOST_JOBS } from '../pool/segmenter.js';
import { BACK, type CommandName, COMMANDS, isCommand, meant, type Option, type OptionName, OPTIONS, optionsOf } from './commands.js';
import type { Range } from './sequence.js';
import { type Shown, SHOWN, shownOf } from './showing.js';
import type { Format } from '../../types/formats.js';
import { FORMATS, isFormat } from '../formats/encode.js';

/** Shortest side of a frame, and largest look-ahead, as in the core. */
const SHORTEST_SIDE = 16;
const LONGEST_LOOK_AHEAD = 8;

/** The reader of arguments of each command. */
const READ = { pair, batch, clip, convert, points };

type Values = ReturnType<typeof parsed>['values'];

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
    return {
      ...READ[command](
        values,
        files,
        given.map((option) => option.name),
      ),
      quiet: values.quiet,
    };
  } catch (thrown) {
    if (!(thrown instanceof VeroneseError) || thrown.code !== 'usage') throw thrown;
    throw usage(`${thrown.message}${hint(command)}`);
  }
}

function commandNamed(name: string): CommandName {
  if (isCommand(name)) return name;
  throw usage(
    `there is no command '${name}'${question(name === 'video' ? 'batch' : meant(name, Object.keys(COMMANDS))) ?? hint(undefined)}`,
  );
}

function points(values: Values, files: string[]) {
  const [file] = exactly(1, files, "'points' takes one file") as [string];
  const options = { motions: motions(values.motions), seed: seed(values.seed), method: choice('method', values.method, 'paper', 'best') };
  return { name: 'points' as const, file, options };
}

function convert(values: Values, files: string[], given: readonly string[]) {
  const { to, out, clip, grouped, background, image, video, force, 'first-frame': first } = values;
  const [folder] = exactly(1, files, "'convert' takes one folder") as [string];
  if (to === undefined) throw usage("'convert' needs '--to FORMATS'");
  const back = to.split(',').includes(BACK);
  for (const option of given) {
    const isOfBack = ['clip', 'levels', 'first-frame'].includes(option);
    if (back ? isOfBack || ['to', 'out', 'force', 'quiet'].includes(option) : !isOfBack) continue;
    throw usage(back ? `'--to ${BACK}' has no option '--${option}'` : `'--${option}' needs '--to ${BACK}'`);
  }
  if (back) {
    if (to !== BACK) throw usage(`'${BACK}' is read from annotations and cannot be with formats that are written`);
    if (out === undefined) throw usage(`'--to ${BACK}' needs '--out DIR'`);
    const firstFrame = first === undefined ? undefined : choice('first-frame', first, '0', '1');
    return {
      name: BACK,
      source: folder,
      out,
      clip,
      force,
      levels: levels(values.levels),
      firstFrame: firstFrame && (Number(firstFrame) as 0 | 1),
    } as const;
  }
  const { shapes, 'frame-rate': rate } = values;
  const settings = {
    tolerance: decimal('tolerance', values.tolerance),
    range: range(values.from, values.until),
    shapes: shapes === undefined ? undefined : choice('shapes', shapes, 'polygon', 'box'),
    frameRate: frameRate(rate),
  };
  return { name: 'convert' as const, folder, to: formats(to), ...settings, grouped, background, image, video, out, force };
}

function clip(values: Values, files: string[]) {
  const {
    list,
    out,
    overlay,
    masks,
    corrections,
    force,
    'look-ahead': lookAhead,
    'allow-damaged': allowDamaged,
    'frame-rate': rate,
  } = values;
  checkFrames('clip', files, list);
  if (out === undefined) throw usage("'clip' needs '--out DIR'");
  const options = {
    motions: motions(values.motions),
    quality: quality(values),
    lookAhead: lookAhead === undefined ? ('all' as const) : whole('look-ahead', lookAhead, 0, LONGEST_LOOK_AHEAD),
    markUnknown: values['mark-unknown'],
    subject: values.subject,
  };
  if (lookAhead !== undefined && (masks ?? corrections) !== undefined)
    throw usage("'--look-ahead' goes without '--masks' and '--corrections', whose numbers are those of the whole clip");
  if (rate !== undefined && values.show === undefined) throw usage("'--frame-rate' needs '--show'");
  const shared = {
    every: every(values.every),
    jobs: jobs(values.jobs, availableParallelism()),
    show: shown(values.show),
    frameRate: frameRate(rate),
    maxSize: maxSize(values['max-size']),
  };
  if (values.levels !== undefined && masks === undefined && corrections === undefined)
    throw usage("'--levels' needs '--masks' or '--corrections'");
  return {
    name: 'clip' as const,
    frames: files,
    list,
    masks,
    corrections,
    levels: levels(values.levels),
    ...shared,
    options,
    overlay,
    allowDamaged,
    out,
    force,
  };
}

function pair(values: Values, files: string[]) {
  const settings = ofPairs(values);
  const [first, second] = exactly(2, files, "'pair' takes two files") as [string, string];
  return { name: 'pair' as const, first, second, ...settings };
}

/** The part of all pairs to process is counted from 0. */
function batch(values: Values, frames: string[]) {
  const settings = {
    ...ofPairs(values),
    every: every(values.every),
    jobs: jobs(values.jobs, availableParallelism()),
    shard: shard(values.shard),
  };
  checkFrames('batch', frames, values.list);
  return { name: 'batch' as const, frames, list: values.list, ...settings };
}

function ofPairs(values: Values) {
  const { out, subject, overlay, confidence, force } = values;
  for (const name of ['overlay', 'confidence', 'force'] as const) {
    if (values[name] && out === undefined) throw usage(`'--${name}' needs '--out DIR'`);
  }
  const options = { motions: motions(values.motions), quality: quality(values), markUnknown: values['mark-unknown'], subject, confidence };
  // The subject's masks are of the whole of it.
  return {
    options,
    grouped: values.grouped || subject,
    overlay,
    allowDamaged: values['allow-damaged'],
    maxSize: maxSize(values['max-size']),
    out,
    force,
  };
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

function quality(values: Values): 'fast' | 'best' {
  return choice('quality', values.quality, 'fast', 'best');
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

function formats(text: string): Format[] {
  return [...new Set(text.split(','))].map((name) => {
    if (isFormat(name)) return name;
    const known = Object.keys(FORMATS);
    throw new VeroneseError(
      'invalid-option',
      `option '--to': there is no format '${name}'${question(meant(name, known)) ?? `; the formats are ${known.join(', ')}`}`,
    );
  });
}

function shown(text: string | undefined): Shown[] {
  return [...new Set(text?.split(','))].map((name) => {
    const known = shownOf(name);
    if (known) return known;
    const sentence = `option '--show': nothing is known as '${name}'${question(meant(name, SHOWN)) ?? `; known are ${SHOWN.join(', ')}`}`;
    throw new VeroneseError('invalid-option', sentence);
  });
}

function levels(text: string | undefined): 'exact' | number | undefined {
  if (text === undefined || text === 'exact') return text;
  if (/^\d{1,5}$/.test(text) && Number(text) >= 1 && Number(text) <= 65_535) return Number(text);
  throw invalid('levels', "'exact' or a level from 1 to 65535", text);
}

function maxSize(text: string | undefined): number | undefined {
  return text === undefined ? undefined : whole('max-size', text, SHORTEST_SIDE, LONGEST_SIDE);
}

function frameRate(text: string | undefined): number | undefined {
  return text === undefined ? undefined : decimal('frame-rate', text, FRAME_RATES.least, FRAME_RATES.most);
}

function range(from: string, until?: string): Range {
  const index = (name: string, text: string) => {
    if (/^\d{1,9}$/.test(text)) return Number(text);
    throw invalid(name, 'the number of a frame, from 0', text);
  };
  const first = index('from', from);
  if (until === undefined) return { from: first };
  const last = index('until', until);
  if (last < first) throw invalid('until', `a frame from ${first}, where '--from' is`, until);
  return { from: first, until: last };
}

function decimal(name: string, text: string, least = 0, most = LONGEST_SIDE): number {
  const value = Number(text);
  if (/^\d+(\.\d+)?$/.test(text) && value >= least && value <= most) return value;
  throw invalid(name, `a number from ${least} to ${most}, in digits`, text);
}

function jobs(text: string | undefined, unasked: number): number {
  return text === undefined ? unasked : whole('jobs', text, 1, MOST_JOBS);
}

function every(text: string): number {
  return whole('every', text, 1, 1_000_000);
}

function whole(name: string, text: string, least: number, most: number): number {
  const value = Number(text);
  if (/^\d+$/.test(text) && value >= least && value <= most) return value;
  throw invalid(name, `a whole number from ${least} to ${most}`, text);
}

function shard(text: string): { index: number; of: number } {
  const [, index, of] = (/^(\d{1,9})\/(\d{1,9})$/.exec(text) ?? []).map(Number);
  if (index !== undefined && of !== undefined && index >= 1 && index <= of) return { index: index - 1, of };
  throw invalid('shard', "'I/N', part I from 1 to N of N parts", text);
}

function choice<const T extends string>(name: string, text: string, ...choices: T[]): T {
  const found = choices.find((word) => word === text);
  if (found !== undefined) return found;
  throw invalid(name, choices.map((word) => `'${word}'`).join(' or '), text);
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
