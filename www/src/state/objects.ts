//! The masks of a clip's frames in the form of a pair's result, so that the same views draw them.

import type { ClipFrame, Segmentation } from 'veronese';
import { unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import type { FramePair, LoadedFrame } from './pair.js';
import type { Result } from './state.js';
import { type Tracked, type TrackedFrame, shownFrames } from './tracked.js';

/** The masks of both frames of a pair; `null` if there are none of the first. */
export function resultOf(tracked: Tracked | null, { first, second }: FramePair): Result | null {
  if (tracked === null || first === null || second === null) return null;
  const [found, other] = [frameOf(tracked, first), frameOf(tracked, second)];
  if (found === null) return null;
  return { segmentation: segmentationOf(found), pair: { first, second }, second: other && segmentationOf(other), waited: 0 };
}

/** The masks of the clip in a frame that is open. */
export function frameOf(tracked: Tracked, { origin }: LoadedFrame): TrackedFrame | null {
  return origin?.clip === tracked.clip ? (shownFrames(tracked)[origin.index] ?? null) : null;
}

/** The matrix of what has no motion that is known. */
const STILL: Segmentation['motions'][number]['matrix'] = [0, 0, 0, 0, 0, 0];

export function segmentationOf({ runs, ...frame }: TrackedFrame): Segmentation {
  return segmentationFrom({ ...frame, labels: unpacked(runs) }, runs);
}

/** A motion for the background and for each object. Their labels are numbers of objects, with gaps. */
export function segmentationFrom(
  { labels, objects, background }: Pick<ClipFrame, 'labels' | 'objects' | 'background'>,
  { width, height }: { readonly width: number; readonly height: number },
): Segmentation {
  const total = labels.length;
  const unlabelled = labels.reduce((sum, label) => (label === UNLABELLED ? sum + 1 : sum), 0);
  const rest = objects.reduce((left, { pixels }) => left - pixels, total - unlabelled);
  const motions = [{ id: 0, pixels: rest, bbox: [0, 0, width, height] as [number, number, number, number], matrix: background }, ...objects].map(
    ({ id, pixels, bbox, matrix }) => ({ label: id, group: id, pixels, share: pixels / total, bbox, matrix: matrix ?? STILL, residual: 0 }),
  );
  return {
    version: 1,
    width,
    height,
    count: motions.length,
    motions,
    junctions: [],
    evidence: { candidates: [] },
    unlabelled,
    milliseconds: { total: 0 },
    settings: { motions: 'auto', quality: 'best', subject: false, markUnknown: false, software: '' },
    labels,
  };
}
