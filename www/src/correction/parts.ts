//! What a person means by a mask: labels of the result that was seen. Another run of the same frames may number its motions
//! otherwise; a part is found again there by the pixels it covers.

import type { Segmentation } from 'veronese';
import { type Runs, continued, packed } from './runs.js';

/** Labels, one bit each, of the labelling that they were chosen in. */
export interface Part {
  readonly of: Runs;
  readonly labels: number;
}

const labellings = new WeakMap<Segmentation, Runs>();

/** The labels of a result as it was found, packed once. */
export function labellingOf(found: Segmentation): Runs {
  const known = labellings.get(found);
  if (known !== undefined) return known;
  const runs = packed(found.labels, found.width, found.height);
  labellings.set(found, runs);
  return runs;
}

/** A result that was remembered: its labelling stays the one that parts refer to. */
export function withLabelling(found: Segmentation, runs: Runs): Segmentation {
  labellings.set(found, runs);
  return found;
}

const continuations = new WeakMap<Runs, WeakMap<Runs, ReadonlyMap<number, number>>>();

/** {@link continued}, worked out once. */
export function continuation(before: Runs, now: Runs): ReadonlyMap<number, number> {
  const known = continuations.get(before) ?? new WeakMap<Runs, ReadonlyMap<number, number>>();
  continuations.set(before, known);
  const labels = known.get(now) ?? continued(before, now);
  known.set(now, labels);
  return labels;
}

/** The labels of `now` that the part's labels go on in, one bit each; 0 where they are gone. */
export function labelsIn({ of, labels }: Part, now: Runs): number {
  if (of === now) return labels;
  let set = 0;
  for (const [is, was] of continuation(of, now)) if ((labels >> was) & 1) set |= 1 << is;
  return set;
}
