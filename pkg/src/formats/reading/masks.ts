// Masks in PNG files, as people have them: numbers of objects as indices or grey levels, white on black, one colour for each object, what is
// not transparent, a folder for each object. What a file is taken for is said in a note; where edges are smoothed, people have to say it.

import type { AnnotationNote, Levels } from '../../../types/formats.js';
import { invalidInput, UNLABELLED } from '../../common/checks.js';
import { davisPalette } from '../../common/palette.js';
import { decodePng, type Samples } from '../png-reader.js';
import { decoding, isObjectNumber, type Known, known, naming, type ReadFrame, type Source, stemOf } from './frame.js';
import { checkCrisp } from './smoothed.js';

const [BLACK, WHITE] = [0, 0xffffff];
/** The folder of the background beside those of objects, as `convert --to masks` writes it. */
const GROUND = '0';
/** With more colours what is not transparent is a thing cut out of a picture. */
const OF_A_PICTURE = 64;

/** What each pixel has: the number of an object, a level, or a colour of 24 bits. */
interface Values {
  isColour: boolean;
  values: Int32Array;
  width: number;
  height: number;
  /** What a person sees: levels or, where these differ, colours; of indices those of the palette. */
  seen: { kind: 'level' | 'colour'; values: Int32Array };
  /** Whether these may be smoothed. */
  isPlain: boolean;
  /** The level that says nothing beside others: the largest one. */
  white: number;
  /** Whether colours have 16 bits and are more than 8 of these can say. */
  isRounded?: boolean;
  note?: AnnotationNote;
}

/** What a file is taken for: the meaning of each value. */
interface Reading {
  meaning: Map<number, Known | typeof UNLABELLED | 0>;
  note?: AnnotationNote | undefined;
  /** 0 and the largest level alone: what that is depends on the other files. */
  isOpen?: boolean;
}

/** Frames of masks, and what was assumed of the files. */
export function readMasks(sources: readonly Source[], levels: Levels | undefined): { frames: ReadFrame[]; notes: AnnotationNote[] } {
  const files = sources.map((source) =>
    naming(source.name, (): MaskFile => {
      const values = valuesOf(source, levels);
      const { width, height } = values;
      return { source, levels, width, height, ...readingOf(values, levels) };
    }),
  );
  const folders = sources.map(({ name }) => /(?:^|\/)(\d+)\/[^/]+$/.exec(name)?.[1]);
  const isOne = ({ meaning }: MaskFile) => [...meaning.keys()].filter((value) => value !== 0).length <= 1;
  if (files.every(isOne) && folders.every((folder) => folder !== undefined)) {
    const ground = sources[folders.indexOf(GROUND)];
    const message = `'${ground?.name}': folder ${GROUND} is the background; that of an object is called 00 or 000`;
    return { frames: united(files, folders), notes: ground ? [{ code: 'mask-background', message }] : [] };
  }
  const numbers = files.some(({ isOpen, meaning }) => !isOpen && [...meaning.values()].some((one) => typeof one === 'object'));
  const closed = files.map((file) => (file.isOpen && numbers ? closedOf(file) : file));
  return { frames: closed.map(frameOf), notes: notesOf(closed) };
}

interface MaskFile extends Reading {
  source: Source;
  levels: Levels | undefined;
  width: number;
  height: number;
}

function closedOf(file: MaskFile): MaskFile {
  const [white] = [...file.meaning.keys()].filter((value) => value !== 0) as [number];
  const note = { code: 'mask-white', message: `${white} says nothing: there are numbers of objects in other files` };
  return {
    ...file,
    meaning: new Map<number, typeof UNLABELLED | 0>([
      [0, 0],
      [white, UNLABELLED],
    ]),
    note,
  };
}

function frameOf({ source, levels, width, height, meaning }: MaskFile): ReadFrame {
  const objects = [...meaning.values()].filter((one): one is Known => typeof one === 'object');
  return {
    name: stemOf(source.name),
    file: source.name,
    width,
    height,
    objects,
    draw: ({ labels }, labelOf) => {
      const numbers = new Map([...meaning].map(([value, one]) => [value, typeof one === 'object' ? labelOf(one.key) : one]));
      const { values } = valuesOf(source, levels);
      let [value, number] = [NaN, 0];
      for (let at = 0; at < labels.length; at++) {
        // Most pixels have the value of the one before.
        if (values[at] !== value) [value, number] = [values[at] as number, numbers.get(values[at] as number) as number];
        labels[at] = number;
      }
    },
  };
}

