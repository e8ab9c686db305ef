//! What a person says about a clip, and the masks as they are before it has been carried to the other frames.

import type { ClipOptions, ClipPropagation } from 'veronese';
import { type Runs, over, packed, unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { exactly, overlaid, relabelled } from './exact.js';
import { becameAfter } from './spans.js';
import type { Notes, Version } from './tracked.js';

/** Where what is said of a frame spreads; or that it is drawn exactly, and changes no other pixel. */
export type Spread = ClipPropagation | 'exact';

/** What points to a new object in a frame: x, y, width and height of a box, or x and y of a click, pixels of the masks. */
export interface Pointed {
  readonly frame: number;
  readonly id: number;
  readonly spread: Spread;
  readonly at: readonly [number, number] | readonly [number, number, number, number];
}

/** What a person says: pixels of frames, by index, and where they spread; where a new object is, what becomes of whole objects, or what changes no masks. */
export type Said =
  | { readonly pointed: Pointed }
  | ({ readonly painted: ReadonlyMap<number, Uint8Array>; readonly spread: ClipPropagation } & Partial<Noted>)
  | ({ readonly edits: NonNullable<ClipOptions['edits']> } & Partial<Noted>)
  | Drawn
  | Noted;

/** What changes no masks: these notes in the place of those before. */
export interface Noted {
  readonly notes: Partial<Notes>;
}

/** What is drawn exactly in frames, by index. */
export type Drawn = { readonly painted: ReadonlyMap<number, Uint8Array>; readonly spread: 'exact' } & Partial<Noted>;

/** What was painted before in a frame, with this over it. */
export function paintedOver(before: Runs | undefined, labels: Uint8Array, size: Pick<Runs, 'width' | 'height'>): Runs {
  const said = packed(labels, size.width, size.height);
  return before === undefined ? said : over(before, said);
}

/** The masks with what is painted in its own frames. The motions and certainties there follow later, and the masks of whole objects. */
export function withSaid<V extends Version>(version: V, said: Said): V {
  // Nothing is seen of it yet; its number is taken.
  if ('pointed' in said) return { ...version, largest: Math.max(version.largest, said.pointed.id) };
  const noted = { ...version, ...said.notes };
  if ('edits' in said) return withEdits(noted, said.edits);
  if (!('painted' in said)) return noted;
  return [...said.painted].reduce((before, [index, labels]) => withPainted(before, index, labels, said.spread === 'exact'), noted);
}

function withEdits<V extends Version>(version: V, edits: NonNullable<ClipOptions['edits']>): V {
  const became = becameAfter(version.became, edits);
  const exact = new Map([...version.exact].map(([index, runs]) => [index, { ...runs, labels: runs.labels.map((label) => became.get(label) ?? label) }]));
  // What nobody but the page knows of, as it was drawn exactly, is no part of the package's answer.
  const frames = version.frames.map((frame) => frame && relabelled(frame, became));
  return exactly({ ...version, frames, became, exact });
}

function withPainted<V extends Version>(version: V, index: number, labels: Uint8Array, isExact: boolean): V {
  const masks = version.frames[index];
  if (!masks) return version;
  const frame = overlaid(masks, packed(labels, masks.runs.width, masks.runs.height));
  const frames = version.frames.with(index, frame);
  const largest = Math.max(version.largest, ...frame.objects.map(({ id }) => id));
  const before = version.exact.get(index);
  if (!isExact && before === undefined) return { ...version, frames, largest };
  // What a person says later counts, also where something was drawn exactly.
  const said = isExact || before === undefined ? labels : unpacked(before).map((label, p) => (label === UNLABELLED ? label : labels[p]!));
  return { ...version, frames, largest, exact: new Map(version.exact).set(index, paintedOver(before, said, masks.runs)) };
}
