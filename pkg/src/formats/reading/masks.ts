// Masks in PNG files, as people have them: numbers of objects as indices or grey levels, white on black, one colour for each object, what is
// not transparent, a folder for each object. What a file is taken for is said in a note; where edges are smoothed, people have to say it.

import type { AnnotationNote, Levels } from '../../../types/formats.js';
import { invalidInput, UNLABELLED } from '../../common/checks.js';
import { decodePng, type Samples, type Size } from '../png-reader.js';
import { addTo, isObjectNumber, type Known, known, naming, type ReadFrame, type Source, stemOf } from './frame.js';
import { davisIndices } from './mask.js';
import { valuesIn } from './mots.js';
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
  /** The level that says nothing beside others: the largest one. */
  white: number;
  /** What a person sees: levels or, where these differ, colours; of indices those of the palette. */
  seen: { kind: 'level' | 'colour'; values: Int32Array };
  /** Whether what is seen may be smoothed. */
  isPlain: boolean;
  note?: AnnotationNote;
}

/** What a file is taken for: the meaning of each value. */
interface MaskFile extends Size {
  name: string;
  values: () => Int32Array;
  meaning: Map<number, Known | typeof UNLABELLED | 0>;
  note?: AnnotationNote | undefined;
  /** 0 and the largest level alone: what that is depends on the other files. */
  isOpen?: boolean;
}

/** Frames of masks, and what was assumed of the files. */
export function readMasks(sources: readonly Source[], levels: Levels | undefined): { frames: ReadFrame[]; notes: AnnotationNote[] } {
  const files = sources.map((source) => naming(source.name, () => maskFileOf(source, levels)));
  const folders = sources.map(({ name }) => /(?:^|\/)(\d+)\/[^/]+$/.exec(name)?.[1]);
  const isOne = ({ meaning }: MaskFile) => [...meaning.keys()].filter((value) => value !== 0).length <= 1;
  if (files.every(isOne) && folders.every((folder) => folder !== undefined)) {
    const ground = files[folders.indexOf(GROUND)];
    const message = `'${ground?.name}': folder ${GROUND} is the background; that of an object is called 00 or 000`;
    return { frames: united(files, folders), notes: ground ? [{ code: 'mask-background', message }] : [] };
  }
  const hasNumbers = files.some(({ isOpen, meaning }) => !isOpen && [...meaning.values()].some((one) => typeof one === 'object'));
  const closed = files.map((file) => (file.isOpen && hasNumbers ? closedOf(file) : file));
  return { frames: closed.map(frameOf), notes: notesOf(closed) };
}

/** White says nothing beside numbers. */
function closedOf(file: MaskFile): MaskFile {
  const meaning = new Map([...file.meaning].map(([value, one]) => [value, typeof one === 'object' ? UNLABELLED : one] as const));
  const white = Math.max(...meaning.keys());
  return { ...file, meaning, note: { code: 'mask-white', message: `${white} says nothing: there are numbers of objects in other files` } };
}

function frameOf({ name: file, width, height, values, meaning }: MaskFile): ReadFrame {
  return {
    name: stemOf(file),
    file,
    width,
    height,
    objects: [...meaning.values()].filter((one): one is Known => typeof one === 'object'),
    draw: ({ labels }, labelOf) => {
      const numbers = new Map([...meaning].map(([value, one]) => [value, typeof one === 'object' ? labelOf(one.key) : one]));
      const all = values();
      let [value, number] = [NaN, 0];
      for (let at = 0; at < labels.length; at++) {
        // Most pixels have the value of the one before.
        if (all[at] !== value) [value, number] = [all[at] as number, numbers.get(all[at] as number) as number];
        labels[at] = number;
      }
    },
  };
}

