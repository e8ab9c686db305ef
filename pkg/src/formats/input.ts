// What every encoder reads: a label image and what is known about its masks. Checked once, here.

import type { FormatMeta, FormatMotion, LabelFrame } from '../../types/formats.js';
import { VeroneseError } from '../errors.js';

export const UNLABELLED = 255;

/** Largest side, pixels: what the core segments. Also keeps every run length below 2^31. */
const LARGEST = 4096;

/** One label's pixels inside their bounding box. */
export interface Mask {
  label: number;
  name: string;
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
  const wanted = meta.labels && new Set(meta.labels);
  const boxes = boxesOf(labels, width);
  const masks: Mask[] = [];
  for (const [label, box] of boxes.entries()) {
    if (box === undefined || label === UNLABELLED || wanted?.has(label) === false) continue;
    const motion = meta.motions?.find((motion) => motion.label === label);
    masks.push({ ...crop(labels, width, label, box), name: nameOf(label, meta), ...(motion && { motion }) });
  }
  return masks;
}

export function nameOf(label: number, { names }: Pick<FormatMeta, 'names'>): string {
  return names?.[label] ?? `motion-${label}`;
}

/** The name of the first frame's file. */
export function imageOf({ image }: Pick<FormatMeta, 'image'>): string {
  return image ?? 'first.png';
}

/** Throws `invalid-input` unless there are frames, all of one size. */
export function checkFrames(frames: readonly LabelFrame[]): { width: number; height: number } {
  const [first] = frames;
  if (!first) throw new VeroneseError('invalid-input', 'there must be one frame at least');
  for (const { labels, width, height } of frames) {
    checkLabels(labels, width, height);
    if (width === first.width && height === first.height) continue;
    throw new VeroneseError('frame-size-mismatch', 'the frames must have one size');
  }
  return { width: first.width, height: first.height };
}

export function checkLabels(labels: Uint8Array, width: number, height: number): void {
  const side = (value: number) => Number.isInteger(value) && value >= 1 && value <= LARGEST;
  if (!side(width) || !side(height)) {
    throw new VeroneseError('invalid-input', `width and height must be whole numbers from 1 to ${LARGEST}`);
  }
  if (!(labels instanceof Uint8Array) || labels.length !== width * height) {
    throw new VeroneseError('invalid-input', `the labels must be a Uint8Array of ${width} × ${height} entries`);
  }
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
