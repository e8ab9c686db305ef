// The pairs of a whole clip, solved by several workers. They follow from their two frames and the options alone, so whoever solves them, and
// in whatever order, the clip is the same to the bit.

import type { Pixels } from '../../../types/index.js';
import { cancelled } from '../../common/errors.js';
import type { Settings } from '../messages.js';
import type { inOrder } from '../ordered.js';
import type { PlacedClip, Workers } from './place.js';

/** Pairs that a worker solves in a row where it can: of each block one frame is prepared by two workers. */
const BLOCK = 2;

/** A frame of the clip, and the result of its pairs if that is known. */
export interface Looked {
  index: number;
  frame: Pixels;
  pairs: Uint8Array | undefined;
}

/** A pair that nobody has solved yet. */
interface Unsolved {
  /** Of its second frame. */
  index: number;
  frames: readonly [before: Pixels, frame: Pixels];
  resolve: (pairs: Uint8Array) => void;
  reject: (reason: unknown) => void;
}

export class SharedPairs {
  readonly #clip: PlacedClip;
  readonly #workers: Workers;
  readonly #settings: Settings;
  /** Of each worker one: engines warn of many listeners to one signal. */
  readonly #endings: AbortController[];
  #ended = false;
  /** In order. */
  readonly #unsolved: Unsolved[] = [];
  /** Blocks that somebody solves. */
  readonly #begun = new Set<number>();
  /** Frames whose pairs are known and which the clip has not taken. */
  readonly #known = new Set<number>();
  /** The frame that the clip takes next. */
  #next = 0;
  #listeners: (() => void)[] = [];
  #ask = () => {};

  /** The worker of the clip solves pairs itself where it has nothing else to do; the others help. */
  constructor(clip: PlacedClip, workers: Workers, settings: Settings) {
    this.#clip = clip;
    this.#workers = workers;
    this.#settings = settings;
    this.#endings = Array.from({ length: workers.size }, () => new AbortController());
  }

  /** Asks for one more frame. Called when the clip has begun to take one. */
  ahead(): void {
    this.#ask();
  }

  /** Says that the clip has taken the frame that came last. */
  taken(): void {
    this.#known.delete(this.#next++);
    this.#notify();
  }

  /** The frames in their order, with the results of their pairs. `onPairs` hears of those that were solved, as soon as they are. */
  async *solved(
    frames: AsyncIterable<Looked>,
    // Given, not imported: bundlers put what this file imports into the worker, which has no use for it.
    order: typeof inOrder,
    { signal, onPairs }: { signal: AbortSignal | undefined; onPairs: (index: number, pairs: Uint8Array) => Promise<void> },
  ): AsyncGenerator<Looked, void, undefined> {
    let last: Pixels | undefined;
    const work = async (looked: Looked) => {
      const { index, frame } = looked;
      const before = last;
      last = frame;
      try {
        let { pairs } = looked;
        if (before && !pairs) {
          pairs = await this.#solution(index, [before, frame]);
          await onPairs(index, pairs.slice());
        }
        this.#known.add(index);
        return { looked: { index, frame, pairs } };
      } catch (thrown) {
        return { failure: { thrown } };
      }
    };
    // A frame for each worker, and a block to choose from.
    const room = this.#endings.length + BLOCK;
    try {
      const [own, ...others] = this.#endings.map((ending) => ending.signal) as [AbortSignal, ...AbortSignal[]];
      void this.#solve(own);
      void Promise.all(others.map((signal) => this.#help(signal))).then(() => this.#workers.endIdle());
      const begun = (ask: () => void) => (this.#ask = ask);
      for await (const { looked, failure } of order(frames, work, { room, signal, stop: () => cancelled(signal), begun })) {
        if (failure) throw failure.thrown;
        // The next pair may still need it.
        yield { ...looked, frame: copyOf(looked.frame) };
      }
    } finally {
      this.#ended = true;
      this.#endings.forEach((ending) => ending.abort());
      this.#notify();
    }
  }

  #solution(index: number, frames: Unsolved['frames']): Promise<Uint8Array> {
    return new Promise((resolve, reject) => this.#add({ index, frames, resolve, reject }));
  }

  #add(pair: Unsolved): void {
    const later = this.#unsolved.findIndex(({ index }) => index > pair.index);
    this.#unsolved.splice(later < 0 ? this.#unsolved.length : later, 0, pair);
    this.#notify();
  }

  /** Solves pairs in the worker of the clip, which takes frames first: all others wait for that. */
  async #solve(signal: AbortSignal): Promise<void> {
    const isFree = () => this.#unsolved.length > 0 && !this.#known.has(this.#next);
    while (await this.#until(isFree)) {
      try {
        await this.#solveBlock(this.#clip.beside(signal), () => this.#until(isFree));
      } catch (thrown) {
        for (const { reject } of this.#unsolved.splice(0)) reject(thrown);
      }
    }
  }

  /** Solves pairs in another worker, which is had for a block at a time, because others may want it. Where it fails, nobody misses it. */
  async #help(signal: AbortSignal): Promise<void> {
    try {
      while (await this.#until(() => this.#unsolved.length > 0)) {
        // Workers that were ended with that of the clip are not started for it again.
        if (this.#clip.place.lost?.()) return;
        await this.#solveBlock(this.#clip.beside(signal, await this.#workers.claim(signal, true)), async () => !this.#ended);
      }
    } catch {
      // Its pairs wait for another worker.
    }
  }

  /** Solves pairs that follow each other, a block at most, while it may go on. */
  async #solveBlock(clip: PlacedClip, mayGoOn: () => Promise<boolean>): Promise<void> {
    let pair: Unsolved | undefined;
    let block: number | undefined;
    try {
      await clip.begin(true, this.#settings);
      // Not before: the worker may have had something else to do.
      pair = this.#taken((index) => !this.#begun.has(blockOf(index)));
      if (pair) this.#begun.add((block = blockOf(pair.index)));
      pair ??= this.#unsolved.pop();
      if (pair) await clip.step({ call: 'pushClip', frame: copyOf(pair.frames[0]) });
      while (pair) {
        const { index, frames, resolve }: Unsolved = pair;
        resolve(await clip.step<Uint8Array>({ call: 'pushClip', frame: copyOf(frames[1]) }));
        pair = (await mayGoOn()) ? this.#taken((other) => other === index + 1 && blockOf(other) === blockOf(index)) : undefined;
      }
    } catch (thrown) {
      if (pair) this.#add(pair);
      throw thrown;
    } finally {
      if (block !== undefined) this.#begun.delete(block);
      await clip.end();
    }
  }

  /** The first pair of which this holds; it is nobody else's then. */
  #taken(holds: (index: number) => boolean): Unsolved | undefined {
    const place = this.#unsolved.findIndex(({ index }) => holds(index));
    return place < 0 ? undefined : this.#unsolved.splice(place, 1)[0];
  }

  /** Waits until this holds. Says whether it does: not if the clip has ended before. */
  async #until(holds: () => boolean): Promise<boolean> {
    while (!this.#ended) {
      if (holds()) return true;
      await new Promise<void>((resolve) => this.#listeners.push(resolve));
    }
    return false;
  }

  #notify(): void {
    for (const listener of this.#listeners.splice(0)) listener();
  }
}

/** The number of the block of a pair. */
function blockOf(index: number): number {
  return Math.floor((index - 1) / BLOCK);
}

/** A frame goes to more than one worker. */
function copyOf({ data, ...size }: Pixels): Pixels {
  return { ...size, data: data.slice() };
}
