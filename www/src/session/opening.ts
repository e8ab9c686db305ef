//! Opens one thing at a time: what is on screen stays, and work on it continues, until its replacement is there. The last request wins, and
//! earlier ones are discarded. Steps to other frames of what is open never replace it, and give up nothing that is being opened.

import { timelineOf } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { report } from './failures.js';

type Work = 'opening' | 'stepping';

/** A step to another frame is said to be under way when it takes longer, milliseconds. */
const PATIENCE = 150;

export class Opening {
  readonly #store: Store;
  /** The requests under way. */
  readonly #current = new Map<Work, AbortController>();
  #tickets = 0;
  #newest = 0;

  constructor(store: Store) {
    this.#store = store;
  }

  get isUnderWay(): boolean {
    return this.#current.size > 0;
  }

  /** The place in the order of requests of one that is made now, but is not known to open something yet. */
  ticket(): number {
    return (this.#tickets += 1);
  }

  /**
   * `load` gives up when its signal is aborted. Then, or if nobody waits any more, `discard` has what it loaded; otherwise `take`
   * replaces what is on screen. `as`: the ticket of the request, which loads nothing if a later one has begun; or a step.
   */
  async open<T>(load: (signal: AbortSignal) => Promise<T>, take: (opened: T) => void, discard: (opened: T) => void = () => undefined, as: number | 'step' = this.ticket()): Promise<void> {
    const work = as === 'step' ? 'stepping' : 'opening';
    if (as !== 'step') {
      if (as < this.#newest) return;
      this.#newest = as;
    }
    this.#giveUp(work);
    const own = new AbortController();
    this.#current.set(work, own);
    if (as !== 'step') this.#store.set({ opening: true, notice: null });
    const slow = setTimeout(() => !own.signal.aborted && this.#store.set({ opening: true }), PATIENCE);
    try {
      const opened = await load(own.signal);
      if (own.signal.aborted) return discard(opened);
      this.#current.delete(work);
      if (work === 'opening') this.giveUp();
      else this.#store.set({ opening: this.#current.size > 0 });
      take(opened);
    } catch (error) {
      if (own.signal.aborted) return;
      this.#current.delete(work);
      this.#ended();
      report(this.#store, error);
    } finally {
      clearTimeout(slow);
    }
  }

  /** Stops what is being opened, and steps: the timeline returns to the frames on screen. */
  stop(): void {
    this.giveUp();
    this.#ended();
  }

  /** Stops a step alone. */
  stay(): void {
    if (this.#giveUp('stepping')) this.#ended();
  }

  /** Gives up whatever is under way, for what is on screen from now on. */
  giveUp(): void {
    for (const work of this.#current.keys()) this.#giveUp(work);
    this.#store.set({ opening: false });
  }

  #giveUp(work: Work): boolean {
    this.#current.get(work)?.abort();
    return this.#current.delete(work);
  }

  /** The timeline is where the frames on screen are, unless a step is under way. */
  #ended(): void {
    const { pair, timeline } = this.#store.get();
    this.#store.set({ opening: this.#current.size > 0, timeline: this.#current.has('stepping') ? timeline : timelineOf(pair) });
  }
}
