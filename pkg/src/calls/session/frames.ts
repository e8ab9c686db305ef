// The frames of a clip, read one by one and checked.

import type { Pixels } from '../../../types/index.js';
import { invalidInput, isWhole, reading } from '../../common/checks.js';
import { scaled } from '../../common/scaling.js';
import type { Places } from '../places.js';
import { taken } from '../taking.js';
import { checkedPixels } from '../tasks.js';

export class ClipFrames {
  readonly length: number;
  readonly #read: (index: number) => unknown;
  readonly #places: Places | undefined;
  readonly #maxSize: number | undefined;

  /** A list, or `{ length, read(index) }`. */
  constructor(frames: unknown, places: Places | undefined, maxSize: number | undefined) {
    const { length, read } = Object(frames) as { length: unknown; read: unknown };
    const isReadable = typeof read === 'function';
    if (!isReadable && !Array.isArray(frames))
      throw invalidInput('the frames must be a list of pixels, or { length, read(index) }; segmentStream takes frames that come once');
    if (!isWhole(length, 0, Infinity)) throw invalidInput("the frames: 'length' must be a whole number");
    const list = isReadable ? [] : [...(frames as unknown[])];
    this.length = length;
    this.#read = isReadable ? (index) => (frames as { read: (index: number) => unknown }).read(index) : (index) => list[index];
    this.#places = places;
    this.#maxSize = maxSize;
  }

  /** A copy of a frame. */
  async read(index: number): Promise<Pixels> {
    const given = await this.#read(index);
    const frame = this.#places ? await this.#places.frame(given, this.#maxSize) : given;
    return reading(() => this.#checked(frame, index));
  }

  #checked(frame: unknown, index: number): Pixels {
    const given = checkedPixels(`frame ${index}`, frame, this.#maxSize);
    return scaled({ ...given, data: taken([given.data], false)[0] as Uint8Array }, this.#maxSize);
  }
}
