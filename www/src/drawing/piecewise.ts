//! Work on many rows of pixels in pieces, with the page's other work between them.

export class Piecewise {
  readonly #piece: number;
  readonly #later: boolean;
  #turn = 0;

  /** `piece`: pixels that are a few milliseconds of work. `later`: the first piece is a task of its own, too. */
  constructor(piece: number, later: boolean) {
    this.#piece = piece;
    this.#later = later;
  }

  /** The work under way, if any, is not gone on with. */
  stop(): void {
    this.#turn += 1;
  }

  /**
   * Calls `work` for all rows, and `done` at the end; where there are more pixels than a piece holds, in several tasks. New work
   * replaces the old.
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
    if (this.#later) setTimeout(() => next(0));
    else next(0);
  }
}
