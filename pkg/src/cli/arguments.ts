// Parses the command line and reports what is wrong with it.

import { availableParallelism } from 'node:os';
import { parseArgs } from 'node:util';
import { FRAME_RATES, LONGEST_SIDE } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { MOST_JOBS } from '../pool/segmenter.js';
import { isFormatName } from './formats.js';
import type { Range } from './sequence.js';
import { isSequenceFormatName, SEQUENCE_FORMATS, type SequenceFormatName } from './sequence-formats.js';

/** Largest look-ahead, as in the core. */
const LONGEST_LOOK_AHEAD = 8;

/** Names of the formats, wrapped to fit a terminal. */
const FORMAT_NAMES = wrapped(Object.keys(SEQUENCE_FORMATS), 80, '\n' + ' '.repeat(41));
/** Those that are not for all folders. */
const formatsFor = (ofPair: boolean, ofTracks: boolean): string =>
  Object.entries(SEQUENCE_FORMATS)
    .flatMap(([name, { tracks }]) => (tracks === ofTracks && isFormatName(name) === ofPair ? [name] : []))
    .join(', ');

export const HELP = `veronese segments two video frames by motion: how many motions there are, what each one is, and which pixels follow it.

  veronese pair FIRST SECOND [options]   segment two frames: PNG, JPEG, WebP, BMP or PNM
      --motions auto|1..10   number of motions (default: auto)
      --quality fast|best    speed or accuracy (default: best)
      --grouped              write groups instead of motions to labels.png and mask-K.png; one rigid background is one group
      --mark-unknown         use label 255 for pixels that are hidden or outside in SECOND, and where the data are ambiguous
      --out DIR              write labels.png, result.json and mask-K.png to DIR
      --confidence           also write confidence.png: 255 times the probability that each pixel's label is right
      --overlay              also write overlay.png: the first frame with each motion in its colour
      --allow-damaged        take a JPEG file of which a part is missing as it is, with a note; otherwise that is an error
      --force                overwrite files in DIR that are not of this program; without it they are an error

  veronese batch FRAMES... [options]     segment every pair of consecutive frames; FRAMES are folders, files or 'quoted patterns*.png'
      --list FILE            read frames from FILE, one path per line (- reads standard input)
      --every K              use only every K-th frame (default: 1)
      --out DIR              write a folder for each pair to DIR, with the files of pair; skip finished pairs
      --jobs N               number of pairs processed at once (default: the number of processors)
      --shard I/N            process only part I of N, to share the pairs between N machines
      --motions, --quality, --grouped, --mark-unknown, --confidence, --overlay, --allow-damaged, --force as for pair

  veronese video FILE [options]          segment the frames of a video; needs the program ffmpeg
      options as for batch, without --list
      --allow-damaged        take what can be decoded of a damaged video, with a warning; otherwise that is an error

  veronese clip FRAMES... | VIDEO --out DIR [options]
                                         follow what moves through a clip: objects keep their number; FRAMES as for batch, VIDEO as for video
      --list FILE            read frames from FILE, one path per line (- reads standard input)
      --every K              use only every K-th frame (default: 1)
      --motions auto|1..10   number of motions in each pair of frames (default: auto)
      --quality fast|best    speed or accuracy (default: best)
      --look-ahead N         let each frame wait for N others, 0 to 8 (default: the whole clip)
      --masks DIR            masks of objects in some frames: DIR/NAME.png with numbers of your own, which the objects keep (0: background,
                             255: nothing said; alone it is the object), a colour for each object on black, or what is not transparent;
                             DIR/3/NAME.png for object 3 alone; and DIR/edits.json
      --corrections DIR      what is certain in some frames: DIR/NAME.png with the labels of an earlier run, painted over (255: nothing said),
                             and DIR/edits.json: {"merge": [[2, 5]], "delete": [3], "background": [4], "names": {"1": "car"},
                             "locked": [6], "propagate": {"NAME": "both"}}, or "forward", "backward" or "none"
      --mark-unknown         use label 255 for pixels whose evidence does not tell an object from the background
      --jobs N               number of frames compared at once (default: the number of processors); the files are the same
      --out DIR              write labels/NAME.png for each frame, and tracks.json when all are there
      --overlay              also write overlay/NAME.png: the frames with each object in its colour
      --allow-damaged        as for pair and video
      --force                as for pair

  veronese convert DIR --to FORMATS      convert the output of pair, batch or clip in DIR for annotation tools; separate FORMATS by commas:
                                         ${FORMAT_NAMES}
                                         only of clip: ${formatsFor(false, true)}
                                         only of pair and clip: ${formatsFor(true, true)}
                                         only of batch and clip: ${formatsFor(false, false)}
      --tolerance PIXELS     distance by which polygons may deviate from a mask's border (default: 0.5); 0 follows its pixels
      --background           convert the background, label 0, as well
      --out DIR              output folder (default: the input folder)
      --force                as for pair
    of pair and batch:
      --grouped              groups instead of motions
    of pair:
      --image NAME           file name of the image that the masks belong to (default: first.png)
    of batch and clip, where images are named as the frames are:
      --from N, --until M    convert only frames N to M, both inclusive, counted from 0 (default: all)
    of clip:
      --shapes polygon|box   shapes in cvat-video (default: polygon)
      --video NAME           file name of the video, for cvat-video and label-studio-video (default: the name of DIR)
      --frame-rate N         frames per second, for formats that need it (default: the clip's, else 25)

  veronese convert SOURCE --to corrections --out DIR
                                         read masks back, for --corrections of clip: NAME.png for each annotated frame, and edits.json; SOURCE
                                         is a file, an archive or a folder: COCO, YouTube-VIS, CVAT, LabelMe, Label Studio, Datumaro, MOTS,
                                         Supervisely, PNG masks
      --clip DIR             the clip's folder, which names the frames of CVAT for video and MOTS (default: 00000, 00001 ...)
      --force                as for pair

  veronese points FILE.json [options]    fit motions to {"positions": [[x, y], ...], "derivatives": [[Ix, Iy, It], ...]}
      --motions auto|1..10   number of motions (default: auto)
      --method paper|best    the paper's own algorithm, or ours (default: best)
      --seed N               random seed (default: 1)

  veronese --help | --version

Prints one line of JSON on stdout; batch and video print one line per pair, clip one line per frame and a last one.
Exit codes: 0 done, 1 the input could not be processed, 2 wrong usage, 130 cancelled.
`;

