// The result of the readers of all formats: frames, each with what draws its labels, and the objects that they know.

import type { AnnotationNote } from '../../../types/formats.js';
import { invalidInput, isListOf, isObject, isWhole, LONGEST_LABEL_SIDE, MOST_LABELS, UNLABELLED } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import { checkPath } from '../file-names.js';
import type { Size } from '../png-reader.js';
import type { Canvas } from './canvas.js';

/** Objects with the same key are one, in all frames. */
export interface Known {
  key: string;
  /** The number that it should have, if any. */
  number?: number;
  /** What it is called by in the file. */
  original?: number | string;
  name?: string;
}

export interface ReadFrame extends Size {
  /** Its name, without folder and extension. */
  name: string;
  /** The file that annotates it. */
  file: string;
  objects: Known[];
  draw: (canvas: Canvas, labelOf: (key: string) => number) => void;
  /** Of objects that have a box and no mask here: where they are. */
  boxes?: { key: string; box: PixelBox }[];
  /** Whether shapes are there, and none of them is a mask: nobody has drawn what is ground. */
  isOpen?: boolean;
}

/** First column, first row, width and height. */
export type PixelBox = [left: number, top: number, width: number, height: number];

/** Which pixels an object has, or just the box that holds them. */
type Marked = { draw: (canvas: Canvas, label: number) => void } | { box: readonly number[] };

/** A shape that is not read: what it is, in the plural, and the box around all that it marks, where that is known. */
interface LeftOut {
  leftOut: string;
  place?: readonly number[];
}

export type Drawing = Marked | LeftOut;

/** One shape, and the object that it is of. */
export type Shape = (Known & Marked) | LeftOut;

/** A file, or what is in an archive. */
export interface Source {
  name: string;
  bytes: Uint8Array;
}

/** Information that a reader may need beside the file. */
export interface Context {
  /** The name of the frame of this index, where the format only counts frames. */
  nameOf: (index: number) => string;
  /** The number of the first frame, where the format may count from 0 or from 1. */
  firstFrame: 0 | 1 | undefined;
  /** The lines of the file `labels.txt` in the same folder: the names of classes by number, from 1. */
  classesOf: (file: string) => string[];
  /** The names of YOLO's classes, by number, that hold for a file. */
  namesOf: (file: string) => string[];
  /** The size of the frame that is called as the file, where the format does not say it. */
  sizeOf: (file: string) => Size;
  /** The number of frames, where that is known. */
  count: number | undefined;
  /** Counts what the file has and is not read: a kind of shape, in the plural. */
  leaveOut: (file: string, kind: string) => void;
  /** Takes what was assumed of a file. */
  note: (note: AnnotationNote) => void;
}

/**
 * A frame of shapes, drawn one after another. Inside a box nothing is known of the ground, nor where a shape was not read: in the whole frame,
 * if that has no place.
 */
export function frameOfShapes(
  frame: Omit<ReadFrame, 'objects' | 'draw' | 'boxes'>,
  shapes: readonly Shape[],
  { leaveOut }: Context,
): ReadFrame {
  const masks = shapes.filter((shape) => 'draw' in shape);
  const seen = new Set(masks.map(({ key }) => key));
  const whole: PixelBox = [0, 0, frame.width, frame.height];
  const boxes: { key: string; box: PixelBox }[] = [];
  let open: PixelBox[] = [];
  for (const shape of shapes) {
    if ('draw' in shape) continue;
    const box = withinFrame('leftOut' in shape ? (shape.place ?? whole) : shape.box, frame);
    if (box) open.push(box);
    if ('leftOut' in shape) leaveOut(frame.file, shape.leftOut);
    else if (!box) leaveOut(frame.file, 'boxes without a pixel of the frame');
    else if (seen.has(shape.key)) leaveOut(frame.file, 'boxes of objects that have a mask or another box');
    else {
      boxes.push({ key: shape.key, box });
      seen.add(shape.key);
    }
  }
  if (open.some(([, , width, height]) => width === frame.width && height === frame.height)) open = [whole];
  const draw = (canvas: Canvas, labelOf: (key: string) => number) => {
    for (const shape of masks) shape.draw(canvas, labelOf(shape.key));
    for (const box of open) canvas.open(box);
  };
  const isOpen = masks.length === 0 && (open.length > 0 || shapes.some((shape) => 'leftOut' in shape));
  const objects = shapes.filter((shape): shape is Known & Marked => !('leftOut' in shape) && seen.has(shape.key));
  return { ...frame, objects, draw, ...(boxes.length > 0 && { boxes }), ...(isOpen && { isOpen }) };
}

/** The pixels of a box that are in the frame. */
function withinFrame(box: readonly number[], { width, height }: Size): PixelBox | undefined {
  const [x, y, w, h] = box as PixelBox;
  if (!box.every(Number.isFinite)) throw invalidInput('a box must have four numbers');
  const [left, top] = [Math.max(0, Math.floor(x)), Math.max(0, Math.floor(y))];
  const [right, bottom] = [Math.min(width, Math.ceil(x + w)), Math.min(height, Math.ceil(y + h))];
  return right > left && bottom > top ? [left, top, right - left, bottom - top] : undefined;
}

