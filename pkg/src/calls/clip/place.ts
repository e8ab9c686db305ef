// Where a clip is kept between its frames: in this thread, or in a worker reserved for it.

import { cancelled, VeroneseError } from '../../common/errors.js';
import type { ClipStep, ClipTask, Settings } from '../messages.js';
import { inOrder } from '../ordered.js';
import type { Perform } from '../tasks.js';

export interface Place {
  perform: Perform;
  release: () => void;
  /** Says whether the clip waits for its reader, if others may wait for the place. */
  pause?: (paused: boolean) => void;
  /** Why the place is no more, if it is so. */
  lost?: () => VeroneseError | undefined;
  /** Where it is one of several workers, all of them. */
  workers?: Workers;
}

export interface Workers {
  readonly size: number;
  /** With `idle`, one that has nothing to do. */
  claim: (signal: AbortSignal, idle: boolean) => Promise<Place>;
  /** Ends those that have nothing to do. */
  endIdle: () => void;
}

/** Number of clips so far. Each number is used once, because a module that replaces another after a panic must not find a clip under it. */
let clips = 0;

export class PlacedClip {
  readonly place: Place;
  readonly #signal: AbortSignal | undefined;
  readonly #clip = clips++;
  /** How many clips hold the place. */
  readonly #holders: { count: number };
  /** Whether there is something to free. */
  #open = false;

  constructor(place: Place, signal: AbortSignal | undefined, holders = { count: 0 }) {
    this.place = place;
    this.#signal = signal;
    this.#holders = holders;
    holders.count += 1;
  }

  /** Another clip, in the same place, which is released when all have ended, or in another one. */
  beside(signal: AbortSignal, place = this.place): PlacedClip {
    return new PlacedClip(place, signal, place === this.place ? this.#holders : undefined);
  }

  async begin(whole: boolean, settings: Settings): Promise<void> {
    try {
      await this.#perform({ call: 'beginClip', clip: this.#clip, whole, settings });
      this.#open = true;
    } catch (thrown) {
      // The worker may still begin a clip that was cancelled.
      this.#open = this.#signal?.aborted === true;
      throw thrown;
    }
  }

  /** Takes a step of the clip, if it still exists. */
  async step<T>(step: ClipStep): Promise<T> {
    if (this.#signal?.aborted) throw cancelled(this.#signal);
    const result = await this.#perform({ ...step, clip: this.#clip });
    if (result === null) throw new VeroneseError('internal', 'the clip was lost when another call failed');
    if (step.call === 'finishClip') this.#open = false;
    return result as T;
  }

  /** The result of the caller's code, unless the signal is aborted first. */
  async wait<T>(promised: T | Promise<T>): Promise<T | undefined> {
    // Nobody else hears what it throws if the signal comes first.
    Promise.resolve(promised).catch(() => undefined);
    const order = { room: 1, signal: this.#signal, stop: () => cancelled(this.#signal) };
    for await (const value of inOrder([promised], async (value) => value, order)) return value;
    return undefined;
  }

  /** Frees what the clip holds. If that fails, the clip is gone already. */
  async end(): Promise<void> {
    if (this.#open) await this.place.perform({ call: 'endClip', clip: this.#clip }, {}).catch(() => undefined);
    if (--this.#holders.count === 0) this.place.release();
  }

  #perform(task: ClipTask) {
    return this.place.perform(task, { signal: this.#signal });
  }
}
