//! The samples that come with the page: pairs and a clip. Their sources are named in the footer of `index.html`.

/** Small pictures side by side in one file, shown one after another; the first also where nothing should move. */
export interface MovingPicture {
  /** A path relative to the page, like those of the frames. */
  readonly path: string;
  readonly count: number;
  /** How long one is shown, seconds. */
  readonly each: number;
}

interface Common {
  readonly id: string;
  readonly title: string;
  readonly thumbnail: MovingPicture;
}

export interface SamplePair extends Common {
  readonly first: string;
  readonly second: string;
}

export interface SampleClip extends Common {
  readonly frames: readonly string[];
  /** The frame that is shown first. */
  readonly start: number;
}

export type Sample = SamplePair | SampleClip;

function common(id: string, title: string, count: number, each: number): Common {
  return { id, title, thumbnail: { path: `samples/${id}/thumbnail.webp`, count, each } };
}

function pair(id: string, title: string): SamplePair {
  return { ...common(id, title, 2, 0.5), first: `samples/${id}/first.png`, second: `samples/${id}/second.png` };
}

function clip(id: string, title: string, count: number, start: number): SampleClip {
  const frames = Array.from({ length: count }, (_, k) => `samples/${id}/frames/${String(k).padStart(2, '0')}.webp`);
  return { ...common(id, title, 14, 0.14), frames, start };
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