/** The box around a box that is turned by an angle in degrees about a point. */
export function turnedBox(box: readonly [number, number, number, number], angle: number, [x, y]: readonly [number, number]): Drawing {
  if (angle === 0) return { box };
  const [left, top, width, height] = box;
  const [cosine, sine] = [Math.cos((angle * Math.PI) / 180), Math.sin((angle * Math.PI) / 180)];
  const [u, v] = [left + width / 2 - x, top + height / 2 - y];
  const [across, down] = [width * Math.abs(cosine) + height * Math.abs(sine), width * Math.abs(sine) + height * Math.abs(cosine)];
  return { box: [x + u * cosine - v * sine - across / 2, y + u * sine + v * cosine - down / 2, across, down] };
}

/** A polygon, x and y of one vertex after another. One of fewer than three vertices, as a click makes it, is left out. */
export function polygonOf(ring: readonly unknown[]): Drawing {
  if (ring.length > 4 || ring.length % 2 === 1) return { draw: (canvas, label) => canvas.polygon(ring, label) };
  const [x, y, endX = x, endY = y] = ring.map(Number) as [number, number, number?, number?];
  const place = [Math.min(x, endX), Math.min(y, endY), Math.max(1, Math.abs(endX - x)), Math.max(1, Math.abs(endY - y))];
  return { leftOut: 'polygons of fewer than three vertices', place: ring.length === 0 ? [0, 0, 0, 0] : place };
}

/** The shapes of one object in a place of a file; what is left out is of no object. Errors, also those in drawing, say the place. */
export function shapesOf(place: string, drawings: () => Drawing[], object: () => Known): Shape[] {
  return within(place, () => {
    const all = drawings();
    const known = all.some((drawing) => !('leftOut' in drawing)) ? object() : undefined;
    return all.map((drawing): Shape => {
      if (!known || 'leftOut' in drawing) return drawing as LeftOut;
      if ('box' in drawing) return { ...known, ...drawing };
      return { ...known, draw: (canvas, label) => within(place, () => drawing.draw(canvas, label)) };
    });
  });
}

/** Reads a part of a file: its errors say which. */
export function within<T>(place: string, read: () => T): T {
  try {
    return read();
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw new VeroneseError(thrown.code, `${place}: ${thrown.message}`);
    throw thrown;
  }
}

/** Runs a reader of a file: its errors name the file. */
export function naming<T>(file: string, read: () => T): T {
  return within(`'${file}'`, () => {
    try {
      return read();
    } catch (thrown) {
      throw thrown instanceof RangeError ? invalidInput('it cannot be read: it is nested too deeply, or too large') : thrown;
    }
  });
}

/** A text of the file in an error. */
export function quoted(value: unknown): string {
  return JSON.stringify(value)?.slice(0, 60) ?? 'nothing';
}

/** An object that has the number in the file, or another name for it; what is neither a number nor text is none. */
export function known(key: string, number: unknown, name: string | undefined, original: unknown = number): Known {
  const isCalled = typeof original === 'string' || Number.isFinite(original);
  return {
    key,
    ...(isObjectNumber(number) && { number }),
    ...(isCalled && { original: original as number | string }),
    ...(name !== undefined && { name }),
  };
}

/** Keys of objects without a number: the second car of one frame is the second car of another one. Made anew for each frame. */
export class Unnumbered {
  readonly #counts = new Map<string, number>();

  keyOf(name = ''): string {
    const count = (this.#counts.get(name) ?? 0) + 1;
    this.#counts.set(name, count);
    return `${count} ${name}`;
  }
}

export function isPng(bytes: Uint8Array): boolean {
  return bytes[0] === 0x89 && bytes[1] === 0x50;
}

/** A number that an object may have here. */
export function isObjectNumber(value: unknown): value is number {
  return isWhole(value, 1, UNLABELLED - 1);
}

/** A frame's name from that of its image: without folder and extension. Throws `invalid-input` unless it can be that of a file. */
export function stemOf(image: unknown): string {
  if (typeof image !== 'string') throw invalidInput("a frame's image must be text, the name of its file");
  const stem = image.replace(/^.*[/\\]/s, '').replace(/(?<=.)\.[^.]*$/s, '');
  checkPath(stem);
  return stem;
}

export function checkSize(width: unknown, height: unknown, whose: string): Size {
  if (isWhole(width, 1, LONGEST_LABEL_SIDE) && isWhole(height, 1, LONGEST_LABEL_SIDE) && width * height <= MOST_LABELS)
    return { width, height };
  throw invalidInput(
    `the width and height of ${whose} must be whole numbers from 1 to ${LONGEST_LABEL_SIDE}, of ${MOST_LABELS} pixels at most`,
  );
}

/** A box inside the frame. */
export function checkBox([left, top, width, height]: readonly unknown[], frame: Size) {
  const [right, bottom] = [frame.width - 1, frame.height - 1];
  if (isWhole(left, 0, right) && isWhole(top, 0, bottom) && isWhole(width, 1, right + 1 - left) && isWhole(height, 1, bottom + 1 - top)) {
    return { left, top, width, height };
  }
  throw invalidInput('a mask must lie inside the frame, its corners at whole pixels');
}

/** The entries of a list of objects. */
export function listOf(value: unknown, what: string): Record<string, unknown>[] {
  if (isListOf(value, isObject)) return value;
  throw invalidInput(`"${what}" must be a list of objects`);
}

/** Adds to the list of a key. */
export function addTo<K, T>(lists: Map<K, T[]>, key: K, ...entries: T[]): void {
  const list = lists.get(key);
  if (list) list.push(...entries);
  else lists.set(key, entries);
}
