//! What was done to pairs of frames that are not open now, until they come again.

import { type Edits, isUnsaved } from '../correction/edits.js';
import type { Packed } from '../correction/solutions.js';
import type { Settings } from './settings.js';

/** A few ten kilobytes for a pair, some hundred for the largest: as much as people make by hand is never too much. */
export interface Kept {
  readonly edits: Edits;
  /** As it was found and how long that took; null where it was not found again before the pair was left. */
  readonly found: { readonly packed: Packed; readonly waited: number } | null;
  /** The number of motions insisted on for this pair. */
  readonly ownMotions: Settings['motions'] | null;
  /** Size of the first frame. */
  readonly width: number;
  readonly height: number;
}

/** Whether something would be lost with the page. */
export function hasUnsaved({ edits, kept }: { readonly edits: Edits; readonly kept: ReadonlyMap<string, Kept> }): boolean {
  return isUnsaved(edits) || [...kept.values()].some((pair) => isUnsaved(pair.edits));
}
