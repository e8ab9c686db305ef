// The input of every encoder: a label image and the metadata of its masks. Checked once, here.

import type { FormatMeta, FormatMotion } from '../../types/formats.js';
import {
  entriesOf,
  invalidInput,
  invalidOption,
  isArrayOf,
  isListOf,
  isObject,
  isWhole,
  LONGEST_SIDE,
  reading,
  UNLABELLED,
  unknownOf,
} from '../common/checks.js';

/** One label's pixels inside their bounding box. */
export interface Mask {
  label: number;
  name: string;
  /** Number of its class: the place in the list of classes, if it is there; otherwise after that list by the smallest label that has the same name. */
  category: number;
  /** Top-left corner and size of the bounding box in the image, pixels. */
  left: number;
  top: number;
  width: number;
  height: number;
  /** Number of its pixels, at least 1. */
  area: number;
  /** Row by row over the box: 1 where the pixel has the label, else 0. */
  pixels: Uint8Array;
  motion?: FormatMotion;
}

/** The masks of the labels that are there, by label; 255 is never one. Throws `invalid-input`. */
export function masksOf(labels: Uint8Array, width: number, height: number, meta: FormatMeta): Mask[] {
  checkLabels(labels, width, height);
  const known = checkedMeta(meta);
  const wanted = known.labels && new Set(known.labels);
  const boxes = boxesOf(labels, width);
  const masks: Mask[] = [];
  for (const [label, box] of boxes.entries()) {
    if (box === undefined || label === UNLABELLED || wanted?.has(label) === false) continue;
    const motion = known.motions?.find((motion) => motion.label === label);
    const name = nameOf(label, known);
    masks.push({ ...crop(labels, width, label, box), name, category: categoryOf(name, label, known), ...(motion && { motion }) });
  }
  return masks;
}

export function nameOf(label: number, { names }: Pick<FormatMeta, 'names'>): string {
  return names?.[label] ?? `motion-${label}`;
}

function categoryOf(name: string, label: number, meta: Pick<FormatMeta, 'names' | 'classes'>): number {
  const { classes = [] } = meta;
  const listed = classes.indexOf(name);
  if (listed >= 0) return listed;
  let category = 0;
  while (category < label && nameOf(category, meta) !== name) category++;
  return classes.length + category;
}

/** The names of the classes, each once: those of the list, then others in the order of the masks. */
export function classNames(masks: readonly Mask[], { classes = [] }: Pick<FormatMeta, 'classes'>): string[] {
  return [...new Set([...classes, ...masks.map(({ name }) => name)])];
}

/** The name of the first frame's file. */
export function imageOf({ image }: Pick<FormatMeta, 'image'>): string {
  return image ?? 'first.png';
}

export function checkLabels(labels: Uint8Array, width: number, height: number): void {
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE)) {
    throw invalidInput(`width and height must be whole numbers from 1 to ${LONGEST_SIDE}`);
  }
  if (!isArrayOf(labels, 'Uint8Array') || labels.length !== width * height) {
    throw invalidInput(`the labels must be a Uint8Array of ${width} × ${height} entries`);
  }
}

/** The metadata of labels, as a copy: documents share nothing with what they are made of. `more` may be there as well. */
export function checkedMeta(meta: unknown, more: readonly string[] = []): FormatMeta {
  return reading(() => {
    if (meta === undefined) return {};
    if (!isObject(meta)) throw invalidInput('what is known beside the labels must be an object');
    const unknown = unknownOf(meta, ['image', 'names', 'classes', 'motions', 'labels', ...more]);
    if (unknown !== undefined) throw invalidInput(`nothing is known as ${unknown}`);
    const { image, names, classes, motions, labels } = meta;
    if (!isText(image)) throw invalidInput('image must be text, the name of a file');
    if (names !== undefined && !(typeof names === 'object' && names && Object.values(names).every(isText))) {
      throw invalidInput('names must hold a text for each label');
    }
    if (classes !== undefined && !(isListOf(classes, isName) && new Set(classes).size === classes.length)) {
      throw invalidInput('classes must be a list of names, each once');
    }
    if (motions !== undefined && !isListOf(motions, isMotion)) {
      throw invalidInput('motions must each have a label and a matrix of six numbers');
    }
    if (motions !== undefined && new Set(motions.map(({ label }) => label)).size < motions.length) throw invalidInput('motions has a label twice');
    if (labels !== undefined && !isListOf(labels, isLabel)) throw invalidInput('labels must be a list of labels');
    return {
      ...(image !== undefined && { image }),
      ...(names !== undefined && { names: { ...(names as Record<number, string>) } }),
      ...(classes !== undefined && { classes: [...classes] }),
      ...(motions !== undefined && { motions: motions.map(copied) }),
      ...(labels !== undefined && { labels }),
    };
  });
}

