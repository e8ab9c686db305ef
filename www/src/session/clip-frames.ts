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
    return { data, width, height };
  }
}
