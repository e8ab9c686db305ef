// The commands and options of the program, once: what is parsed, and what help and the site say about it.

import { FORMATS } from '../formats/encode.js';

/** As parseArgs takes it, with the word for its value and what it is for. */
export interface Option {
  type: 'string' | 'boolean';
  short?: string;
  default?: string | boolean;
  value?: string;
  text: string;
}

/** The formats that hold tracks, or the others. */
const formatsOf = (tracks: boolean): string => {
  const all = Object.entries(FORMATS).filter(([, format]) => (format.tracks ?? false) === tracks);
  return all.map(([name]) => name).join(', ');
};

/** The format of `convert` that reads masks back. */
export const BACK = 'corrections';

export const OPTIONS = {
  out: { type: 'string', short: 'o', value: 'DIR', text: 'output folder' },
  motions: { type: 'string', default: 'auto', value: 'auto|1..10', text: 'number of motions between two frames' },
  quality: { type: 'string', default: 'best', value: 'fast|best', text: 'speed or accuracy' },
  method: { type: 'string', default: 'best', value: 'paper|best', text: "the paper's own algorithm, or ours" },
  seed: { type: 'string', default: '1', value: 'N', text: 'random seed' },
  list: { type: 'string', value: 'FILE', text: 'read frames from FILE, one path per line (- reads standard input)' },
  every: { type: 'string', default: '1', value: 'K', text: 'use only every K-th frame' },
  'look-ahead': { type: 'string', value: 'N', text: 'let each frame wait for N others, 0 to 8 (default: the whole clip)' },
  masks: {
    type: 'string',
    value: 'DIR',
    text:
      'masks of objects in some frames: DIR/NAME.png with numbers of your own, which the objects keep (0: background, 255: not annotated; alone it is the object), ' +
      'a colour for each object on black, or what is not transparent; DIR/3/NAME.png for object 3 alone; and DIR/edits.json',
  },
  corrections: {
    type: 'string',
    value: 'DIR',
    text:
      'what is certain in some frames: DIR/NAME.png with the labels of an earlier run, painted over (255: not annotated), and DIR/edits.json: ' +
      '{"merge": [[2, 5]], "delete": [3], "names": {"1": "car"}, "locked": [6], "propagate": {"NAME": "both"}}, or "forward", "backward" or "none"',
  },
  levels: {
    type: 'string',
    value: 'exact|1..65535',
    text: 'what levels of masks are that look smoothed, or compressed with loss: exact, each is an object; or a level, from which on they are the object (default: an error)',
  },
  'first-frame': {
    type: 'string',
    value: '0|1',
    text: `with ${BACK}: the number of the first frame in MOTS as text (default: 0 where a line has it, else 1)`,
  },
  grouped: {
    type: 'boolean',
    default: false,
    text: 'groups instead of motions in labels.png and mask-K.png; one rigid background is one group',
  },
  subject: {
    type: 'boolean',
    default: false,
    text: 'only the main subject is an object, as for a cut-out: the one thing that the pictures are about',
  },
  'mark-unknown': {
    type: 'boolean',
    default: false,
    text: 'use label 255 for pixels that are hidden or outside in SECOND, and where the data are ambiguous',
  },
  confidence: {
    type: 'boolean',
    default: false,
    text: "also write confidence.png: 255 times the probability that each pixel's label is right",
  },
  overlay: { type: 'boolean', default: false, text: 'also write overlay.png: the first frame with each motion in its colour' },
  show: {
    type: 'string',
    value: 'FILES',
    text:
      'also write films and pictures, separated by commas: overlay, the frames with each object in its colour, or beside, the frames and next to them the same, as .mp4, .webm or .gif; ' +
      'sheet.png, some frames at a glance; cutout-N, object N alone and the rest transparent, as PNG files, or as .webm or .mov; films need the program ffmpeg',
  },
  'max-size': {
    type: 'string',
    value: 'N',
    text: 'scale frames down whose longest side has more than N pixels, 16 to 4096; results are of that size (default: larger than 4096 is an error)',
  },
  jobs: { type: 'string', short: 'j', value: 'N', text: 'number of pairs processed at once (default: the number of processors)' },
  shard: { type: 'string', default: '1/1', value: 'I/N', text: 'process only part I of N, to share the pairs between N machines' },
  to: {
    type: 'string',
    value: 'FORMATS',
    text: `formats, separated by commas: ${formatsOf(false)}; of tracks, not of batch: ${formatsOf(true)}; or ${BACK} alone, which reads masks back`,
  },
  tolerance: {
    type: 'string',
    default: '0.5',
    value: 'PIXELS',
    text: "distance by which polygons may deviate from a mask's border; 0 follows its pixels",
  },
  background: { type: 'boolean', default: false, text: 'convert the background, label 0, as well' },
  image: { type: 'string', value: 'NAME', text: 'of pair: file name of the image that the masks belong to (default: first.png)' },
  from: { type: 'string', default: '0', value: 'N', text: 'of batch and clip: the first frame to convert, counted from 0' },
  until: { type: 'string', value: 'M', text: 'of batch and clip: the last frame to convert (default: the last one)' },
  shapes: { type: 'string', value: 'polygon|box', text: 'of clip: shapes in cvat-video (default: polygon)' },
  video: { type: 'string', value: 'NAME', text: 'of clip: file name of the video, for cvat-video (default: the name of DIR)' },
  'frame-rate': { type: 'string', value: 'N', text: "of clip: frames per second, for formats that need it (default: the clip's, else 25)" },
  clip: {
    type: 'string',
    value: 'DIR',
    text: `with ${BACK}: the clip's folder, which names the frames of CVAT for video and MOTS (default: 00000, 00001 ...)`,
  },
  'allow-damaged': {
    type: 'boolean',
    default: false,
    text: 'take a damaged JPEG file or video as far as it can be read, with a note; otherwise that is an error',
  },
  force: {
    type: 'boolean',
    default: false,
    text: 'write to DIR even if it has files that veronese did not write there, and overwrite those in the way; without it they are an error',
  },
  quiet: { type: 'boolean', short: 'q', default: false, text: 'no progress, notes and warnings; results and errors stay' },
  help: { type: 'boolean', short: 'h', text: 'show this help' },
  version: { type: 'boolean', short: 'v', text: 'show the version' },
} as const satisfies Record<string, Option>;

