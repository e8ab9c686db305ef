//! References to masks that outlive a result. Another segmentation of the same frames may number its motions differently, so a mask is
//! stored as labels of the result in which it was seen, and found again by the pixels that it covers.

import type { Segmentation } from 'veronese';
import { type Runs, continued, packed } from './runs.js';

/** Labels, one bit each, and the labelling they belong to. */
export interface Part {
  readonly of: Runs;
  readonly labels: number;
}

const labellings = new WeakMap<Segmentation, Runs>();

/** The labelling of a result before corrections, packed once. */
export function labellingOf(found: Segmentation): Runs {
  const known = labellings.get(found);
  if (known !== undefined) return known;
  const runs = packed(found.labels, found.width, found.height);
  labellings.set(found, runs);
  return runs;
}

/** Gives a restored result the labelling that parts already refer to. */
export function withLabelling(found: Segmentation, runs: Runs): Segmentation {
  labellings.set(found, runs);
  return found;
}

const continuations = new WeakMap<Runs, WeakMap<Runs, ReadonlyMap<number, number>>>();

/** {@link continued}, computed once. */
export function continuation(before: Runs, now: Runs): ReadonlyMap<number, number> {
  const known = continuations.get(before) ?? new WeakMap<Runs, ReadonlyMap<number, number>>();
  continuations.set(before, known);
  const labels = known.get(now) ?? continued(before, now);
  known.set(now, labels);
  return labels;
}

/** The labels of `now` that correspond to the part, one bit each; 0 if there are none. */
export function labelsIn({ of, labels }: Part, now: Runs): number {
  if (of === now) return labels;
  let set = 0;
  for (const [is, was] of continuation(of, now)) if ((labels >> was) & 1) set |= 1 << is;
  return set;
}
