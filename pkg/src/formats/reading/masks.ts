// Masks in PNG files, as people have them: numbers of objects as indices or grey levels, white on black, one colour for each object, what is
// not transparent, edges smoothed or not, a folder for each object. What a file is taken for is said in a note.

import type { AnnotationNote } from '../../../types/formats.js';
import { invalidInput, isWhole, UNLABELLED } from '../../common/checks.js';
import { davisPalette } from '../../common/palette.js';
import { decodeSamples, type Samples } from '../indexed-png.js';
import { edgesOf } from './edges.js';
import { decoding, isObjectNumber, type Known, known, naming, type ReadFrame, type Source, stemOf } from './frame.js';

const [BLACK, WHITE] = [0, 0xffffff];
/** From this alpha on a pixel is not transparent. */
const OPAQUE = 128;
/** What has more colours is no mask but a picture. */
const MOST_COLOURS = 4096;
/** With more colours what is not transparent is a thing cut out of a picture. */
const OF_A_PICTURE = 64;
/** A mask with so many levels is soft or was compressed with loss: those nearest to black and white are meant to be black and white. */
const SOFT = { levels: 16, ends: 12 };
/** Share of the pixels at edges that lie between their sides where edges are smoothed. */
const SMOOTH = 0.9;
/** Small objects have ground around them: where as many of the pixels at edges touch other values, these are no numbers of objects. */
const CROWDED = 0.5;
/** As many values that have no side may be numbers of objects by accident only. */
const TOO_MANY = 9;
/** Smoothing gives at least as many values between, unless one of the sides is white. */
const FEW = 3;

/** What each pixel has: the number of an object, a level, or a colour of 24 bits. */
interface Values {
  kind: 'numbers' | 'levels' | 'colours';
  values: Int32Array;
  width: number;
  height: number;
  counts: Map<number, number>;
  /** Of a picture with alpha: what is not transparent is the object. */
  isCutOut?: boolean;
}

/** What a file is taken for: the meaning of each value, and whether edges are smoothed. */
interface Reading {
  meaning: Map<number, Known | typeof UNLABELLED | 0>;
  smooth: boolean;
  note?: AnnotationNote | undefined;
  /** Indices 0 and 255 alone: what 255 is depends on the other files. */
  isOpen?: boolean;
}

/** Frames of masks, and what was assumed of the files. */
export function readMasks(sources: readonly Source[]): { frames: ReadFrame[]; notes: AnnotationNote[] } {
  const folders = sources.map(({ name }) => objectOfFolder(name));
  const files = sources.map((source) => {
    const { width, height, ...values } = naming(source.name, () => valuesOf(source));
    return { source, width, height, ...naming(source.name, () => readingOf({ width, height, ...values })) };
  });
  const perObject = folders.every((folder) => folder !== undefined) && files.every(({ meaning }) => meaning.size <= 2 && meaning.get(0) === 0);
  if (perObject) return { frames: united(files.map((file, k) => ({ ...file, number: folders[k] as number }))), notes: [] };
  const numbers = files.some(({ isOpen, meaning }) => !isOpen && [...meaning.values()].some((one) => typeof one === 'object'));
  const closed = files.map((file) => (file.isOpen && numbers ? { ...file, meaning: file.meaning.set(255, UNLABELLED), note: undefined } : file));
  return { frames: closed.map(frameOf), notes: notesOf(closed) };
}

/** The number of an object whose masks have a folder of their own: `masks/3/00012.png`. */
function objectOfFolder(name: string): number | undefined {
  const [, number] = /(?:^|\/)(0|[1-9]\d{0,2})\/[^/]+$/.exec(name) ?? [];
  return number !== undefined && isWhole(Number(number), 0, UNLABELLED - 1) ? Number(number) : undefined;
}

interface MaskFile extends Reading {
  source: Source;
  width: number;
  height: number;
}

function frameOf({ source, width, height, meaning, smooth }: MaskFile): ReadFrame {
  const objects = [...meaning.values()].filter((one): one is Known => typeof one === 'object');
  return {
    name: stemOf(source.name),
    file: source.name,
    width,
    height,
    objects,
    draw: ({ labels }, labelOf) => {
      const numbers = new Map([...meaning].map(([value, one]) => [value, typeof one === 'object' ? labelOf(one.key) : one]));
      const { values } = clamped(valuesOf(source));
      const all = smooth ? edgesOf(values, width, height, BLACK).resolved() : values;
      let [value, number] = [NaN, 0];
      for (let at = 0; at < labels.length; at++) {
        // Most pixels have the value of the one before.
        if (all[at] !== value) [value, number] = [all[at] as number, numbers.get(all[at] as number) as number];
        labels[at] = number;
      }
    },
  };
}

