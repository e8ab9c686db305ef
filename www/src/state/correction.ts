//! A person's annotations of a clip, and the masks as they are before these have been carried to the other frames.

import type { ClipOptions, ClipPropagation } from '../segmented.js';
import { over, packed, unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { exactly, overlaid, relabelled } from './exact.js';
import { becameAfter } from './spans.js';
import { type Annotation, isPrompt, withAnnotation } from './annotation.js';
import type { Correction, Version } from './tracked.js';

/** Where an annotation of a frame spreads; or that it is drawn exactly, and changes no other pixel. */
export type Spread = ClipPropagation | 'exact';

/** The labels that change at once where an object is painted in a frame: the number of an object, 0, or 255 where nothing changes. */
export function seenOf(version: Version, frame: number, object: number, labels: Uint8Array): Uint8Array {
  const shown = unpacked(version.frames[frame]!.runs);
  const stays = (label: number, was: number): boolean => version.locked.has(was) || (label === 0 && object !== 0 && was !== object);
  return labels.map((label, p) => (stays(label, shown[p]!) ? UNLABELLED : label));
}

/** The masks with what is painted in its own frames. The motions and certainties there follow later, and the masks of whole objects. */
export function withCorrection<V extends Version>(version: V, correction: Correction): V {
  const noted = { ...version, ...correction.notes };
  if ('edits' in correction) return withEdits(noted, correction.edits);
  if ('drawn' in correction) return [...correction.drawn].reduce((before, [index, labels]) => withLabels(before, index, unpacked(labels), true), noted);
  return 'annotations' in correction ? correction.annotations.reduce(annotated, noted) : noted;
}

function annotated<V extends Version>(version: V, now: Annotation): V {
  const annotations = withAnnotation(version.annotations, now, version.locked);
  // Nothing is seen of a prompt yet; its number is taken.
  if (isPrompt(now)) return { ...version, annotations, largest: Math.max(version.largest, now.object) };
  const masks = version.frames[now.frame];
  return { ...(masks ? withLabels(version, now.frame, seenOf(version, now.frame, now.object, unpacked(now.labels)), false) : version), annotations };
}

function withEdits<V extends Version>(version: V, edits: NonNullable<ClipOptions['edits']>): V {
  const became = becameAfter(version.became, edits);
  const exact = new Map([...version.exact].map(([index, runs]) => [index, { ...runs, labels: runs.labels.map((label) => became.get(label) ?? label) }]));
  // Objects that were drawn exactly are known to the page alone, so they are no part of the package's answer.
  const frames = version.frames.map((frame) => frame && relabelled(frame, became));
  return exactly({ ...version, frames, became, exact });
}

function withLabels<V extends Version>(version: V, index: number, labels: Uint8Array, isExact: boolean): V {
  const masks = version.frames[index];
  if (!masks) return version;
  const { width, height } = masks.runs;
  const frame = overlaid(masks, packed(labels, width, height));
  const frames = version.frames.with(index, frame);
  const largest = Math.max(version.largest, ...frame.objects.map(({ id }) => id));
  const before = version.exact.get(index);
  if (!isExact && before === undefined) return { ...version, frames, largest };
  // A later annotation counts, also where something was drawn exactly.
  const exact = packed(isExact || before === undefined ? labels : unpacked(before).map((label, p) => (label === UNLABELLED ? label : labels[p]!)), width, height);
  return { ...version, frames, largest, exact: new Map(version.exact).set(index, before === undefined ? exact : over(before, exact)) };
}
