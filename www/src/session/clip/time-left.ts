//! The time left, from the time that the last frames have taken: the first ones shared the processors with drafts.

/** The share of the frames done so far that tells how long the others take. */
const RECENT = 0.5;

export class TimeLeft {
  /** When so many frames were done, milliseconds. */
  readonly #reached: { readonly at: number; readonly done: number }[] = [];

  /** `done`: frames that take no time, because they were done before. `of`: all frames. */
  constructor(
    readonly done: number,
    readonly of: number,
  ) {}

  /** Seconds left when so many frames are done; `null` if it is not known yet. `now`: milliseconds. */
  at(done: number, now = performance.now()): number | null {
    // The first frame may have waited for the module.
    if (done === this.done) return null;
    if (this.#reached.at(-1)?.done !== done) this.#reached.push({ at: now, done });
    const from = this.#reached[Math.floor((this.#reached.length - 1) * (1 - RECENT))]!;
    return from.done === done ? null : ((now - from.at) / (done - from.done)) * (this.of - done) / 1000;
  }
}
