// MOTS, as lines of text and as images of 16 bits. Numbers are 1000 × class + instance; 10000 is a region to ignore.

import { invalidInput, UNLABELLED } from '../../common/checks.js';
import { countsOf } from '../coco-rle.js';
import { decodePng, headOf } from '../png-reader.js';
import type { Canvas } from './canvas.js';
import {
  checkSize,
  type Context,
  frameOfShapes,
  type Known,
  known,
  naming,
  type ReadFrame,
  type Shape,
  shapesOf,
  type Source,
  stemOf,
  within,
} from './frame.js';

const CLASS = 1000;
export const IGNORED = 10_000;
const WHITE = 65_535;
const LINE = /^(\d+) (\d+) (\d+) (\d+) (\d+) (\S+)$/;

/** Whether text begins as MOTS does. */
export function isMots(text: string): boolean {
  return LINE.test(/^.*/.exec(text)?.[0].trimEnd() ?? '');
}

/** The numbers in pictures that are MOTS and no masks of another kind: all with 16 bits, and with a class in each number. */
export function numbersOfMots(pictures: readonly Source[]): Set<number> | undefined {
  if (!pictures.every(({ name, bytes }) => naming(name, () => headOf(bytes)).isDeep)) return undefined;
  const seen = new Set<number>();
  for (const { name, bytes } of pictures) for (const level of valuesIn(naming(name, () => decodePng(bytes)).samples)) seen.add(level);
  seen.delete(0);
  const [first] = seen;
  // White on black is no number, and what is ignored alone an object.
  const isMask = first === undefined || (seen.size === 1 && [WHITE, IGNORED].includes(first));
  return !isMask && [...seen].every((level) => level >= CLASS) ? seen : undefined;
}

/** Frames without objects are left out: they may not have been annotated. */
export function readMots(source: Source, text: string, context: Context): ReadFrame[] {
  const { nameOf, classesOf, count, firstFrame } = context;
  const names = classesOf(source.name);
  const frames = new Map<number, { width: number; height: number; shapes: Shape[]; ignored: ((canvas: Canvas) => void)[] }>();
  for (const [k, line] of text.split('\n').entries()) {
    if (line.trim() === '') continue;
    const [, frame, id, , height, width, runs] = LINE.exec(line.trimEnd()) ?? [];
    if (runs === undefined) throw invalidInput(`line ${k + 1} is not "frame id class height width run-lengths"`);
    const size = checkSize(Number(width), Number(height), `line ${k + 1}`);
    const entry = frames.get(Number(frame)) ?? { ...size, shapes: [], ignored: [] };
    frames.set(Number(frame), entry);
    if (entry.width !== size.width || entry.height !== size.height) throw invalidInput(`line ${k + 1}: the frame has had another size`);
    const draw = (canvas: Canvas, label: number) => canvas.columns(countsOf(runs), label);
    if (Number(id) === IGNORED) entry.ignored.push((canvas) => within(`line ${k + 1}`, () => draw(canvas, UNLABELLED)));
    else
      entry.shapes.push(
        ...shapesOf(
          `line ${k + 1}`,
          () => [{ draw }],
          () => objectOf(Number(id), names),
        ),
      );
  }
  if (firstFrame === undefined && !frames.has(0) && !frames.has(count ?? 0)) {
    context.note({
      code: 'first-frame-assumed',
      message: `'${source.name}': nothing tells whether its first frame is 0 or 1, taken is 1: say with --first-frame`,
    });
  }
  const first = frames.has(0) ? 0 : (firstFrame ?? 1);
  return [...frames]
    .sort(([a], [b]) => a - b)
    .map(([frame, { shapes, ignored, ...size }]) => {
      const read = frameOfShapes({ name: nameOf(frame - first), file: source.name, ...size }, shapes, context);
      const draw: ReadFrame['draw'] = (canvas, labelOf) => (read.draw(canvas, labelOf), ignored.forEach((region) => region(canvas)));
      return { ...read, draw };
    });
}

export function readMotsPng(source: Source, { classesOf }: Context): ReadFrame {
  const names = classesOf(source.name);
  const { samples, width, height } = decodePng(source.bytes);
  const values = [...valuesIn(samples)].filter((value) => value !== 0);
  return {
    name: stemOf(source.name),
    file: source.name,
    width,
    height,
    objects: values.filter((value) => value !== IGNORED).map((value) => objectOf(value, names)),
    draw: ({ labels }, labelOf) => {
      const numbers = new Uint8Array(2 ** 16);
      for (const value of values) numbers[value] = value === IGNORED ? UNLABELLED : labelOf(keyOf(value));
      const { samples } = decodePng(source.bytes);
      for (let at = 0; at < samples.length; at++) labels[at] = numbers[samples[at] as number] as number;
    },
  };
}

/** Most pixels have the value of the one before: one by one a set would take most of the time. */
export function valuesIn(values: ArrayLike<number>): Set<number> {
  const seen = new Set<number>();
  for (let at = 0; at < values.length; at++) if (values[at] !== values[at - 1]) seen.add(values[at] as number);
  return seen;
}

function keyOf(id: number): string {
  return `track ${id}`;
}

function objectOf(id: number, names: readonly string[]): Known {
  return known(keyOf(id), id % CLASS, names[Math.floor(id / CLASS) - 1], id);
}
