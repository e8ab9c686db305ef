// The pixels of each label of a frame.

import type { FormatMotion } from '../../types/formats.js';
import { UNLABELLED } from '../common/checks.js';
import { nameOf, type Settings } from './metadata.js';

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

/** The masks of the wanted labels that are there, by label; 255 is never one, and 0 only if it is asked for. */
export function masksOf(
  { labels, width, motions }: { labels: Uint8Array; width: number; motions: readonly FormatMotion[] },
  settings: Settings,
): Mask[] {
  const wanted = settings.labels && new Set(settings.labels);
  const masks: Mask[] = [];
  for (const [label, box] of boxesOf(labels, width).entries()) {
    if (box === undefined || label === UNLABELLED || !(wanted?.has(label) ?? label > 0)) continue;
    const motion = motions.find((motion) => motion.label === label);
    const name = nameOf(label, settings);
    masks.push({ ...crop(labels, width, label, box), name, category: categoryOf(name, label, settings), ...(motion && { motion }) });
  }
  return masks;
}

function categoryOf(name: string, label: number, settings: Settings): number {
  const { classes } = settings;
  const listed = classes.indexOf(name);
  if (listed >= 0) return listed;
  let category = 0;
  while (category < label && nameOf(category, settings) !== name) category++;
  return classes.length + category;
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
