//! Segmenting the pair on screen with the current settings, first fast and then as well as they ask for. The result and what is running
//! are in the state.

import type { Settings } from '../../state/settings.js';
import { type Run, type Store, isCurrent, isPassing, isPending } from '../../state/state.js';
import { fail } from '../failures.js';
import type { Solving } from './solving.js';
import type { PairWorker } from './worker.js';

/** The state of a run before its first stage. */
export const STARTING: Run = { phase: 'working', work: 'segmenting', stage: '', index: 0, of: 0 };

export class PairSegmenting {
  readonly #store: Store;
  readonly #worker: PairWorker;
  readonly #solving: Solving;

  constructor(store: Store, worker: PairWorker, solving: Solving) {
    this.#store = store;
    this.#worker = worker;
    this.#solving = solving;
  }

  /** Changes settings and segments the pair again. */
  change(settings: Partial<Settings>): void {
    const { settings: before, motionsElsewhere } = this.#store.get();
    this.#store.set({ settings: { ...before, ...settings }, motionsElsewhere: settings.motions === undefined ? motionsElsewhere : null });
    // The masks of a clip stay until it is segmented again.
    const { live, look } = this.#store.get();
    if (live === null && look.kind !== 'objects') void this.segment();
  }

  /** Sets the number of motions for this pair alone. */
  forceMotions(motions: number): void {
    const { settings, motionsElsewhere } = this.#store.get();
    this.change({ motions });
    this.#store.set({ motionsElsewhere: motionsElsewhere ?? settings.motions });
  }

  /** Segments the pair with the current settings; idle if a frame is missing. */
  async segment(): Promise<void> {
    const { pair, settings } = this.#store.get();
    const { first, second } = pair;
    this.#solving.stop();
    if (first === null || second === null) return this.#store.set({ run: { phase: 'idle' } });
    this.#store.set({ run: STARTING });
    const began = performance.now();
    try {
      // A fast preview of a new pair, shown until the best result is ready.
      if (settings.quality === 'best' && this.#store.get().result === null) {
        const preview = await this.#worker.run({ first, second }, { ...settings, quality: 'fast' });
        if (preview === null) return;
        await this.#solving.accept(preview, { first, second }, began, false);
      }
      const segmentation = await this.#worker.run({ first, second }, settings, ({ stage, index, of }) =>
        this.#store.set({ run: { phase: 'working', work: 'segmenting', stage, index, of } }),
      );
      if (segmentation !== null) await this.#solving.accept(segmentation, { first, second }, began, true);
    } catch (error) {
      fail(this.#store, error);
    }
  }

  /** Segments the pair at which the clip was left: those that it passed were not. */
  rest(): void {
    const now = this.#store.get();
    if (now.run.phase === 'idle' && !isPassing(now)) void this.segment();
  }

  /** Stops at once; the last result stays. */
  cancel(): void {
    this.#solving.stop();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  /** Resumes what was cancelled. */
  again(): void {
    if (isCurrent(this.#store.get())) this.#solving.settle(isPending(this.#store.get()) ? 'solved' : 'found');
    else void this.segment();
  }
}