/** The format of `convert` that reads masks back. */
const BACK = 'corrections';

const OPTIONS = {
  help: { type: 'boolean', short: 'h' },
  version: { type: 'boolean' },
  motions: { type: 'string', default: 'auto' },
  quality: { type: 'string', default: 'best' },
  method: { type: 'string', default: 'best' },
  grouped: { type: 'boolean', default: false },
  'mark-unknown': { type: 'boolean', default: false },
  confidence: { type: 'boolean', default: false },
  seed: { type: 'string', default: '1' },
  out: { type: 'string' },
  overlay: { type: 'boolean', default: false },
  to: { type: 'string' },
  image: { type: 'string' },
  background: { type: 'boolean', default: false },
  from: { type: 'string', default: '0' },
  until: { type: 'string' },
  shapes: { type: 'string' },
  video: { type: 'string' },
  'frame-rate': { type: 'string' },
  tolerance: { type: 'string', default: '0.5' },
  list: { type: 'string' },
  every: { type: 'string', default: '1' },
  jobs: { type: 'string', short: 'j' },
  shard: { type: 'string', default: '1/1' },
  'look-ahead': { type: 'string' },
  masks: { type: 'string' },
  corrections: { type: 'string' },
  clip: { type: 'string' },
  'allow-damaged': { type: 'boolean', default: false },
  force: { type: 'boolean', default: false },
} as const;

