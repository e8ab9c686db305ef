//! An annotation of an object in a frame: pixels, or clicks and a box that point to it. It is kept as it was given.

import type { ClipPropagation } from '../segmented.js';
import { type Runs, over, packed, unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';

/** Column and row of a pixel of the masks, and whether it is the object's. */
export type Click = readonly [x: number, y: number, sign: 1 | -1];
/** First column, first row, width and height, pixels of the masks. */
export type Box = readonly [x: number, y: number, width: number, height: number];

interface OfFrame {
  readonly frame: number;
  readonly object: number;
  /** Where it spreads. */
  readonly propagate: ClipPropagation;
}

/** Pixels: the object's number, 0 where it is not, 255 where that is left open. Of object 0: a label map, with numbers of any objects. */
export interface Painted extends OfFrame {
  readonly labels: Runs;
}

/** Where the object is. */
export interface Prompt extends OfFrame {
  readonly clicks: readonly Click[];
  readonly box: Box | null;
}

export type Annotation = Painted | Prompt;

export function isPrompt(one: Annotation): one is Prompt {
  return 'clicks' in one;
}

/** Whether it may change the masks of a frame. */
export function reaches({ frame, propagate }: Annotation, index: number): boolean {
  return index === frame || propagate === 'both' || propagate === (index < frame ? 'backward' : 'forward');
}

/** Whether it is a label map that names objects. */
export function namesObjects({ labels: { labels } }: Painted): boolean {
  return labels.some((label) => label !== 0 && label !== UNLABELLED);
}

/** The pixels painted of an object in a frame; of 0, the label map. */
export function paintedOf(annotations: readonly Annotation[], frame: number, object: number): Painted | null {
  return annotations.find((one): one is Painted => !isPrompt(one) && one.frame === frame && one.object === object) ?? null;
}

/**
 * All annotations, with this one, in the order in which they were given. A stroke lies over those of the same object before; a label map of
 * objects also over the strokes in its frame but those of objects that are `locked`. A prompt takes the place of the one before.
 */
export function withAnnotation(annotations: readonly Annotation[], now: Annotation, locked: ReadonlySet<number>): readonly Annotation[] {
  const isBefore = (one: Annotation): boolean => one.frame === now.frame && one.object === now.object && isPrompt(one) === isPrompt(now);
  const others = annotations.filter((one) => !isBefore(one));
  if (isPrompt(now)) return [...others, now];
  const before = paintedOf(annotations, now.frame, now.object);
  const all = { ...now, labels: before === null ? now.labels : over(before.labels, now.labels) };
  const isUnder = (one: Annotation): one is Painted => !isPrompt(one) && one.frame === now.frame && !locked.has(one.object);
  const covered = now.object === 0 && namesObjects(now) ? others.map((one) => (isUnder(one) ? without(one, now.labels) : one)) : others;
  return [...covered, all];
}

/** The painted pixels but those that another annotation covers. */
function without(painted: Painted, cover: Runs): Painted {
  const above = unpacked(cover);
  const { width, height } = painted.labels;
  return { ...painted, labels: packed(unpacked(painted.labels).map((label, p) => (above[p] === UNLABELLED ? label : UNLABELLED)), width, height) };
}

/** Whether a prompt points to anything. */
export function points({ clicks, box }: Prompt): boolean {
  return box !== null || clicks.some(([, , sign]) => sign > 0);
}