/** One frame of the files of all its objects, each in the folder called by its number; 0, without more zeros, is the background. */
function united(files: readonly MaskFile[], folders: readonly (string | undefined)[]): ReadFrame[] {
  const frames = new Map<string, ReadFrame[]>();
  for (const [k, file] of files.entries()) {
    const object = folders[k] === GROUND ? 0 : known(`number ${Number(folders[k])}`, Number(folders[k]), undefined);
    const frame = frameOf({ ...file, meaning: new Map([...file.meaning.keys()].map((value) => [value, value === 0 ? 0 : object])) });
    frames.set(frame.name, [...(frames.get(frame.name) ?? []), frame]);
  }
  return [...frames.values()].map((parts) => {
    const [first] = parts as [ReadFrame, ...ReadFrame[]];
    const other = parts.find(({ width, height }) => width !== first.width || height !== first.height);
    if (other) throw invalidInput(`'${other.file}' has another size than '${first.file}'`);
    return {
      ...first,
      objects: parts.flatMap(({ objects }) => objects),
      draw: (canvas, labelOf) => {
        for (const part of parts) {
          const own = new Uint8Array(canvas.labels.length);
          part.draw({ labels: own } as typeof canvas, labelOf);
          own.forEach((label, at) => label > 0 && (canvas.labels[at] = label));
        }
      },
    };
  });
}

/** What was assumed, once for all files of which it was. */
function notesOf(files: readonly MaskFile[]): AnnotationNote[] {
  const byMessage = new Map<string, { note: AnnotationNote; of: string[] }>();
  for (const { note, source } of files) {
    if (!note) continue;
    const entry = byMessage.get(note.message) ?? { note, of: [] };
    entry.of.push(source.name);
    byMessage.set(note.message, entry);
  }
  return [...byMessage.values()].map(({ note: { code, message }, of }) => {
    const others = of.length > 1 ? ` and ${of.length - 1} more` : '';
    return { code, message: `'${of[0]}'${others}: ${message}` };
  });
}

function valuesOf({ bytes }: Source, levels: Levels | undefined): Values {
  const png = decoding('it', () => decodePng(bytes));
  const found = png.palette ? indexed(png, png.palette) : direct(png);
  if (typeof levels !== 'number') return found;
  const brightest = (colour: number) => Math.max(colour >> 16, (colour >> 8) & 255, colour & 255);
  const { kind, values } = found.seen;
  return {
    ...found,
    isColour: false,
    white: UNLABELLED,
    values: values.map((value) => ((kind === 'level' ? value : brightest(value)) >= levels ? UNLABELLED : 0)),
  };
}

/** Transparent pixels are background; without any colours of its own, what is not transparent is one object. */
function direct({ width, height, channels, depth, samples }: Samples): Values {
  const byte = (at: number) => Math.round((255 * (samples[at] as number)) / (2 ** depth - 1));
  let isGrey = true;
  for (let at = 0; channels > 2 && isGrey && at < samples.length; at += channels)
    isGrey = samples[at] === samples[at + 1] && samples[at] === samples[at + 2];
  const colours = new Int32Array(width * height);
  for (let p = 0, at = 0; p < colours.length; p++, at += channels) {
    colours[p] = isGrey ? (samples[at] as number) : (byte(at) << 16) | (byte(at + 1) << 8) | byte(at + 2);
  }
  const alphaOf = (p: number) => (channels % 2 === 0 ? byte(channels * (p + 1) - 1) : UNLABELLED);
  // Of 8 bits, each byte is there twice.
  const isRounded =
    !isGrey &&
    depth === 16 &&
    samples.some((value, at) => value % 257 !== 0 && at % channels < 3 && alphaOf(Math.floor(at / channels)) > 0);
  const of = (values: Int32Array): Values => {
    const white = isGrey ? 2 ** Math.max(depth, 8) - 1 : WHITE;
    return {
      isColour: !isGrey,
      values,
      seen: { kind: isGrey ? 'level' : 'colour', values },
      isPlain: true,
      white,
      isRounded,
      width,
      height,
    };
  };
  if (channels % 2 === 1) return of(colours);
  const alpha = colours.map((_, p) => alphaOf(p));
  const opaque = valuesIn(colours.filter((_, p) => alpha[p] !== 0));
  if (!alpha.includes(0) || opaque.size === 0) return of(colours);
  if (opaque.size > 1 && opaque.size <= OF_A_PICTURE) return of(colours.map((colour, p) => (alpha[p] === 0 ? BLACK : colour)));
  const note = { code: 'mask-alpha', message: 'what is not transparent is the object' };
  return {
    ...of(alpha.map((level) => (level > 0 ? UNLABELLED : 0))),
    isColour: false,
    white: UNLABELLED,
    isRounded: false,
    seen: { kind: 'level', values: alpha },
    note,
  };
}

