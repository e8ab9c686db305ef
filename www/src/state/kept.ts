//! The edits of pairs that are not open, kept until they are opened again.

import { type Edits, isUnsaved } from '../correction/edits.js';
import type { Packed } from '../correction/solutions.js';
import type { Settings } from './settings.js';

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

/** Whether closing the page would lose edits. */
export function hasUnsaved({ edits, kept }: { readonly edits: Edits; readonly kept: ReadonlyMap<string, Kept> }): boolean {
  return isUnsaved(edits) || [...kept.values()].some((pair) => isUnsaved(pair.edits));
}
