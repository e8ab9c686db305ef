// The frames to encode, one after another: each is checked, and encoded before the next is asked for, so that one is held at a time.

import type { EncodedFile, FormatMotion, LabelFrame } from '../../types/formats.js';
import { invalidInput, isArrayOf, isListOf, isObject, isWhole, keyOf, LONGEST_SIDE, reading, UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { type Mask, masksOf } from './masks.js';
import { isLabel, isText, type Settings } from './metadata.js';
import { checkPath } from './file-names.js';

/** A frame, checked. */
export interface Frame {
  /** Its place among the frames, from 0. */
  index: number;
  /** Name of its file. */
  image: string;
  labels: Uint8Array;
  width: number;
  height: number;
  motions: FormatMotion[];
  masks: Mask[];
}

/** The size of the frames, and how many there were. */
export interface Extent {
  width: number;
  height: number;
  length: number;
}

/** What writes the files of a format. */
export interface Encoder {
  /** The files of this frame alone. */
  add(frame: Frame): EncodedFile[] | void;
  /** Those that are about all frames. */
  finish(extent: Extent): EncodedFile[];
}

/** The frame after those of the `extent`. Throws `invalid-input`, or `frame-size-mismatch`. */
export function frameOf(given: unknown, extent: Extent | undefined, settings: Settings): Frame {
  return reading(() => {
    const index = extent?.length ?? 0;
    if (!isObject(given)) throw noFrames();
    const { labels, width, height, image, index: own = index } = given as unknown as LabelFrame;
    if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE)) {
      throw invalidInput(`width and height must be whole numbers from 1 to ${LONGEST_SIDE}`);
    }
    if (!isArrayOf(labels, 'Uint8Array') || labels.length !== width * height) {
      throw invalidInput(`the labels must be a Uint8Array of ${width} × ${height} entries`);
    }
    if (image !== undefined && !isText(image)) throw invalidInput("a frame's image must be text, the name of its file");
    if (!isWhole(own, 0, Number.MAX_SAFE_INTEGER)) throw invalidInput("a frame's index must be a whole number from 0");
    if (settings.times !== undefined && index >= settings.times) throw invalidInput('timestamps must have a number for each frame');
    if (extent && (width !== extent.width || height !== extent.height)) {
      throw new VeroneseError('frame-size-mismatch', 'the frames must have one size');
    }
    const motions = motionsOf(given as unknown as LabelFrame);
    let masks: Mask[] | undefined;
    return {
      index,
      image: image ?? (settings.one ? 'first.png' : `${String(own).padStart(5, '0')}.png`),
      labels,
      width,
      height,
      motions,
      get masks() {
        return (masks ??= masksOf(this, settings));
      },
    };
  });
}

export function noFrames(): VeroneseError {
  return invalidInput('the frames must be { labels, width, height }, or what gives some one after another');
}

/** Of a segmented pair or a frame of a clip. */
function motionsOf({ motions, objects = [], background }: LabelFrame): FormatMotion[] {
  if (motions === undefined) {
    if (!isListOf(objects, isObject)) throw invalidInput("a frame's objects must each have an id and a matrix");
    const ofObjects = objects.flatMap(({ id, matrix }) => (matrix ? [{ label: id, matrix }] : []));
    return motionsOf({ motions: [...(background ? [{ label: 0, matrix: background }] : []), ...ofObjects] } as unknown as LabelFrame);
  }
  if (!isListOf(motions, isMotion)) throw invalidInput('motions must each have a label and a matrix of six numbers');
  if (new Set(motions.map(({ label }) => label)).size < motions.length) throw invalidInput('motions has a label twice');
  return motions.map(({ label, matrix }) => ({ label, matrix: [...matrix] }));
}

function isMotion(value: unknown): value is FormatMotion {
  if (!isObject(value)) return false;
  const { label, matrix } = value;
  return isLabel(label) && isListOf(matrix, (entry): entry is number => Number.isFinite(entry)) && matrix.length === 6;
}

/** A label as a number where 0 means none: no mask has 255. */
export function idOf(label: number): number {
  return label === 0 ? UNLABELLED : label;
}

/** Gives each entry that is new the next number, from 1. */
export class Numbering {
  readonly entries: string[] = [];

  constructor(first: readonly string[] = []) {
    for (const entry of first) this.of(entry);
  }

  of(entry: string): number {
    const found = this.entries.indexOf(entry);
    return found < 0 ? this.entries.push(entry) : found + 1;
  }
}

/** Names of the frames' own files: those of their images without extension. */
export class Stems {
  readonly #taken = new Set<string>();

  /** Throws `invalid-input` where the file would be elsewhere, or another frame's. */
  of({ image }: Frame): string {
    const stem = image.replace(/\.[^./]*$/, '');
    checkPath(stem);
    if (this.#taken.has(keyOf(stem))) throw invalidInput(`two frames have the name '${stem}'`);
    this.#taken.add(keyOf(stem));
    return stem;
  }
}

export function json(name: string, document: object): EncodedFile {
  return { name, content: `${JSON.stringify(document)}\n` };
}

export function lines(texts: readonly string[]): string {
  return texts.map((text) => `${text}\n`).join('');
}