export type OptionName = keyof typeof OPTIONS;

export interface CommandText {
  /** Its words, in each way to use it. */
  usage: readonly string[];
  about: string;
  /** What else is to be known. */
  more?: string;
  options: readonly OptionName[];
  /** What options are for, where this command has words of its own. */
  texts: { readonly [option in OptionName]?: string };
  examples: readonly (readonly [purpose: string, line: string])[];
}

/** Names of options. */
const named = (words: string) => words.split(' ') as OptionName[];

/** Options of all commands. */
export const ALWAYS: readonly OptionName[] = ['quiet', 'help', 'version'];

const OF_PAIRS = 'out motions quality grouped subject mark-unknown confidence overlay max-size';
const AT_THE_END = 'allow-damaged force';

export const COMMANDS = {
  pair: {
    usage: ['FIRST SECOND [options]'],
    about: 'segment two frames',
    more: 'Frames are PNG, JPEG, WebP, BMP or PNM. Prints one line of JSON.',
    options: named(`${OF_PAIRS} ${AT_THE_END}`),
    texts: { out: 'write labels.png, result.json and mask-K.png to DIR' },
    examples: [
      ['How many motions there are, as JSON', 'veronese pair first.png second.png'],
      ['Masks and a picture of them', 'veronese pair first.png second.png -o masks --overlay'],
    ],
  },
  batch: {
    usage: ['FRAMES... [options]', 'VIDEO [options]'],
    about: 'segment every pair of consecutive frames',
    more: "FRAMES are folders, files or 'quoted patterns*.png'; a VIDEO needs the program ffmpeg. Prints one line of JSON for each pair.",
    options: named(`list ${OF_PAIRS} every jobs shard ${AT_THE_END}`),
    texts: { out: 'write a folder for each pair to DIR, with the files of pair; skip finished pairs' },
    examples: [
      ['A folder of frames, four pairs at once', 'veronese batch frames -o pairs -j 4 > pairs.jsonl'],
      ['Every fifth frame, the first of three machines', 'veronese batch frames -o pairs --every 5 --shard 1/3'],
      ['Every tenth frame of a video, fast', 'veronese batch film.mp4 -o pairs --every 10 --quality fast'],
    ],
  },
  clip: {
    usage: ['FRAMES... --out DIR [options]', 'VIDEO --out DIR [options]'],
    about: 'follow what moves through a clip; objects keep their number',
    more: "FRAMES are folders, files or 'quoted patterns*.png'; a VIDEO needs the program ffmpeg. Prints one line of JSON for each frame and a last one. An interrupted run goes on where it was.",
    options: named(
      `out list every motions quality look-ahead masks corrections levels subject mark-unknown max-size overlay show frame-rate jobs ${AT_THE_END}`,
    ),
    texts: {
      out: 'write labels/NAME.png for each frame, and tracks.json when all are there',
      'mark-unknown': 'use label 255 for pixels whose evidence does not tell an object from the background',
      overlay: 'also write overlay/NAME.png: the frames with each object in its colour',
      'frame-rate': "frames per second of what '--show' writes (default: the video's, else 25)",
      jobs: 'number of frames compared at once (default: the number of processors); the files are the same',
    },
    examples: [
      ['Masks of a folder of frames', 'veronese clip frames -o masks'],
      ['Masks of a video, and a film of them to show', 'veronese clip film.mp4 -o masks --show overlay.mp4'],
      ['The main subject, on transparent ground', 'veronese clip film.mp4 -o masks --subject --show cutout-1.mov'],
      ['The same again, after painting over some labels', 'veronese clip film.mp4 -o masks --corrections painted'],
    ],
  },
  convert: {
    usage: ['DIR --to FORMATS [options]', `SOURCE --to ${BACK} --out DIR [--clip DIR] [--force]`],
    about: 'convert results for annotation tools, and annotations back',
    more: `DIR is a folder of pair, batch or clip. SOURCE is a file, an archive or a folder of annotations: COCO, YouTube-VIS, CVAT, Label Studio, MOTS, YOLO, PNG masks; of them come NAME.png for each annotated frame, and edits.json, for --corrections of clip.`,
    options: named('to out tolerance background grouped image from until shapes video frame-rate clip levels first-frame force'),
    texts: { out: 'output folder (default: the input folder)', grouped: 'of pair and batch: groups instead of motions' },
    examples: [
      ['A clip for COCO tools and as DAVIS masks', 'veronese convert masks --to coco,davis'],
      ["What was drawn in CVAT, for the clip's next run", 'veronese convert annotations.zip --to corrections -o drawn --clip masks'],
    ],
  },
  points: {
    usage: ['FILE.json [options]'],
    about: 'fit motions to measurements of points',
    more: 'FILE.json is {"positions": [[x, y], ...], "derivatives": [[Ix, Iy, It], ...]}. Prints one line of JSON.',
    options: named('motions method seed'),
    texts: { motions: 'number of motions' },
    examples: [["The paper's algorithm, with two motions", 'veronese points points.json --method paper --motions 2']],
  },
} as const satisfies Record<string, CommandText>;