/** One frame of the files of all its objects. */
function united(files: readonly (MaskFile & { number: number })[]): ReadFrame[] {
  const frames = new Map<string, ReadFrame[]>();
  for (const { number, ...file } of files) {
    const object = number === 0 ? 0 : known(`number ${number}`, number, undefined);
    const meaning = new Map([...file.meaning].map(([value, one]) => [value, one === 0 ? one : object]));
    const frame = frameOf({ ...file, meaning });
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

function valuesOf({ bytes }: Source): Values {
  const png = decoding('it', () => decodeSamples(bytes));
  const { width, height, channels, depth, samples, palette } = png;
  const size = { width, height };
  if (palette) return indexed(png, palette);
  const level = depth === 16 && channels > 1 ? 257 : 1;
  const sample = (at: number) => Math.round((samples[at] as number) / level);
  const opacity = channels % 2 === 0 ? Uint8Array.from({ length: width * height }, (_, p) => Number(sample(channels * p + channels - 1) >= OPAQUE)) : undefined;
  const isGrey = channels < 3;
  const colours = channels === 1 ? new Int32Array(samples) : new Int32Array(width * height);
  for (let p = 0, at = 0; channels > 1 && p < colours.length; p++, at += channels) {
    colours[p] = isGrey ? sample(at) : (sample(at) << 16) | (sample(at + 1) << 8) | sample(at + 2);
  }
  if (opacity?.includes(0) && opacity.includes(1)) return transparent(colours, opacity, size, isGrey);
  if (isGrey) return { kind: 'levels', values: colours, ...size, counts: counted(colours) };
  const counts = counted(colours);
  const levels = [...counts.keys()].every((colour) => colour === (colour & 255) * 0x010101);
  if (!levels) return { kind: 'colours', values: colours, ...size, counts };
  const values = colours.map((colour) => colour & 255);
  return { kind: 'levels', values, ...size, counts: counted(values) };
}

/** Transparent pixels are background; without any colours of its own, what is not transparent is one object. */
function transparent(colours: Int32Array, opacity: Uint8Array, size: { width: number; height: number }, isGrey: boolean): Values {
  const opaque = counted(colours.filter((_, p) => opacity[p]));
  if (opaque.size === 1 || opaque.size > OF_A_PICTURE) {
    const values = Int32Array.from(opacity, (is) => is * 255);
    return { kind: 'levels', values, ...size, counts: counted(values), isCutOut: true };
  }
  const values = colours.map((colour, p) => (opacity[p] ? colour : BLACK));
  return { kind: isGrey ? 'levels' : 'colours', values, ...size, counts: counted(values) };
}

/** Indices are numbers of objects, 0 the background, unless black has another index, or the picture has shades of grey. */
function indexed({ width, height, samples, alpha }: Samples, palette: Uint8Array): Values {
  const size = { width, height };
  const indices = new Int32Array(samples);
  const counts = counted(indices);
  const colourOf = (index: number) => [0, 1, 2].reduce((colour, channel) => (colour << 8) | (palette[3 * index + channel] ?? 0), 0);
  const used = [...counts.keys()].filter((index) => alpha?.[index] !== 0);
  const isClear = (index: number) => alpha?.[index] === 0;
  const blacks = used.filter((index) => colourOf(index) === BLACK);
  const moved = isClear(0) ? false : colourOf(0) !== BLACK && counts.has(0) && (blacks.length > 0 || used.length < counts.size);
  const shades = used.length > FEW && used.every((index) => colourOf(index) === (colourOf(index) & 255) * 0x010101) && used.some((index) => colourOf(index) === WHITE);
  if (!moved && !shades && used.length === counts.size) return { kind: 'numbers', values: indices, ...size, counts };
  if (!moved && !shades) {
    const values = indices.map((index) => (isClear(index) ? 0 : index));
    return { kind: 'numbers', values, ...size, counts: counted(values) };
  }
  const values = indices.map((index) => (isClear(index) ? BLACK : shades ? colourOf(index) & 255 : colourOf(index)));
  return { kind: shades ? 'levels' : 'colours', values, ...size, counts: counted(values) };
}

function counted(values: Int32Array): Map<number, number> {
  const counts = new Map<number, number>();
  for (let at = 0; at < values.length; ) {
    const value = values[at] as number;
    const from = at;
    while (at < values.length && values[at] === value) at++;
    counts.set(value, (counts.get(value) ?? 0) + at - from);
  }
  return counts;
}

/** Levels that are nearly black or white are, in a mask that is soft or was compressed with loss. */
function clamped(found: Values): Values {
  const { kind, counts, values } = found;
  const levels = [...counts.keys()];
  const isNear = (value: number) => value > 0 && value <= SOFT.ends;
  const soft = kind === 'levels' && counts.size >= SOFT.levels && levels.some(isNear) && levels.some((level) => isNear(255 - level));
  if (!soft) return found;
  const clear = values.map((level) => (isNear(level) ? 0 : isNear(255 - level) ? 255 : level));
  return { ...found, values: clear, counts: counted(clear) };
}

function readingOf(found: Values): Reading {
  const { kind, values, width, height, counts, isCutOut } = clamped(found);
  const all = [...counts.keys()];
  if (kind === 'numbers') return numbers(all);
  const ground = kind === 'levels' || counts.has(BLACK) ? BLACK : WHITE;
  if (kind === 'colours' && (counts.size > MOST_COLOURS || (counts.size > UNLABELLED && !counts.has(ground)))) throw unclear(`${counts.size} colours`);
  if (kind === 'colours' && !counts.has(ground)) throw unclear('neither black nor white, one of which is the background');
  const others = all.filter((value) => value !== ground);
  if (others.length < 2) {
    const cut: AnnotationNote = { code: 'mask-alpha', message: 'what is not transparent is the object' };
    const reading = kind === 'levels' ? levels(all) : colours(others, ground);
    return isCutOut ? { ...reading, note: cut } : reading;
  }
  const { sides, undecided, between, crowded, resolved } = edgesOf(values, width, height, ground);
  const loose = others.filter((value) => !sides.has(value));
  const isSmooth = undecided.length > 0 && between >= SMOOTH && (kind === 'colours' || loose.length >= FEW || (loose.length > 0 && sides.has(255)));
  if (!isSmooth && loose.length >= TOO_MANY && crowded >= CROWDED) {
    throw unclear(`${others.length} ${kind}, ${loose.length} of them of a few pixels at edges`);
  }
  const rest = isSmooth ? [...counted(resolved()).keys()] : all;
  if (rest.length > UNLABELLED) throw unclear(`${others.length} ${kind}`);
  const reading = kind === 'levels' ? levels(rest) : colours(rest.filter((value) => value !== ground), ground);
  if (!isSmooth) return reading;
  const what = `its edges are smoothed: ${loose.length} ${kind} between belong to the nearer side`;
  return { ...reading, smooth: true, note: { code: 'mask-smoothed', message: [what, reading.note?.message].filter(Boolean).join('; ') } };
}

function unclear(what: string): Error {
  return invalidInput(`it has ${what}, so nobody knows which pixels are of which object: save it without smoothing, with one number or colour for each object on black`);
}

function numbers(all: readonly number[]): Reading {
  const isOpen = all.length === 2 && all.includes(0) && all.includes(UNLABELLED);
  return isOpen ? { ...levels(all), isOpen } : literal(all);
}

/** White alone is an object; beside others it says nothing. What is no number of an object gets a free one. */
function levels(all: readonly number[]): Reading {
  const [object, ...more] = all.filter((value) => value !== 0);
  if (object === undefined || more.length > 0 || object < UNLABELLED || !all.includes(0)) return literal(all);
  return {
    meaning: new Map<number, Known | 0>([[0, 0], [object, known('number 1', 1, undefined)]]),
    smooth: false,
    note: { code: 'mask-white', message: `${object} is the object, number 1, and 0 the background` },
  };
}

function literal(all: readonly number[]): Reading {
  const meaningOf = (value: number) => {
    if (value === 0 || value === UNLABELLED) return value;
    return known(`number ${value}`, isObjectNumber(value) ? value : undefined, undefined);
  };
  return { meaning: new Map(all.map((value) => [value, meaningOf(value)])), smooth: false };
}

/** Colours of the DAVIS palette have its numbers if all are of it. */
function colours(all: readonly number[], background: number): Reading {
  const palette = davisPalette().map(([red, green, blue]) => (red << 16) | (green << 8) | blue);
  const indices = all.map((colour) => palette.indexOf(colour));
  const areIndices = indices.every(isObjectNumber);
  const meaning = new Map<number, Known | 0>([[background, 0]]);
  for (const [k, colour] of all.entries()) {
    const name = colour.toString(16).padStart(6, '0');
    meaning.set(colour, areIndices ? known(`number ${indices[k]}`, indices[k], undefined) : known(`colour ${name}`, undefined, undefined));
  }
  const ground = background === BLACK ? 'black' : 'white';
  const which = all.length === 1 ? 'the other colour is the object' : `each of ${all.length} colours is an object`;
  return { meaning, smooth: false, note: { code: 'mask-colours', message: `${ground} is the background, ${which}` } };
}
