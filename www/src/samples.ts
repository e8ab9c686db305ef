//! The pairs that come with the page. Who made them stands in the footer of `index.html`.

import type { FramePair } from './state.js';

export interface Sample {
  readonly id: string;
  readonly title: string;
  /** Paths beside the page. */
  readonly first: string;
  readonly second: string;
}

function sample(id: string, title: string): Sample {
  return { id, title, first: `samples/${id}/first.png`, second: `samples/${id}/second.png` };
}

/** The first is shown when the page opens. */
export const SAMPLES: readonly [Sample, ...Sample[]] = [
  sample('intel-two-cars', 'Two cars'),
  sample('leader-follower', 'Leader and follower'),
  sample('parallax', 'Parallax'),
];

/** The sample with this id. */
export function sampleCalled(id: string | null): Sample | null {
  return SAMPLES.find((sample) => sample.id === id) ?? null;
}

/** The sample that a pair is; `null` where a frame of it is something else. */
export function sampleOf({ first, second }: FramePair): { readonly sample: Sample; readonly swapped: boolean } | null {
  const [a, b] = [first?.origin, second?.origin];
  if (!a || !b || !('sample' in a && 'sample' in b) || a.sample !== b.sample || a.slot === b.slot) return null;
  return { sample: a.sample, swapped: a.slot === 'second' };
}