/** One frame of the files of all its objects, each in the folder called by its number; 0, without more zeros, is the background. */
function united(files: readonly MaskFile[], folders: readonly (string | undefined)[]): ReadFrame[] {
  const frames = new Map<string, (MaskFile & { object: Known | undefined })[]>();
  for (const [k, file] of files.entries()) {
    const object = folders[k] === GROUND ? undefined : known(`number ${Number(folders[k])}`, Number(folders[k]), undefined);
    addTo(frames, stemOf(file.name), { ...file, object });
  }
  return [...frames].map(([name, parts]) => {
    const { name: file, width, height } = parts[0] as MaskFile;
    const other = parts.find((part) => part.width !== width || part.height !== height);
    if (other) throw invalidInput(`'${other.name}' has another size than '${file}'`);
    return {
      name,
      file,
      width,
      height,
      objects: parts.flatMap(({ object }) => object ?? []),
      draw: ({ labels }, labelOf) => {
        for (const { object, values } of parts) {
          const label = object && labelOf(object.key);
          if (label !== undefined) values().forEach((value, at) => value !== 0 && (labels[at] = label));
        }
      },
    };
  });
}

/** What was assumed, once for all files of which it was. */
function notesOf(files: readonly MaskFile[]): AnnotationNote[] {
  const byMessage = new Map<string, { code: string; names: string[] }>();
  for (const { note, name } of files) {
    if (!note) continue;
    const entry = byMessage.get(note.message) ?? { code: note.code, names: [] };
    byMessage.set(note.message, entry);
    entry.names.push(name);
  }
  return [...byMessage].map(([message, { code, names }]) => {
    const others = names.length > 1 ? ` and ${names.length - 1} more` : '';
    return { code, message: `'${names[0]}'${others}: ${message}` };
  });
}

function valuesOf(png: Samples, levels: Levels | undefined): Values {
  const found = png.palette ? indexed(png, png.palette) : direct(png);
  if (typeof levels !== 'number') return found;
  const brightest = (colour: number) => Math.max(colour >> 16, (colour >> 8) & 255, colour & 255);
  const { kind, values } = found.seen;
  const isObject = (value: number) => (kind === 'level' ? value : brightest(value)) >= levels;
  return { ...found, isColour: false, white: UNLABELLED, values: values.map((value) => (isObject(value) ? UNLABELLED : 0)) };
}

/** Transparent pixels are background; without any colours of its own, what is not transparent is one object. */
function direct({ width, height, channels, depth, samples }: Samples): Values {
  const byte = (at: number) => Math.round((255 * (samples[at] as number)) / (2 ** depth - 1));
  let isGrey = true;
  for (let at = 0; channels > 2 && isGrey && at < samples.length; at += channels)
    isGrey = samples[at] === samples[at + 1] && samples[at] === samples[at + 2];
  const colours = new Int32Array(width * height);
  for (let p = 0, at = 0; p < colours.length; p++, at += channels)
    colours[p] = isGrey ? (samples[at] as number) : (byte(at) << 16) | (byte(at + 1) << 8) | byte(at + 2);
  const of = (values: Int32Array): Values => {
    const [kind, white] = isGrey ? (['level', 2 ** Math.max(depth, 8) - 1] as const) : (['colour', WHITE] as const);
    return { isColour: !isGrey, values, seen: { kind, values }, isPlain: true, white };
  };
  if (channels % 2 === 1) return of(colours);
  const alpha = colours.map((_, p) => byte(channels * (p + 1) - 1));
  const opaque = valuesIn(colours.filter((_, p) => alpha[p] !== 0));
  if (!alpha.includes(0) || opaque.size === 0) return of(colours);
  if (opaque.size > 1 && opaque.size <= OF_A_PICTURE) return of(colours.map((colour, p) => (alpha[p] === 0 ? BLACK : colour)));
  return {
    isColour: false,
    values: alpha.map((level) => (level > 0 ? UNLABELLED : 0)),
    white: UNLABELLED,
    seen: { kind: 'level', values: alpha },
    isPlain: true,
    note: { code: 'mask-alpha', message: 'what is not transparent is the object' },
  };
}