const OF_PAIRS = ['motions', 'quality', 'grouped', 'mark-unknown', 'confidence', 'out', 'overlay', 'allow-damaged', 'force'];
const OF_SEQUENCES = [...OF_PAIRS, 'every', 'jobs', 'shard'];
const OF_CLIPS = ['list', 'every', 'motions', 'quality', 'look-ahead', 'masks', 'corrections', 'mark-unknown', 'jobs', 'out', 'overlay', 'allow-damaged', 'force'];
const OF_CONVERT = ['to', 'tolerance', 'grouped', 'image', 'background', 'from', 'until', 'shapes', 'video', 'frame-rate', 'clip', 'out', 'force'];

/** By command the options that it has, and who reads what is asked. */
const COMMANDS = {
  pair: { options: OF_PAIRS, read: pair },
  batch: { options: ['list', ...OF_SEQUENCES], read: batch },
  video: { options: OF_SEQUENCES, read: video },
  clip: { options: OF_CLIPS, read: clip },
  convert: { options: OF_CONVERT, read: convert },
  points: { options: ['motions', 'method', 'seed'], read: points },
};

type Values = ReturnType<typeof parsed>['values'];

export type PairCommand = ReturnType<typeof pair>;
export type PointsCommand = ReturnType<typeof points>;
export type ConvertCommand = Extract<ReturnType<typeof convert>, { name: 'convert' }>;
export type CorrectionsCommand = Extract<ReturnType<typeof convert>, { name: 'corrections' }>;
export type ClipCommand = ReturnType<typeof clip>;
export type SequenceCommand = ReturnType<typeof batch> | ReturnType<typeof video>;
export type Command = { name: 'help' } | { name: 'version' } | ReturnType<(typeof COMMANDS)[keyof typeof COMMANDS]['read']>;

/**
 * Throws a {@link VeroneseError} with code `wrong-usage` for an option that the command does not have, `invalid-option` for an invalid value
 * of one, or `usage`.
 */
export function parseCommand(args: string[]): Command {
  const { values, positionals, tokens } = parsed(args);
  if (values.help) return { name: 'help' };
  if (values.version) return { name: 'version' };
  const [name, ...files] = positionals;
  if (name === undefined) throw usage('a command is missing');
  if (!Object.hasOwn(COMMANDS, name)) throw usage(`there is no command '${name}'`);
  const { options, read } = COMMANDS[name as keyof typeof COMMANDS];
  const given = tokens.filter((token) => token.kind === 'option');
  for (const { name: option, value } of given) {
    if (!options.includes(option)) throw unknown(`'${name}' has no option '--${option}'`);
    if (value === '') throw usage(`option '--${option}' is empty`);
  }
  return read(values, files, given.map((option) => option.name));
}

function points(values: Values, files: string[]) {
  const [file] = exactly(1, files, "'points' takes one file") as [string];
  const options = { motions: motions(values.motions), seed: seed(values.seed), method: choice('method', values.method, 'paper', 'best') };
  return { name: 'points' as const, file, options };
}

function convert(values: Values, files: string[], given: readonly string[]) {
  const { to, out, clip, grouped, background, image, video, force } = values;
  const [folder] = exactly(1, files, "'convert' takes one folder") as [string];
  if (to === undefined) throw usage("'convert' needs '--to FORMATS'");
  const back = to.split(',').includes(BACK);
  for (const option of given) {
    if (back ? ['to', 'clip', 'out', 'force'].includes(option) : option !== 'clip') continue;
    throw usage(back ? `'--to ${BACK}' has no option '--${option}'` : `'--clip' needs '--to ${BACK}'`);
  }
  if (back) {
    if (to !== BACK) throw usage(`'${BACK}' is read from annotations and cannot be with formats that are written`);
    if (out === undefined) throw usage(`'--to ${BACK}' needs '--out DIR'`);
    return { name: BACK, source: folder, out, clip, force } as const;
  }
  const { shapes, 'frame-rate': rate } = values;
  const settings = {
    tolerance: decimal('tolerance', values.tolerance),
    range: range(values.from, values.until),
    shapes: shapes === undefined ? undefined : choice('shapes', shapes, 'polygon', 'box'),
    frameRate: rate === undefined ? undefined : decimal('frame-rate', rate, FRAME_RATES.least, FRAME_RATES.most),
  };
  return { name: 'convert' as const, folder, to: formats(to), ...settings, grouped, background, image, video, out, force };
}

