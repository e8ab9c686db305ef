// The folder of a pair: labels.png and result.json, as `pair --out` and `batch --out` leave them.

import { join } from 'node:path';
import type { SegmentedMotion } from '../../types/index.js';
import { groupLabels } from '../calls/labels.js';
import { isListOf, isObject, isWhole, UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { readJson, readLabels } from './label-files.js';
import type { PairSettings, Report } from './pair.js';

/** Most motions of a pair, as in the core. */
const MOST_MOTIONS = 10;

export const RESULT = 'result.json';

/** The files of a pair with masks of these labels, the report last. */
export function filesOfPair(labels: readonly number[], { overlay, confidence }: { overlay: boolean; confidence: boolean }): string[] {
  const masks = [...new Set(labels)].map((label) => `mask-${label}.png`);
  return ['labels.png', ...masks, ...(confidence ? ['confidence.png'] : []), ...(overlay ? ['overlay.png'] : []), RESULT];
}

/** Names of all files that a pair may have: how many masks there are shows in the end. */
export function possibleFiles({ options: { motions, confidence }, overlay }: Pick<PairSettings, 'options' | 'overlay'>): string[] {
  const labels = Array.from({ length: motions === 'auto' ? MOST_MOTIONS : motions }, (_, label) => label);
  return filesOfPair(labels, { overlay, confidence });
}

/** Files that another run on a pair may not make: they would be mistaken for its own. */
export function isImageOfPair(path: string): boolean {
  return /^(mask-\d+|overlay|confidence)\.png$/.test(path);
}

/** A pair's labels, and the motions that they stand for. `grouped`: groups instead of motions, also where labels.png has motions. */
export async function readPair(folder: string, grouped: boolean) {
  const [picture, report] = [join(folder, 'labels.png'), join(folder, RESULT)];
  const { labels, width, height } = await readLabels(picture);
  const result = resultOf(await readJson(report), report);
  if (width !== result.width || height !== result.height) {
    const sizes = `${width}×${height} and ${result.width}×${result.height}`;
    throw new VeroneseError('frame-size-mismatch', `'${picture}' and '${report}' differ in size: ${sizes} pixels`);
  }
  const groups = groupsOf(result.motions);
  const single = belongs(labels, new Map(result.motions.map(({ label, pixels }) => [label, pixels])));
  if (!single && !belongs(labels, new Map(groups.map(({ label, pixels }) => [label, pixels])))) {
    throw new VeroneseError('invalid-input', `'${picture}' and '${report}' are not of the same result`);
  }
  /** Names of the frames' files, where the report has them. */
  const inputs = result.inputs.map(({ name }) => name);
  if (single && !grouped) return { labels, width, height, motions: result.motions, grouped: false, inputs };
  const shown = single ? groupLabels({ labels, motions: result.motions }) : labels;
  return { labels: shown, width, height, motions: groups, grouped: true, inputs };
}

/** The part of result.json that is read. */
export function resultOf(value: unknown, path: string) {
  const whole = (value: unknown): boolean => Number.isSafeInteger(value) && (value as number) >= 0;
  const label = (value: unknown): boolean => isWhole(value, 0, UNLABELLED - 1);
  const numbers = (value: unknown, count: number): boolean =>
    Array.isArray(value) && value.length === count && value.every(Number.isFinite);
  const motion = (m: unknown): m is SegmentedMotion =>
    isObject(m) &&
    label(m['label']) &&
    label(m['group']) &&
    whole(m['pixels']) &&
    numbers([m['share'], m['residual']], 2) &&
    numbers(m['bbox'], 4) &&
    numbers(m['matrix'], 6);
  const input = (file: unknown): file is { name: string } => isObject(file) && typeof file['name'] === 'string';
  if (isObject(value) && whole(value['width']) && whole(value['height']) && isListOf(value['motions'], motion)) {
    const inputs = value['inputs'] ?? [];
    const { width, height, motions } = value as unknown as Report;
    if (isListOf(inputs, input)) return { width, height, motions, inputs };
  }
  throw new VeroneseError('invalid-input', `'${path}' is not a result of 'veronese pair'`);
}

/** Every group as one motion: that of its largest member. */
function groupsOf(motions: readonly SegmentedMotion[]): SegmentedMotion[] {
  const groups = new Map<number, SegmentedMotion>();
  for (const motion of motions) {
    const known = groups.get(motion.group);
    if (!known) groups.set(motion.group, { ...motion, label: motion.group });
    else groups.set(motion.group, joined(known, motion));
  }
  return [...groups.values()].sort((a, b) => a.label - b.label);
}

function joined(a: SegmentedMotion, b: SegmentedMotion): SegmentedMotion {
  const [left, top] = [Math.min(a.bbox[0], b.bbox[0]), Math.min(a.bbox[1], b.bbox[1])];
  const right = Math.max(a.bbox[0] + a.bbox[2], b.bbox[0] + b.bbox[2]);
  const bottom = Math.max(a.bbox[1] + a.bbox[3], b.bbox[1] + b.bbox[3]);
  const pixels = a.pixels + b.pixels;
  const residual = Math.sqrt((a.pixels * a.residual ** 2 + b.pixels * b.residual ** 2) / Math.max(pixels, 1));
  return { ...a, pixels, share: a.share + b.share, residual, bbox: [left, top, right - left, bottom - top] };
}

/** Whether the labels are these, with these numbers of pixels; 255 aside. */
function belongs(labels: Uint8Array, pixels: ReadonlyMap<number, number>): boolean {
  const counts = new Map<number, number>();
  for (const label of labels) if (label !== 255) counts.set(label, (counts.get(label) ?? 0) + 1);
  return (
    [...counts].every(([label, count]) => pixels.get(label) === count) &&
    [...pixels].every(([label, count]) => (counts.get(label) ?? 0) === count)
  );
}