/** Indices are numbers of objects, 0 the background, unless black has another index. */
function indexed({ samples, alpha }: Samples, palette: Uint8Array): Values {
  const indices = new Int32Array(samples);
  const isClear = (index: number) => alpha?.[index] === 0;
  const colours = Int32Array.from({ length: 256 }, (_, index) => {
    const [red = 0, green = 0, blue = 0] = isClear(index) ? [] : palette.subarray(3 * index);
    return (red << 16) | (green << 8) | blue;
  });
  const used = [...valuesIn(indices)];
  const seen = indices.map((index) => colours[index] as number);
  const isMoved = used.includes(0) && !isClear(0) && colours[0] !== BLACK && used.some((index) => colours[index] === BLACK);
  if (isMoved) return { isColour: true, values: seen, seen: { kind: 'colour', values: seen }, isPlain: true, white: WHITE };
  const isGrey = used.every((index) => colours[index] === ((colours[index] as number) & 255) * 0x010101);
  return {
    isColour: false,
    values: indices.map((index) => (isClear(index) ? 0 : index)),
    white: UNLABELLED,
    seen: isGrey ? { kind: 'level', values: seen.map((colour) => colour & 255) } : { kind: 'colour', values: seen },
    isPlain: isGrey,
  };
}

function maskFileOf({ name, bytes }: Source, levels: Levels | undefined): MaskFile {
  const png = decodePng(bytes);
  const { isColour, values, seen, isPlain, white, note } = valuesOf(png, levels);
  const { width, height } = png;
  // Of 8 bits, each byte is there twice.
  if (isColour && png.samples.some((value, at) => png.depth === 16 && value % 257 !== 0 && at % png.channels < 3))
    throw invalidInput('it has colours of 16 bits that 8 do not hold: save it with 8, or as grey levels');
  const all = [...valuesIn(values)];
  const ground = isColour && !all.includes(BLACK) ? WHITE : BLACK;
  if (isPlain && levels === undefined) checkCrisp(seen.values, { width, height }, seen.kind, ground);
  if (isColour && !all.includes(ground)) throw invalidInput('it has neither black nor white, one of which is the background of colours');
  const objects = all.filter((value) => value !== ground);
  if (objects.length >= UNLABELLED + Number(objects.includes(white))) throw invalidInput(`it has more than ${UNLABELLED - 1} objects`);
  const file = { name, width, height, values: () => valuesOf(decodePng(bytes), levels).values };
  if (isColour) return { ...file, ...colours(objects, ground) };
  if (objects.length === 1 && objects[0] === white && (all.includes(0) || typeof levels === 'number')) {
    const meaning: MaskFile['meaning'] = new Map([[0, 0]]);
    meaning.set(white, known('number 1', 1, undefined));
    if (levels !== undefined) return { ...file, meaning };
    const taken = { code: 'mask-white', message: `${white} is the object, number 1, and 0 the background` };
    return { ...file, meaning, note: note ?? taken, isOpen: note === undefined };
  }
  const meaningOf = (value: number) => (value === 0 ? 0 : value === white ? UNLABELLED : known(`number ${value}`, value, undefined));
  return { ...file, meaning: new Map(all.map((value) => [value, meaningOf(value)])) };
}

/** Colours of the DAVIS palette have its numbers if all are of it. */
function colours(all: readonly number[], background: number): Pick<MaskFile, 'meaning' | 'note'> {
  const palette = davisIndices();
  const areIndices = all.every((colour) => isObjectNumber(palette.get(colour)));
  const meaning: MaskFile['meaning'] = new Map([[background, 0]]);
  for (const colour of all) {
    const [name, index] = [colour.toString(16).padStart(6, '0'), palette.get(colour)];
    meaning.set(colour, areIndices ? known(`number ${index}`, index, undefined) : known(`colour ${name}`, undefined, `#${name}`));
  }
  const ground = background === BLACK ? 'black' : 'white';
  const which = all.length === 1 ? 'the other colour is the object' : `each of ${all.length} colours is an object`;
  return { meaning, note: { code: 'mask-colours', message: `${ground} is the background, ${which}` } };
}
