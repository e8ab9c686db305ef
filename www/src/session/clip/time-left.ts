//! The time left, from the time that frames have taken so far.

export class TimeLeft {
  #began: { readonly at: number; readonly done: number } | null = null;

  /** `done`: frames that take no time, because they were done before. `of`: all frames. */
  constructor(
    readonly done: number,
    readonly of: number,
  ) {}

  /** Seconds left when so many frames are done; `null` if it is not known yet. */
  at(done: number): number | null {
    if (done === this.done) return null;
    // The first frame may have waited for the module.
    if (this.#began === null) {
      this.#began = { at: performance.now(), done };
      return null;
    }
    const each = (performance.now() - this.#began.at) / (done - this.#began.done);
    return (each * (this.of - done)) / 1000;
  }
}
