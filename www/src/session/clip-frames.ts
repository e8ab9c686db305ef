//! The frames of a clip as the package reads them: whenever it needs one, so that none stays in memory.

import type { Pixels } from 'veronese';
import type { Clip } from '../clips/clip.js';
import type { Range } from '../state/tracked.js';

/** Thrown instead of reading a frame after `stop`. */
export const STOPPED = new Error('stopped');

export class ClipFrames {
  /** Of all frames, once one has been read. */
  readonly size = { width: 0, height: 0 };
  /** Number of frames that have been read, from the first of the range on. */
  #read = 0;
  #stopped = false;
  /** The pixels of the first frame that was read, while all others are the same. */
  #first: Uint8ClampedArray | null = null;
  #differ = false;

  constructor(
    readonly clip: Clip,
    readonly longestSide: number,
    readonly range: Range,
  ) {}

  get length(): number {
    return this.range.last - this.range.first + 1;
  }

  get stopped(): boolean {
    return this.#stopped;
  }

  /** Whether all frames that have been read have the same pixels. */
  get same(): boolean {
    return this.#first !== null;
  }

  /** Ends the clip after the frames that have been read: the package labels those. */
  stop(): void {
    this.#stopped = true;
  }

  /** `index` counts from the first frame of the range. */
  async read(index: number): Promise<Pixels> {
    if (this.#stopped && index >= this.#read) throw STOPPED;
    this.#read = Math.max(this.#read, index + 1);
    const { data, width, height, bitmap } = await this.clip.frame(this.range.first + index, this.longestSide);
    bitmap.close();
    this.size.width = width;
    this.size.height = height;
    this.#compare(data);
    return { data, width, height };
  }

  #compare(data: Uint8ClampedArray): void {
    if (this.#differ) return;
    const first = this.#first ?? data.slice(); // the package may take the buffer
    this.#differ = !data.every((value, k) => value === first[k]);
    this.#first = this.#differ ? null : first;
  }
}
