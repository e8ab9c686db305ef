// A clip in its home between its frames.

import { cancelled, VeroneseError } from '../../common/errors.js';
import type { SegmentedStep, SegmentedTask, Settings } from '../messages.js';
import { inOrder } from '../ordered.js';
import type { Home } from '../session/clip.js';

/** Number of clips so far. Each number is used once, because a module that replaces another after a panic must not find a clip under it. */
let clips = 0;

export class PlacedClip {
  readonly place: Home;
  readonly #signal: AbortSignal | undefined;
  readonly #clip = clips++;
  /** Whether there is something to free. */
  #open = false;

  constructor(place: Home, signal: AbortSignal | undefined) {
    this.place = place;
    this.#signal = signal;
  }

  async begin(settings: Settings): Promise<void> {
    try {
      await this.#perform({ call: 'beginClip', clip: this.#clip, settings });
      this.#open = true;
    } catch (thrown) {
      // The worker may still begin a clip that was cancelled.
      this.#open = this.#signal?.aborted === true;
      throw thrown;
    }
  }

  /** Takes a step of the clip, if it still exists. */
  async step<T>(step: SegmentedStep): Promise<T> {
    if (this.#signal?.aborted) throw cancelled(this.#signal);
    const result = await this.#perform({ ...step, clip: this.#clip });
    if (result === null) throw new VeroneseError('internal', 'the clip was lost when another call failed');
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
    this.place.release();
  }

  #perform(task: SegmentedTask) {
    return this.place.perform(task, { signal: this.#signal });
  }
}
