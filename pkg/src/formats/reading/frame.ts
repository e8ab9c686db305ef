// The result of the readers of all formats: frames, each with what draws its labels, and the objects that they know.

import { invalidInput, isListOf, isObject, isWhole, LONGEST_SIDE, UNLABELLED } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import { checkPath } from '../names.js';
import type { Canvas } from './canvas.js';

/** Objects with the same key are one, in all frames. */
export interface Known {
  key: string;
  /** The number that it has in the file, if any. */
  number?: number;
  name?: string;
}

export interface ReadFrame {
  /** Its name, without folder and extension. */
  name: string;
  /** The file that annotates it. */
  file: string;
  width: number;
  height: number;
  objects: Known[];
  draw: (canvas: Canvas, labelOf: (key: string) => number) => void;
  /** Of objects that have a box and no mask here: where they are. */
  boxes?: { key: string; box: PixelBox }[];
}

/** First column, first row, width and height. */
export type PixelBox = [left: number, top: number, width: number, height: number];

/** One shape, and the object that it is of: it says which pixels that has, or just the box that holds them. */
export type Shape = Known & ({ draw: (canvas: Canvas, label: number) => void } | { box: readonly number[] });

/** A file, or what is in an archive. */
export interface Source {
  name: string;
  bytes: Uint8Array;
}

/** Information that a reader may need beside the file. */
export interface Context {
  /** The name of the frame of this index, where the format only counts frames. */
  nameOf: (index: number) => string;
  /** The lines of the file `labels.txt` in the same folder: the names of classes by number, from 1. */
  classesOf: (source: Source) => string[];
  /** The names of YOLO's classes, by number, that hold for a file. */
  namesOf: (file: string) => string[];
  /** The size of the frame that is called as the file, where the format does not say it. */
  sizeOf: (file: string) => { width: number; height: number };
  /** Counts what the file has and is not read: a kind of shape, in the plural. */
  leaveOut: (file: string, kind: string) => void;
}

/** A frame of shapes, drawn one after another. Inside a box nothing is known of the ground. */
export function frameOfShapes(frame: Omit<ReadFrame, 'objects' | 'draw' | 'boxes'>, shapes: readonly Shape[], { leaveOut }: Context): ReadFrame {
  const masks = shapes.filter((shape) => 'draw' in shape);
  const seen = new Set(masks.map(({ key }) => key));
  const boxes: { key: string; box: PixelBox }[] = [];
  for (const shape of shapes) {
    if ('draw' in shape) continue;
    const box = withinFrame(shape.box, frame);
    if (!box) leaveOut(frame.file, 'boxes outside the frame');
    else if (seen.has(shape.key)) leaveOut(frame.file, 'boxes of objects that have a mask or another box');
    else boxes.push({ key: shape.key, box });
    seen.add(shape.key);
  }
  const draw = (canvas: Canvas, labelOf: (key: string) => number) => {
    for (const shape of masks) shape.draw(canvas, labelOf(shape.key));
    for (const { box } of boxes) canvas.open(box);
  };
  const objects = shapes.filter(({ key }) => masks.some((mask) => mask.key === key) || boxes.some((box) => box.key === key));
  return { ...frame, objects: objects.map(({ key, number, name }) => known(key, number, name)), draw, ...(boxes.length > 0 && { boxes }) };
}

/** The pixels of a box that are in the frame. */
function withinFrame(box: readonly number[], { width, height }: { width: number; height: number }): PixelBox | undefined {
  const [x, y, w, h] = box as PixelBox;
  if (!box.every(Number.isFinite)) throw invalidInput('a box must have four numbers');
  const [left, top] = [Math.max(0, Math.floor(x)), Math.max(0, Math.floor(y))];
  const [right, bottom] = [Math.min(width, Math.ceil(x + w)), Math.min(height, Math.ceil(y + h))];
  return right > left && bottom > top ? [left, top, right - left, bottom - top] : undefined;
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

/** A shape of which errors in drawing say where it is in the file, too. */
export function placed(place: string, read: () => Shape): Shape {
  const shape = within(place, read);
  if (!('draw' in shape)) return shape;
  return { ...shape, draw: (canvas, label) => within(place, () => shape.draw(canvas, label)) };
}

/** A text of the file in an error. */
export function quoted(value: unknown): string {
  return JSON.stringify(value)?.slice(0, 60) ?? 'nothing';
}

export function known(key: string, number: number | undefined, name: string | undefined): Known {
  return { key, ...(number !== undefined && { number }), ...(name !== undefined && { name }) };
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

export function wrong(file: string, what: string): VeroneseError {
  return invalidInput(`'${file}' ${what}`);
}

/** Runs a reader of a file: its errors name the file. */
export function naming<T>(file: string, read: () => T): T {
  try {
    return read();
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw new VeroneseError(thrown.code, `'${file}': ${thrown.message}`);
    if (thrown instanceof RangeError) throw wrong(file, 'cannot be read: it is nested too deeply, or too large');
    throw thrown;
  }
}

/** Runs what decodes a picture, whose sentences lack what they are about. */
export function decoding<T>(what: string, decode: () => T): T {
  try {
    return decode();
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw new VeroneseError(thrown.code, `${what} ${thrown.message}`);
    throw thrown;
  }
}

/** A frame's name from that of its image: without folder and extension. Throws `invalid-input` unless it can be that of a file. */
export function stemOf(image: unknown): string {
  if (typeof image !== 'string') throw invalidInput("a frame's image must be text, the name of its file");
  const stem = image.replace(/^.*[/\\]/s, '').replace(/(?<=.)\.[^.]*$/s, '');
  checkPath(stem);
  return stem;
}

export function checkSize(width: unknown, height: unknown, whose: string): { width: number; height: number } {
  if (isWhole(width, 1, LONGEST_SIDE) && isWhole(height, 1, LONGEST_SIDE)) return { width, height };
  throw invalidInput(`the width and height of ${whose} must be whole numbers from 1 to ${LONGEST_SIDE}`);
}

/** A box inside the frame. */
export function checkBox([left, top, width, height]: readonly unknown[], frame: { width: number; height: number }) {
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
