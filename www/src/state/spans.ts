//! Parts of a clip that were segmented on their own. The package numbers their objects anew in each run; here an object keeps its
//! number, in other parts and when its frames are segmented again.

import type { ClipOptions } from '../segmented.js';
import { type Runs, overlapsOf, resized } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { exactly } from './exact.js';
import type { Range, Span, TrackedFrame, Version } from './tracked.js';

/** The largest number of an object. */
export const MOST_OBJECTS = 254;

export function contains({ first, last }: Range, index: number): boolean {
  return first <= index && index <= last;
}

/** The span of which a frame's masks are. */
export function spanAt(spans: readonly Span[], index: number): Span | null {
  return spans.findLast(({ range }) => contains(range, index)) ?? null;
}

/** The masks with the numbers here. What is not known yet gets a number above `largest`, or is background if there is none. */
export function fromSpan({ runs, objects, background }: TrackedFrame, numbers: Map<number, number>, largest: number): TrackedFrame {
  const table = Uint8Array.from({ length: 256 }, (_, label) => (label === UNLABELLED ? label : 0));
  for (const { id } of objects) {
    if (!numbers.has(id)) {
      const next = Math.max(largest, ...numbers.values()) + 1;
      numbers.set(id, next <= MOST_OBJECTS ? next : 0);
    }
    table[id] = numbers.get(id)!;
  }
  const named = objects.map((object) => ({ ...object, id: table[object.id]! })).filter(({ id }) => id !== 0);
  named.sort((one, other) => one.id - other.id);
  return { runs: { ...runs, labels: runs.labels.map((label) => table[label]!) }, objects: named, background };
}

/**
 * Which object of a new run is which one here, by the pixels that both cover, the largest share first: objects as they were found, then
 * those that a person made. A frame that had no masks is compared with its neighbour outside.
 */
export function numbersOf(run: readonly TrackedFrame[], { first }: Range, { frames, found }: Version): Map<number, number> {
  const [numbers, used] = [new Map<number, number>(), new Set<number>()];
  const match = (before: readonly (Runs | null | undefined)[]): void => {
    const images = run.flatMap(({ runs }, k): (readonly [Runs, Runs])[] => {
      const index = first + k;
      const own = before[index] ?? (k === 0 ? before[index - 1] : null) ?? (k === run.length - 1 ? before[index + 1] : null) ?? null;
      return own === null ? [] : [[own, runs]];
    });
    for (const { was, is } of overlapsOf(images)) {
      if (was === 0 || is === 0 || numbers.has(is) || used.has(was)) continue;
      numbers.set(is, was);
      used.add(was);
    }
  };
  match(found);
  match(frames.map((frame) => frame?.runs));
  return numbers;
}

/** The fate of objects after one more edit. */
export function becameAfter(
  became: ReadonlyMap<number, number>,
  { merge = [], delete: gone = [] }: NonNullable<ClipOptions['edits']>,
): Map<number, number> {
  const now = new Map(became);
  const become = (id: number, into: number): void => {
    for (const [other, then] of now) if (then === id) now.set(other, into);
    now.set(id, into);
  };
  for (const [into, ...others] of merge) for (const other of others) become(other, into!);
  for (const id of gone) become(id, 0);
  return now;
}

/** Labels drawn in frames, at the size of their masks. */
export function atSize(exact: Version['exact'], frames: Version['frames']): Version['exact'] {
  return new Map([...exact].map(([index, runs]) => [index, resized(runs, frames[index]?.runs ?? runs)]));
}

/** The version with the frames of a new run, by whose numbers they are, and without what is no longer seen of spans before. */
export function withRun(version: Version, run: readonly TrackedFrame[], span: Span, longestSide: number): Version {
  const { first, last } = span.range;
  const numbers = new Map(span.numbers);
  const named = run.map((frame) => fromSpan(frame, numbers, version.largest));
  const frames = version.frames.map((frame, index) => named[index - first] ?? frame);
  const found = version.found.map((runs, index) => named[index - first]?.runs ?? runs);
  const spans = [...version.spans.filter(({ range }) => range.first < first || range.last > last), { ...span, numbers }];
  return exactly({ ...version, frames, found, exact: atSize(version.exact, frames), spans, longestSide, largest: Math.max(version.largest, ...numbers.values()) });
}

