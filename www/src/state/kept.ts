//! The edits of pairs that are not open, kept until they are opened again.

import type { Segmentation } from 'veronese';
import { type Edits, hasEdits, isUnsaved } from '../correction/edits.js';
import { labellingOf } from '../correction/parts.js';
import { type Packed, packedResult } from '../correction/solutions.js';
import { type FramePair, type Subject, keyOfPair, subjectOf } from './pair.js';
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
  /** The clip that the pair is part of, or the pair itself. */
  readonly subject: Subject;
}

/** The parts of the state that an open pair has. */
interface Open {
  readonly pair: FramePair;
  readonly edits: Edits;
  readonly found: Segmentation | null;
  readonly result: { readonly waited: number } | null;
  readonly settings: Settings;
  readonly motionsElsewhere: Settings['motions'] | null;
}

/** The edits of the open pair under its key; `null` if there are none. */
export function keptFrom({ pair, edits, found, result, settings, motionsElsewhere }: Open): readonly [string, Kept] | null {
  const [key, subject] = [keyOfPair(pair), subjectOf(pair)];
  const ownMotions = motionsElsewhere === null ? null : settings.motions;
  if (key === null || subject === null || pair.first === null || (!hasEdits(edits) && ownMotions === null)) return null;
  const packed = found === null ? null : { packed: packedResult(found, labellingOf(found)), waited: result?.waited ?? 0 };
  const { width, height } = pair.first;
  return [key, { edits, ownMotions, width, height, found: packed, subject }];
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
