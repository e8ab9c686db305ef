//! The frame on screen and the one beside it, which it is compared with: a clip has both. One image waits for another.

import type { Clip } from '../clips/clip.js';
import type { DecodedFrame } from '../frames/frame.js';

export type Slot = 'first' | 'second';

/** A frame that is open. */
export interface LoadedFrame extends DecodedFrame {
  /** Its place in a clip; absent for one image and for the camera. */
  readonly origin?: { readonly clip: Clip; readonly index: number };
}

/** The frame on screen, and the next one, or at the end of a clip the one before; `null` until a frame is opened. */
export type FramePair = Readonly<Record<Slot, LoadedFrame | null>>;

/** The open clip, and the indices of the two frames in it. */
export interface Timeline {
  readonly clip: Clip;
  readonly first: number;
  readonly second: number;
}

/** The timeline of a pair; `null` if it is of no clip. */
export function timelineOf({ first, second }: FramePair): Timeline | null {
  const [a, b] = [first?.origin, second?.origin];
  return a === undefined || b === undefined ? null : { clip: a.clip, first: a.index, second: b.index };
}
