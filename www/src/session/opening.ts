//! Opens one thing at a time: what is on screen stays, and work on it continues, until its replacement is there. The last request wins, and
//! earlier ones are discarded. It owns the request under way.

import { timelineOf } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { report } from './failures.js';

export class Opening {
  readonly #store: Store;
  #current = new AbortController();

  constructor(store: Store) {
    this.#store = store;
  }

  /**
   * `load` gives up when its signal is aborted. Then, or if nobody waits any more, `discard` has what it loaded; otherwise `take`
   * replaces what is on screen.
   */
  async open<T>(load: (signal: AbortSignal) => Promise<T>, take: (opened: T) => void, discard: (opened: T) => void = () => undefined): Promise<void> {
    const signal = this.giveUp();
    this.#store.set({ opening: true, notice: null });
    try {
      const opened = await load(signal);
      if (signal.aborted) return discard(opened);
      this.#current = new AbortController();
      this.#store.set({ opening: false });
      take(opened);
    } catch (error) {
      if (signal.aborted) return;
      this.stop();
      report(this.#store, error);
    }
  }

  /** Stops opening: the timeline returns to the frames on screen. */
  stop(): void {
    this.giveUp();
    this.#store.set({ opening: false, timeline: timelineOf(this.#store.get().pair) });
  }

  /** Gives up whatever is being opened. Returns the signal of what is opened next. */
  giveUp(): AbortSignal {
    this.#current.abort();
    return (this.#current = new AbortController()).signal;
  }
}
