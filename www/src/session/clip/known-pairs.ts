//! What is known of the pairs of clips, for runs that go on: nearly all the work. It is too large for the state, and no view shows it.

import type { Clip } from '../../clips/clip.js';
import type { Settings } from '../../state/settings.js';
import type { Range, SolvedPairs } from '../../state/tracked.js';

export class KnownPairs {
  /** By the clip's fingerprint. */
  readonly #known = new Map<string, SolvedPairs>();

  /** What is known of a clip, also if its masks are not complete. */
  solvedPairs(fingerprint: string): SolvedPairs | null {
    return this.#known.get(fingerprint) ?? null;
  }

  /** Goes on from these pairs when the clip is segmented. */
  learn(fingerprint: string, pairs: SolvedPairs): void {
    this.#known.set(fingerprint, pairs);
  }

  forget({ fingerprint }: Clip): void {
    this.#known.delete(fingerprint);
  }

  /** What is known for these settings: other settings and another first frame begin anew. */
  of({ fingerprint }: Clip, { first }: Range, settings: Settings): SolvedPairs {
    const key = JSON.stringify([first, settings.motions, settings.quality, settings.longestSide]);
    const before = this.#known.get(fingerprint);
    const known = before?.settings === key ? before : { settings: key, pairs: new Map<number, Blob>() };
    this.#known.set(fingerprint, known);
    return known;
  }
}
