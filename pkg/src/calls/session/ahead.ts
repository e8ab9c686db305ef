// The frames of a range with their solved pairs, some frames ahead of the clip. Pairs follow from their two frames and the options alone, so that
// any worker may solve them, and in any order.

import type { Pixels } from '../../../types/index.js';

/** Solves the pairs of a frame with the one before, or knows them; undefined where the clip is to solve them. */
export type Solve = (index: number, before: Pixels, frame: Pixels) => Promise<Uint8Array | undefined>;

export interface Solved {
  frame: Pixels;
  /** Undefined where the clip solves them itself. */
  pairs: Uint8Array | undefined;
}

export class Ahead {
  readonly #read: (index: number) => Promise<Pixels>;
  readonly #solve: Solve | undefined;
  readonly #room: number;
  readonly #last: number;
  readonly #reading = new Map<number, Promise<Pixels>>();
  readonly #solving = new Map<number, Promise<Solved>>();

  /** Of a range that ends with the frame `last`. `room`: how many frames are read and solved ahead. */
  constructor(read: (index: number) => Promise<Pixels>, solve: Solve | undefined, room: number, last: number) {
    this.#read = read;
    this.#solve = solve;
    this.#room = room;
    this.#last = last;
  }

  /** A frame of the range, with its pairs unless `isSolved` says that they are known. Those before it are not asked for again. */
  at(index: number, isSolved: (index: number) => boolean): Promise<Solved> {
    for (const frames of [this.#reading, this.#solving]) for (const each of frames.keys()) if (each < index - 1) frames.delete(each);
    for (let next = index; next <= Math.min(index + this.#room, this.#last); next++) {
      if (!this.#solving.has(next)) this.#solving.set(next, this.#solved(next, isSolved(next)));
    }
    return this.#solving.get(index) as Promise<Solved>;
  }

  #solved(index: number, isKnown: boolean): Promise<Solved> {
    const before = this.#reading.get(index - 1);
    // One frame is decoded after another.
    const reading = (before ?? Promise.resolve()).catch(() => undefined).then(() => this.#read(index));
    this.#reading.set(index, reading);
    const solved = (async () => {
      const frame = await reading;
      if (!before || !this.#solve || isKnown) return { frame, pairs: undefined };
      // A frame before that cannot be read ends the range.
      const pairs = await this.#solve(index, await before, frame).catch(() => undefined);
      return { frame, pairs };
    })();
    // Whoever wants the frame hears of it.
    solved.catch(() => undefined);
    return solved;
  }
}
