//! The objects of a whole clip: how far their segmentation is, and the masks of each frame.

import type { ClipFrame, ClipProgress } from 'veronese';
import type { Clip } from '../clips/clip.js';
import type { Runs } from '../correction/runs.js';
import type { Colour } from '../drawing/palette.js';

/** One frame of a clip, segmented. */
export interface TrackedFrame extends Pick<ClipFrame, 'objects' | 'background'> {
  /** Its labels: 0 is the background, 255 unlabelled, another number an object. */
  readonly runs: Runs;
}

/** What is done with the clip as a whole. */
export type ClipRun =
  | { readonly phase: 'idle' | 'cancelled' | 'failed' | 'done' }
  | {
      readonly phase: 'working';
      readonly stage: ClipProgress['stage'];
      /** Time left until all masks are there, seconds; `null` until it can be told. */
      readonly left: number | null;
    };

export interface Tracked {
  readonly clip: Clip;
  readonly run: ClipRun;
  /** Number of frames whose pairs are solved, nearly all the work. They are kept when a run is cancelled. */
  readonly solved: number;
  /** By index; `null` for frames without masks. */
  readonly frames: readonly (TrackedFrame | null)[];
  /** Names and colours that the user gave to objects, by `keyOf`. */
  readonly names: Readonly<Record<string, string>>;
  readonly colours: Readonly<Record<string, Colour>>;
}

export function untracked(clip: Clip): Tracked {
  return { clip, run: { phase: 'idle' }, solved: 0, frames: Array.from({ length: clip.count }, () => null), names: {}, colours: {} };
}

/** One object through a clip. */
export interface Life {
  readonly id: number;
  /** Indices of the first and the last frame that show it. */
  readonly first: number;
  readonly last: number;
  /** The frame that shows it with the lowest confidence, and that confidence, 0 to 1. */
  readonly doubtful: { readonly index: number; readonly confidence: number };
}

/** All objects of a clip by number. */
export function livesOf({ frames }: Pick<Tracked, 'frames'>): Life[] {
  const lives = new Map<number, Life>();
  frames.forEach((frame, index) => {
    for (const { id, confidence } of frame?.objects ?? []) {
      const { first = index, doubtful } = lives.get(id) ?? {};
      const least = doubtful === undefined || confidence < doubtful.confidence ? { index, confidence } : doubtful;
      lives.set(id, { id, first, last: index, doubtful: least });
    }
  });
  return [...lives.values()].sort((one, other) => one.id - other.id);
}

/** Whether there are masks of any frame. */
export function isTracked(tracked: Tracked | null): tracked is Tracked {
  return tracked !== null && tracked.frames.some((frame) => frame !== null);
}
