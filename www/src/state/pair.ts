//! The two frames of a pair, and where each comes from.

import type { Clip } from '../clips/clip.js';
import type { DecodedFrame } from '../frames/frame.js';
import type { SamplePair } from '../frames/samples.js';

export type Slot = 'first' | 'second';

/** Where a frame comes from: a clip or a sample pair. */
export type Origin = { readonly clip: Clip; readonly index: number } | { readonly sample: SamplePair; readonly slot: Slot };

/** A frame that is open. `origin` is absent for a file of its own and for the camera. */
export interface LoadedFrame extends DecodedFrame {
  readonly origin?: Origin;
}

/** The two frames; `null` until a frame is opened. */
export type FramePair = Readonly<Record<Slot, LoadedFrame | null>>;

/** Identifies a pair by its content; `null` if a frame is missing. */
export function keyOfPair({ first, second }: FramePair): string | null {
  return first === null || second === null ? null : `${first.fingerprint} ${second.fingerprint}`;
}

/** The subject of work: a clip, or a pair of frames that are of none. */
export interface Subject {
  /** The fingerprint of the clip, or the key of the pair. */
  readonly of: string;
  readonly name: string;
  /** Number of frames. */
  readonly frames: number;
  /** The sample that it is, if it is one. */
  readonly sample?: OfSample;
}

export interface OfSample {
  readonly id: string;
  readonly swapped: boolean;
}

/** The subject of the work on this pair; `null` if a frame is missing. */
export function subjectOf(pair: FramePair): Subject | null {
  const clip = timelineOf(pair)?.clip;
  if (clip !== undefined) return subjectOfClip(clip);
  const of = keyOfPair(pair);
  if (of === null) return null;
  const shown = sampleOf(pair);
  const sample = shown && { sample: { id: shown.sample.id, swapped: shown.swapped } };
  return { of, name: `${pair.first!.name}, ${pair.second!.name}`, frames: 2, ...sample };
}

export function subjectOfClip({ fingerprint, name, count, sample }: Clip): Subject {
  return { of: fingerprint, name, frames: count, ...(sample && { sample: { id: sample.id, swapped: false } }) };
}

/** The sample pair that is shown; `null` if either frame is anything else. */
export function sampleOf({ first, second }: FramePair): { readonly sample: SamplePair; readonly swapped: boolean } | null {
  const [a, b] = [first?.origin, second?.origin];
  if (!a || !b || !('sample' in a && 'sample' in b) || a.sample !== b.sample || a.slot === b.slot) return null;
  return { sample: a.sample, swapped: a.slot === 'second' };
}

/** The open clip and the indices of the two frames in it; `null` for a frame that is not of the clip. */
export interface Timeline {
  readonly clip: Clip;
  readonly first: number | null;
  readonly second: number | null;
}

/** The timeline of a pair; `null` if neither frame is of a clip. */
export function timelineOf({ first, second }: FramePair): Timeline | null {
  const [a, b] = [first, second].map((frame) => (frame?.origin && 'clip' in frame.origin ? frame.origin : null));
  const clip = a?.clip ?? b?.clip;
  return clip === undefined ? null : { clip, first: a?.index ?? null, second: b?.clip === clip ? b.index : null };
}
