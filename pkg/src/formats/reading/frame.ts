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
}

/** One shape, and the object that it is of. */
export interface Shape extends Known {
  draw: (canvas: Canvas, label: number) => void;
}

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
}

/** A frame of shapes, drawn one after another. */
export function frameOfShapes(frame: Omit<ReadFrame, 'objects' | 'draw'>, shapes: readonly Shape[]): ReadFrame {
  const draw = (canvas: Canvas, labelOf: (key: string) => number) => {
    for (const shape of shapes) shape.draw(canvas, labelOf(shape.key));
  };
  return { ...frame, objects: shapes.map(({ key, number, name }) => known(key, number, name)), draw };
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