/** Indices are numbers of objects, 0 the background, unless black has another index. */
function indexed({ width, height, samples, alpha }: Samples, palette: Uint8Array): Values {
  const indices = new Int32Array(samples);
  const isClear = (index: number) => alpha?.[index] === 0;
  const colours = Int32Array.from({ length: 256 }, (_, index) => {
    const [red = 0, green = 0, blue = 0] = isClear(index) ? [] : palette.subarray(3 * index);
    return (red << 16) | (green << 8) | blue;
  });
  const colourOf = (index: number) => colours[index] as number;
  const used = [...valuesIn(indices)];
  const seen = { kind: 'colour' as const, values: indices.map(colourOf) };
  const isMoved = used.includes(0) && !isClear(0) && colours[0] !== BLACK && used.some((index) => colours[index] === BLACK);
  if (isMoved) return { isColour: true, values: seen.values, seen, isPlain: true, white: WHITE, width, height };
  const isGrey = used.every((index) => colourOf(index) === (colourOf(index) & 255) * 0x010101);
  const values = indices.map((index) => (isClear(index) ? 0 : index));
  return {
    isColour: false,
    values,
    seen: isGrey ? { kind: 'level', values: seen.values.map((colour) => colour & 255) } : seen,
    isPlain: isGrey,
    white: UNLABELLED,
    width,
    height,
  };
}

function readingOf(
  { isColour, isRounded, values, seen, isPlain, width, height, white, note }: Values,
  levels: Levels | undefined,
): Reading {
  if (isColour && isRounded) throw invalidInput('it has colours of 16 bits that 8 do not hold: save it with 8, or as grey levels');
  const all = [...valuesIn(values)];
  const ground = isColour && !all.includes(BLACK) ? WHITE : BLACK;
  const objects = all.filter((value) => value !== ground);
  if (isPlain && levels === undefined) decoding('it', () => checkCrisp(seen.values, { width, height }, { what: seen.kind, ground, white }));
  if (isColour && !all.includes(ground)) throw invalidInput('it has neither black nor white, one of which is the background of colours');
  if (objects.length >= UNLABELLED + Number(objects.includes(white))) throw invalidInput(`it has more than ${UNLABELLED - 1} objects`);
  if (isColour) return colours(objects, ground);
  const [object] = objects;
  if (objects.length === 1 && object === white && (all.includes(0) || typeof levels === 'number')) {
    const taken = { code: 'mask-white', message: `${white} is the object, number 1, and 0 the background` };
    const meaning = new Map<number, Known | 0>([
      [0, 0],
      [white, known('number 1', 1, undefined)],
    ]);
    return { meaning, ...(levels === undefined && { note: note ?? taken, isOpen: note === undefined }) };
  }
  const meaningOf = (value: number) => (value === 0 ? 0 : value === white ? UNLABELLED : known(`number ${value}`, value, undefined));
  return { meaning: new Map(all.map((value) => [value, meaningOf(value)])) };
}

/** Most pixels have the value of the one before. */
function valuesIn(values: Int32Array): Set<number> {
  const seen = new Set<number>();
  for (let at = 0; at < values.length; at++) if (values[at] !== values[at - 1]) seen.add(values[at] as number);
  return seen;
}

/** Colours of the DAVIS palette have its numbers if all are of it. */
function colours(all: readonly number[], background: number): Reading {
  const palette = davisPalette().map(([red, green, blue]) => (red << 16) | (green << 8) | blue);
  const indices = all.map((colour) => palette.indexOf(colour));
  const areIndices = indices.every(isObjectNumber);
  const meaning = new Map<number, Known | 0>([[background, 0]]);
  for (const [k, colour] of all.entries()) {
    const name = colour.toString(16).padStart(6, '0');
    meaning.set(colour, areIndices ? known(`number ${indices[k]}`, indices[k], undefined) : known(`colour ${name}`, undefined, `#${name}`));
  }
  const ground = background === BLACK ? 'black' : 'white';
  const which = all.length === 1 ? 'the other colour is the object' : `each of ${all.length} colours is an object`;
  return { meaning, note: { code: 'mask-colours', message: `${ground} is the background, ${which}` } };
}
