//! The sample pairs that come with the page. Their sources are named in the footer of `index.html`.

export interface Sample {
  readonly id: string;
  readonly title: string;
  /** Paths relative to the page. */
  readonly first: string;
  readonly second: string;
  readonly thumbnail: string;
}

function sample(id: string, title: string): Sample {
  return { id, title, first: `samples/${id}/first.png`, second: `samples/${id}/second.png`, thumbnail: `samples/${id}/thumbnail.jpg` };
}

/** The page opens with the first. */
export const SAMPLES: readonly [Sample, ...Sample[]] = [
  sample('intel-two-cars', 'Two cars'),
  sample('leader-follower', 'Leader and follower'),
  sample('parallax', 'Parallax'),
];

/** The sample with this id. */
export function sampleCalled(id: string | null): Sample | null {
  return SAMPLES.find((sample) => sample.id === id) ?? null;
}
