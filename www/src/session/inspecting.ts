//! The motions between the frame on screen and the one beside it, while a person inspects them: not of frames that are left at once, and not
//! while the clip is segmented, which needs the processor.

import { type Pixels, Segmenter } from 'veronese';
import { type State, type Store, isPassing } from '../state/state.js';
import { report } from './failures.js';

export class Inspecting {
  readonly #store: Store;
  readonly #segmenter = new Segmenter();
  /** The frames and settings of the request under way, or of the last one. */
  #of: Pick<State, 'pair' | 'settings'> | null = null;
  #request = new AbortController();
  #isOpen = false;

  constructor(store: Store) {
    this.#store = store;
  }

  /** Called at each change of the state: finds what is wanted now, and stops what is not. */
  follow(): void {
    const now = this.#store.get();
    const { pair, settings, inspecting, inspected, look } = now;
    const isSame = inspecting && this.#of?.pair === pair && this.#of.settings === settings;
    if (isSame || (!inspecting && !this.#isOpen && !look.motions)) return;
    this.#of = null;
    this.#request.abort();
    // Its worker is of no more use.
    if (this.#isOpen && !inspecting) this.#segmenter.close();
    this.#isOpen = inspecting;
    // Before the state is set, which leads here again.
    const begins = mayInspect(now);
    if (begins) this.#of = { pair, settings };
    if (!inspecting && look.motions) this.#store.look({ motions: false });
    if (inspected !== null) this.#store.set({ inspected: null });
    if (begins && this.#of?.pair === pair) void this.#find(now);
  }

  async #find({ pair: { first, second }, settings: { longestSide: _, ...options } }: State): Promise<void> {
    if (first === null || second === null) return;
    const { signal } = (this.#request = new AbortController());
    const began = performance.now();
    const show = (segmentation: NonNullable<State['inspected']>['segmentation']): void => {
      if (!signal.aborted) this.#store.set({ inspected: { first, second, segmentation, waited: performance.now() - began } });
    };
    try {
      show(await this.#segmenter.segmentPair(pixelsOf(first), pixelsOf(second), { ...options, signal }));
    } catch (error) {
      if (signal.aborted) return;
      show(null);
      report(this.#store, error);
    }
  }
}

/** Whether the motions of the frame on screen can be found now. */
export function mayInspect(state: State): boolean {
  const { inspecting, pair, live, tracked } = state;
  return inspecting && pair.first !== null && pair.second !== null && live === null && !isPassing(state) && tracked?.run.phase !== 'working';
}

/** Only the pixels are copied to the worker. */
function pixelsOf({ data, width, height }: Pixels): Pixels {
  return { data, width, height };
}
