//! Work on many rows of pixels in pieces, with the page's other work between them.

/** Pixels of a piece: a few milliseconds of work. */
const PIECE = 1 << 19;

export class Piecewise {
  #turn = 0;

  /** The work under way, if any, is not gone on with. */
  stop(): void {
    this.#turn += 1;
  }

  /**
   * Calls `work` for all rows, first at once and, where there are more pixels than a piece holds, then in tasks of their own; new
   * work replaces the old. `done` is called at the end.
   */
  rows(width: number, height: number, work: (from: number, to: number) => void, done: () => void = () => undefined): void {
    const turn = ++this.#turn;
    const step = Math.max(1, Math.floor(PIECE / width));
    const next = (from: number): void => {
      if (turn !== this.#turn) return;
      const to = Math.min(from + step, height);
      work(from, to);
      if (to === height) done();
      else setTimeout(() => next(to));
    };
    next(0);
  }
}
