//! The edits of pairs that are not open, kept until they are opened again.

import { type Edits, isUnsaved } from '../correction/edits.js';
import type { Packed } from '../correction/solutions.js';
import type { Settings } from './settings.js';
import { type Tracked, isUnsavedClip } from './tracked.js';

/** Tens of kilobytes for each pair, hundreds for the largest; there is no limit. */
export interface Kept {
  readonly edits: Edits;
  /** The segmentation and how long it took, milliseconds; `null` if the pair was left before it was complete. */
  readonly found: { readonly packed: Packed; readonly waited: number } | null;
  /** The number of motions set for this pair alone; `null` for the common setting. */
  readonly ownMotions: Settings['motions'] | null;
  /** Size of the first frame. */
  readonly width: number;
  readonly height: number;
}

interface Kinds {
  readonly edits: Edits;
  readonly kept: ReadonlyMap<string, Kept>;
  readonly tracked: Tracked | null;
  readonly keptClips: ReadonlyMap<string, Tracked>;
}

/** Whether closing the page would lose edits. */
export function hasUnsaved({ edits, kept, tracked, keptClips }: Kinds): boolean {
  if (isUnsaved(edits) || [...kept.values()].some((pair) => isUnsaved(pair.edits))) return true;
  return [tracked, ...keptClips.values()].some((clip) => clip !== null && isUnsavedClip(clip));
}
