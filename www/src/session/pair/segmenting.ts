//! Segmenting the pair on screen with the current settings, first fast and then as well as they ask for: a view of two frames, which takes no
//! corrections. The result and what is running are in the state.

import type { Segmentation } from 'veronese';
import type { Settings } from '../../state/settings.js';
import { FRESH, type Result, type Run, type Store, isPassing } from '../../state/state.js';
import { fail } from '../failures.js';
import type { PairWorker } from './worker.js';

/** The state of a run before its first stage. */
export const STARTING: Run = { phase: 'working', stage: '', index: 0, of: 0 };

export class PairSegmenting {
  readonly #store: Store;
  readonly #worker: PairWorker;

  constructor(store: Store, worker: PairWorker) {
    this.#store = store;
    this.#worker = worker;
  }

  /** Changes settings and segments the pair again. */
  change(settings: Partial<Settings>): void {
    const { settings: before, forced } = this.#store.get();
    this.#store.set({ settings: { ...before, ...settings }, forced: settings.motions === undefined ? forced : null });
    this.#again();
  }

  /** Sets the number of motions for this pair alone. */
  forceMotions(forced: number): void {
    this.#store.set({ forced });
    this.#again();
  }

  /** The masks of a clip stay until it is segmented again. */
  #again(): void {
    const { live, look } = this.#store.get();
    if (live === null && look.kind !== 'objects') void this.segment();
  }

  /** Segments the pair with the current settings; idle if a frame is missing. */
  async segment(): Promise<void> {
    const { pair: { first, second }, settings: { longestSide: _, ...settings }, forced } = this.#store.get();
    this.stop();
    if (first === null || second === null) return this.#store.set({ run: { phase: 'idle' } });
    this.#store.set({ run: STARTING });
    const pair = { first, second };
    const options = { ...settings, motions: forced ?? settings.motions };
    const began = performance.now();
    try {
      // A fast preview of a new pair, shown until the best result is ready.
      if (options.quality === 'best' && this.#store.get().result === null) {
        const preview = await this.#worker.run(pair, { ...options, quality: 'fast' });
        if (preview === null) return;
        this.#show(preview, pair, began);
      }
      const segmentation = await this.#worker.run(pair, options, ({ stage, index, of }) => this.#store.set({ run: { phase: 'working', stage, index, of } }));
      if (segmentation === null) return;
      this.#show(segmentation, pair, began);
      this.#store.set({ run: { phase: 'done', cause: 'found' } });
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
    this.stop();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  /** Stops what others take the place of. */
  stop(): void {
    this.#worker.cancel();
  }

  /** Another number of motions numbers them anew. */
  #show(segmentation: Segmentation, pair: Result['pair'], began: number): void {
    const { result, look } = this.#store.get();
    const { hidden, solo, stabilised, selected } = FRESH;
    const anew = result !== null && result.segmentation.count !== segmentation.count;
    this.#store.set({
      result: { segmentation, pair, waited: performance.now() - began },
      look: anew ? { ...look, hidden, solo, stabilised, selected } : look,
    });
  }
}
