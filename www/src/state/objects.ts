//! The masks of a clip's frames as views draw them.

import { unpacked } from '../result/runs.js';
import type { FrameMasks } from '../result/masks.js';
import type { FramePair, LoadedFrame } from './pair.js';
import type { Result } from './state.js';
import { type Tracked, type TrackedFrame, shownFrames } from './tracked.js';

/** The masks of the frame on screen and of the other one; `null` if there are none of the first. */
export function resultOf(tracked: Tracked | null, { first, second }: FramePair): Result | null {
  if (tracked === null || first === null) return null;
  const found = frameOf(tracked, first);
  const other = second && frameOf(tracked, second);
  return found && { masks: masksFrom(found), frame: first, second: other && masksFrom(other) };
}

/** The masks of the clip in a frame that is open. */
export function frameOf(tracked: Tracked, { origin }: LoadedFrame): TrackedFrame | null {
  return origin?.clip === tracked.clip ? (shownFrames(tracked)[origin.index] ?? null) : null;
}

export function masksFrom({ runs, objects }: Pick<TrackedFrame, 'runs' | 'objects'>): FrameMasks {
  const { width, height, ends, labels } = runs;
  const rest = ends.reduce((sum, end, k) => (labels[k] === 0 ? sum + end - (ends[k - 1] ?? 0) : sum), 0);
  return { labels: unpacked(runs), width, height, rest, objects };
}