/**
 * Throws `invalid-option`. The first of the shapes is the default; `texts` are options with the values that they have otherwise, `more`
 * those that the caller looks at.
 */
export function checkedOptions<Shape extends string, Texts extends Record<string, string>, More extends string>(
  options: unknown,
  shapes: readonly Shape[],
  texts?: Texts,
  more: readonly More[] = [],
): { shape: Shape; tolerance: number } & Texts & Partial<Record<More, unknown>> {
  return reading(() => {
    const known = [...(shapes.length > 0 ? ['shape'] : []), 'tolerance', ...Object.keys(texts ?? {}), ...more];
    const whole = { shape: shapes[0], tolerance: 0, ...texts, ...entriesOf(options, known) };
    const { shape, tolerance } = whole as { shape: unknown; tolerance: unknown };
    if (!(shapes as readonly unknown[]).includes(shape) && shape !== undefined) {
      throw invalidOption('shape', shapes.map((name) => `'${name}'`).join(' or '), shape);
    }
    if (!Number.isFinite(tolerance) || (tolerance as number) < 0) throw invalidOption('tolerance', 'a number of pixels from 0', tolerance);
    for (const name of Object.keys(texts ?? {})) {
      const value = (whole as Record<string, unknown>)[name];
      if (typeof value !== 'string') throw invalidOption(name, 'text', value);
    }
    return whole as { shape: Shape; tolerance: number } & Texts & Partial<Record<More, unknown>>;
  });
}

/** Where there is one. */
export function isText(value: unknown): value is string | undefined {
  return value === undefined || typeof value === 'string';
}

function isName(value: unknown): value is string {
  return typeof value === 'string';
}

function isLabel(value: unknown): value is number {
  return isWhole(value, 0, UNLABELLED);
}

export function isMotion(value: unknown): value is FormatMotion {
  if (!isObject(value)) return false;
  const { label, matrix, bbox, pixels = 0, share = 0, residual = 0, group = 0 } = value;
  const box = bbox === undefined || (isListOf(bbox, isFinite) && bbox.length === 4);
  return isLabel(label) && isListOf(matrix, isFinite) && matrix.length === 6 && box && [pixels, share, residual, group].every(isFinite);
}

/** A motion whose lists are its own. */
export function copied(motion: FormatMotion): FormatMotion {
  const { matrix, bbox } = motion;
  return { ...motion, matrix: [...matrix], ...(bbox && { bbox: [...bbox] }) };
}

export function isFinite(value: unknown): value is number {
  return Number.isFinite(value);
}

type Box = [left: number, top: number, right: number, bottom: number];

/** By label: the first and last column and row, inclusive. */
function boxesOf(labels: Uint8Array, width: number): (Box | undefined)[] {
  const boxes: (Box | undefined)[] = Array.from({ length: 256 });
  for (let start = 0, y = 0; start < labels.length; start += width, y++) {
    for (let x = 0; x < width; x++) {
      const label = labels[start + x] as number;
      const box = boxes[label];
      if (box === undefined) {
        boxes[label] = [x, y, x, y];
        continue;
      }
      if (x < box[0]) box[0] = x;
      if (x > box[2]) box[2] = x;
      box[3] = y;
    }
  }
  return boxes;
}

function crop(labels: Uint8Array, stride: number, label: number, [left, top, right, bottom]: Box) {
  const width = right - left + 1;
  const height = bottom - top + 1;
  const pixels = new Uint8Array(width * height);
  let area = 0;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (labels[(top + y) * stride + left + x] !== label) continue;
      pixels[y * width + x] = 1;
      area++;
    }
  }
  return { label, left, top, width, height, area, pixels };
}
