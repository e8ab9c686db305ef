//! What a person says about a clip, and the masks as they are before it has been carried to the other frames.

import type { ClipFrame, ClipOptions, ClipPropagation } from 'veronese';
import { type Runs, packed, unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { becameAfter } from './spans.js';
import type { Notes, Version } from './tracked.js';

/** What points to a new object in a frame: x, y, width and height of a box, or x and y of a click, pixels of the masks. */
export interface Pointed {
  readonly frame: number;
  readonly id: number;
  readonly spread: ClipPropagation;
  readonly at: readonly [number, number] | readonly [number, number, number, number];
}

/** What a person says: pixels of frames, by index, and where they spread; where a new object is, what becomes of whole objects, or what changes no masks. */
export type Said =
  | { readonly pointed: Pointed }
  | ({ readonly painted: ReadonlyMap<number, Uint8Array>; readonly spread: ClipPropagation } & Partial<Noted>)
  | ({ readonly edits: NonNullable<ClipOptions['edits']> } & Partial<Noted>)
  | Noted;

/** What changes no masks: these notes in the place of those before. */
export interface Noted {
  readonly notes: Partial<Notes>;
}

/** What was painted before in a frame, with this over it. */
export function paintedOver(before: Runs | undefined, labels: Uint8Array, size: Pick<Runs, 'width' | 'height'>): Runs {
  const all = before === undefined ? labels : unpacked(before).map((label, p) => (labels[p] === UNLABELLED ? label : labels[p]!));
  return packed(all, size.width, size.height);
}

/** The masks with what is painted in its own frames. The motions and certainties there follow later, and the masks of whole objects. */
export function withSaid<V extends Version>(version: V, said: Said): V {
  // Nothing is seen of it yet; its number is taken.
  if ('pointed' in said) return { ...version, largest: Math.max(version.largest, said.pointed.id) };
  const noted = { ...version, ...said.notes };
  if ('edits' in said) return { ...noted, became: becameAfter(version.became, said.edits) };
  return 'painted' in said ? [...said.painted].reduce((before, [index, labels]) => withPainted(before, index, labels), noted) : noted;
}

function withPainted<V extends Version>(version: V, index: number, said: Uint8Array): V {
  const masks = version.frames[index];
  if (!masks) return version;
  const { width, height } = masks.runs;
  const labels = unpacked(masks.runs);
  const painted = new Set<number>();
  for (let p = 0; p < labels.length; p++) {
    const label = said[p]!;
    if (label === UNLABELLED) continue;
    labels[p] = label;
    painted.add(label);
  }
  const own = new Set(masks.objects.map(({ id }) => id));
  const added = [...painted].filter((id) => id !== 0 && !own.has(id));
  const objects = [...masks.objects, ...added.map((id) => ({ id, pixels: 0, bbox: [0, 0, width, height] as ClipFrame['objects'][number]['bbox'], confidence: 1, matrix: null }))];
  const frames = version.frames.with(index, { ...masks, runs: packed(labels, width, height), objects });
  return { ...version, frames, largest: Math.max(version.largest, ...added) };
}