function clip(values: Values, files: string[]) {
  const { list, out, overlay, masks, corrections, force, 'look-ahead': lookAhead, 'allow-damaged': allowDamaged } = values;
  checkFrames('clip', files, list);
  if (out === undefined) throw usage("'clip' needs '--out DIR'");
  const options = {
    motions: motions(values.motions),
    quality: quality(values),
    lookAhead: lookAhead === undefined ? ('all' as const) : whole('look-ahead', lookAhead, 0, LONGEST_LOOK_AHEAD),
    markUnknown: values['mark-unknown'],
  };
  const shared = { every: every(values.every), jobs: jobs(values.jobs, availableParallelism()) };
  return { name: 'clip' as const, frames: files, list, masks, corrections, ...shared, options, overlay, allowDamaged, out, force };
}

function pair(values: Values, files: string[]) {
  const settings = ofPairs(values);
  const [first, second] = exactly(2, files, "'pair' takes two files") as [string, string];
  return { name: 'pair' as const, first, second, ...settings };
}

function batch(values: Values, frames: string[]) {
  const settings = ofSequences(values);
  checkFrames('batch', frames, values.list);
  return { name: 'batch' as const, frames, list: values.list, ...settings };
}

function video(values: Values, files: string[]) {
  const settings = ofSequences(values);
  const [file] = exactly(1, files, "'video' takes one file") as [string];
  return { name: 'video' as const, file, ...settings };
}

function ofPairs(values: Values) {
  const { out, grouped, overlay, confidence, force } = values;
  for (const name of ['overlay', 'confidence', 'force'] as const) {
    if (values[name] && out === undefined) throw usage(`'--${name}' needs '--out DIR'`);
  }
  const options = { motions: motions(values.motions), quality: quality(values), markUnknown: values['mark-unknown'], confidence };
  return { options, grouped, overlay, allowDamaged: values['allow-damaged'], out, force };
}

/** The part of all pairs to process is counted from 0. */
function ofSequences(values: Values) {
  return { ...ofPairs(values), every: every(values.every), jobs: jobs(values.jobs, availableParallelism()), shard: shard(values.shard) };
}

function parsed(args: string[]) {
  try {
    return parseArgs({ args, options: OPTIONS, allowPositionals: true, tokens: true });
  } catch (thrown) {
    const text = thrown instanceof Error ? thrown.message : String(thrown);
    // The first sentence names the mistake; the rest explains quoting.
    const sentence = text.split(/[.\n]\s/)[0]?.replace(/\.$/, '') ?? text;
    const lower = sentence.charAt(0).toLowerCase() + sentence.slice(1);
    throw (thrown as NodeJS.ErrnoException).code === 'ERR_PARSE_ARGS_UNKNOWN_OPTION' ? unknown(lower) : usage(lower);
  }
}

function checkFrames(command: string, files: string[], list: string | undefined): void {
  if (files.length === 0 && list === undefined) throw usage(`'${command}' takes frames, or a list of them`);
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

function formats(text: string): SequenceFormatName[] {
  const names = [...new Set(text.split(','))];
  const known: SequenceFormatName[] = names.filter(isSequenceFormatName);
  if (known.length === names.length) return known;
  throw invalid('to', `formats of ${Object.keys(SEQUENCE_FORMATS).join(', ')}`, text);
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

function wrapped(words: readonly string[], width: number, lineBreak: string): string {
  let [text, used] = ['', 0];
  for (const [k, word] of words.entries()) {
    const piece = k + 1 < words.length ? `${word}, ` : word;
    if (used > 0 && used + piece.length > width) [text, used] = [text.trimEnd() + lineBreak, 0];
    [text, used] = [text + piece, used + piece.length];
  }
  return text;
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

function unknown(sentence: string): VeroneseError {
  return new VeroneseError('wrong-usage', `${sentence}; see 'veronese --help'`);
}

function usage(sentence: string): VeroneseError {
  return new VeroneseError('usage', `${sentence}; see 'veronese --help'`);
}
