// The frames of a source, taken one by one and checked.

import type { Pixels } from '../../../types/index.js';
import { reading } from '../../common/checks.js';
import { cancelled, VeroneseError } from '../../common/errors.js';
import { scaled, scaledSize } from '../../common/scaling.js';
import { inOrder } from '../ordered.js';
import type { Places } from '../places.js';
import { taken } from '../taking.js';
import { checkedPixels } from '../tasks.js';

export interface TakeOptions {
  /** Indices of the frames, if they are not counted from 0. */
  indices?: readonly number[];
  transfer?: boolean;
}

export class Frames {
  /** The error of the source, or of a frame. */
  failure: { thrown: unknown } | undefined;
  /** Width and height of all frames, once known. */
  size: Pick<Pixels, 'width' | 'height'> | undefined;
  readonly #signal: AbortSignal | undefined;
  readonly #places: Places | undefined;
  readonly #maxSize: number | undefined;
  #ask = () => {};

  constructor({ signal, maxSize }: { signal?: AbortSignal | undefined; maxSize: number | undefined }, places: Places | undefined) {
    this.#signal = signal;
    this.#places = places;
    this.#maxSize = maxSize;
  }

  /**
   * Asks for the next frame of {@link each}. Called when work on a frame has begun, so that the source decodes one frame while the worker
   * labels another; more are not taken before the reader wants them.
   */
  ahead(): void {
    this.#ask();
  }

  /** Frames up to the first failure, the next one not before it is asked for. Throws only if the signal is aborted. */
  async *each(
    source: Iterable<unknown> | AsyncIterable<unknown>,
    { indices, transfer = false }: TakeOptions = {},
  ): AsyncGenerator<Pixels, void, undefined> {
    const take = async (given: unknown, position: number) => {
      try {
        const input = this.#places ? await this.#places.frame(given, this.#maxSize) : given;
        return { frame: reading(() => this.#taken(input, indices?.[position] ?? position, transfer)) };
      } catch (thrown) {
        return { failure: { thrown } };
      }
    };
    try {
      const begun = (ask: () => void) => (this.#ask = ask);
      const order = { room: 1, signal: this.#signal, stop: () => cancelled(this.#signal), begun };
      for await (const { frame, failure } of inOrder(source, take, order)) {
        this.failure = failure;
        if (!frame) return;
        yield frame;
      }
    } catch (thrown) {
      if (this.#signal?.aborted) throw thrown;
      this.failure = { thrown };
    }
  }

  /** A single frame. Throws its failure. */
  async one(read: (index: number) => unknown, index: number): Promise<Pixels> {
    for await (const frame of this.each(reads(read, [index]), { indices: [index] })) return frame;
    throw this.failure?.thrown;
  }

  /** A copy, checked against the size of the others. */
  #taken(input: unknown, index: number, transfer: boolean): Pixels {
    const given = checkedPixels(`frame ${index}`, input, this.#maxSize);
    const { width, height } = scaledSize(given, this.#maxSize);
    this.size ??= { width, height };
    if (width !== this.size.width || height !== this.size.height) {
      const sizes = `${width}×${height} pixels, the others have ${this.size.width}×${this.size.height}`;
      throw new VeroneseError('frame-size-mismatch', `frame ${index} has ${sizes}`);
    }
    return scaled({ ...given, data: taken([given.data], transfer)[0] as Uint8Array }, this.#maxSize);
  }
}

/** Throws `too-few-frames`. */
export function checkCount(frames: number): void {
  if (frames < 2) throw new VeroneseError('too-few-frames', `a clip needs two frames, found ${frames === 0 ? 'none' : 'one'}`);
}

export function* reads(read: (index: number) => unknown, indices: Iterable<number>): Generator<unknown, void, undefined> {
  for (const index of indices) yield read(index);
}

/** Numbers from 0, one by one: a source may claim any length. */
export function* upTo(length: number): Generator<number, void, undefined> {
  for (let index = 0; index < length; index++) yield index;
}
