//! Work on many rows of pixels, split into short tasks so that the page stays responsive.

export class Piecewise {
  readonly #piece: number;
  readonly #later: boolean;
  #turn = 0;

  /** `piece`: pixels per task, a few milliseconds of work. `later`: the first of several pieces is a task of its own as well. */
  constructor(piece: number, later: boolean) {
    this.#piece = piece;
    this.#later = later;
  }

  /** Stops the current work, if any. */
  stop(): void {
    this.#turn += 1;
  }

  /**
   * Calls `work` for all rows, in several tasks if there are more pixels than a piece has, then `done`. New work replaces work that is
   * not finished.
   */
  rows(width: number, height: number, work: (from: number, to: number) => void, done: () => void = () => undefined): void {
    const turn = ++this.#turn;
    const step = Math.max(1, Math.floor(this.#piece / width));
    const next = (from: number): void => {
      if (turn !== this.#turn) return;
      const to = Math.min(from + step, height);
      work(from, to);
      if (to === height) done();
      else setTimeout(() => next(to));
    };
    if (this.#later && step < height) setTimeout(() => next(0));
    else next(0);
  }
}