export type CommandName = keyof typeof COMMANDS;

export const isCommand = (name: string): name is CommandName => Object.hasOwn(COMMANDS, name);

/** The options of a command, those of all commands last. */
export function optionsOf(command: CommandName): (Option & { name: OptionName })[] {
  const { options, texts }: CommandText = COMMANDS[command];
  return [...options, ...ALWAYS].map((name) => ({ ...OPTIONS[name], name, text: texts[name] ?? OPTIONS[name].text }));
}

/** The word of these that was probably meant. */
export function meant(wrong: string, words: readonly string[]): string | undefined {
  const near = words
    .map((word) => ({ word, edits: word.startsWith(wrong) && wrong.length > 1 ? 0 : edits(wrong, word) }))
    .sort((one, other) => one.edits - other.edits)[0];
  // A third of the letters may be wrong.
  return near && near.edits <= Math.max(1, Math.floor(wrong.length / 3)) ? near.word : undefined;
}

/** How many letters to insert, drop, replace or exchange with the next make one word of the other. */
function edits(one: string, other: string): number {
  const rows = [Array.from({ length: other.length + 1 }, (_, k) => k)];
  for (let i = 1; i <= one.length; i++) {
    const [row, above, before] = [[i], rows[i - 1] as number[], rows[i - 2]];
    for (let j = 1; j <= other.length; j++) {
      const same = one[i - 1] === other[j - 1];
      const exchanged = before && one[i - 1] === other[j - 2] && one[i - 2] === other[j - 1] ? (before[j - 2] as number) + 1 : Infinity;
      row[j] = Math.min((above[j] as number) + 1, (row[j - 1] as number) + 1, (above[j - 1] as number) + (same ? 0 : 1), exchanged);
    }
    rows.push(row);
  }
  return (rows[one.length] as number[])[other.length] as number;
}
