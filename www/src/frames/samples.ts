//! The samples that come with the page: clips, two of them of two frames. Their sources are named in the footer of `index.html`.

/** Small pictures side by side in one file, shown one after another; the first also where nothing should move. */
export interface MovingPicture {
  /** A path relative to the page, like those of the frames. */
  readonly path: string;
  readonly count: number;
  /** How long one is shown, seconds. */
  readonly each: number;
}

export interface Sample {
  readonly id: string;
  readonly title: string;
  readonly thumbnail: MovingPicture;
  readonly frames: readonly string[];
  /** The frame that is shown first. */
  readonly start: number;
}

function pair(id: string, title: string): Sample {
  const frames = ['first', 'second'].map((name) => `samples/${id}/${name}.png`);
  return { id, title, thumbnail: { path: `samples/${id}/thumbnail.webp`, count: 2, each: 0.5 }, frames, start: 0 };
}

function clip(id: string, title: string, count: number, start: number): Sample {
  const frames = Array.from({ length: count }, (_, k) => `samples/${id}/frames/${String(k).padStart(2, '0')}.webp`);
  return { id, title, thumbnail: { path: `samples/${id}/thumbnail.webp`, count: 14, each: 0.14 }, frames, start };
}

/** The page opens with the first. */
export const SAMPLES: readonly [Sample, ...Sample[]] = [
  // Both cars are whole in frame 32.
  clip('passing-cars', 'Passing cars', 51, 32),
  pair('intel-two-cars', 'Two cars'),
  pair('parallax', 'Parallax'),
];

/** The sample with this id. */
export function sampleCalled(id: string | null): Sample | null {
  return SAMPLES.find((sample) => sample.id === id) ?? null;
}
