//! The pairs that come with the page. Who made them stands in the footer of `index.html`.

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
