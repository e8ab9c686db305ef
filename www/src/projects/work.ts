//! What projects and the clip that is open know of each other.

import type { ClipJournal } from 'veronese';
import type { Masks, Range, Tracked } from '../state/tracked.js';

/** A clip that is open, with the work on it. */
export interface Work {
  readonly clip: Tracked['clip'];
  /** The masks as they are known, and the revision that each is of. */
  readonly masks: KnownMasks;
  /** Number of steps up to the first masks. */
  readonly found: number;
  /** The clip as bytes. */
  save(): Promise<Uint8Array>;
}

/** Masks that are known already, and the revision that they are of. */
export interface KnownMasks {
  readonly frames: Masks;
  readonly revisions: readonly number[];
}

/** What is remembered of a clip, beside its journal. */
export interface Remembered {
  readonly known?: KnownMasks | null;
  /** Number of steps up to the first masks. */
  readonly found?: number;
  /** A clip that was saved, which it takes over. */
  readonly restored?: Uint8Array;
  /** The frame that is shown first: its masks are there when the clip is open. */
  readonly at?: number;
  /** The frames that are segmented. */
  readonly range?: Range;
  /** Whether pixels that nothing explains are left unlabelled. */
  readonly markUnknown?: boolean | undefined;
}

/** Where the clip is kept. */
export interface Keeper {
  readonly journal: ClipJournal;
  /** Called when something is said, and when it has taken effect or not. */
  said(): void;
  settled(): void;
}
