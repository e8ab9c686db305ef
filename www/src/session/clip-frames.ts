//! The frames of a clip as the package reads them: whenever it needs one, so that none stays in memory.

import type { Pixels } from 'veronese';
import type { Clip } from '../clips/clip.js';

export class ClipFrames {
  /** Of all frames, once one has been read. */
  readonly size = { width: 0, height: 0 };

  constructor(
    readonly clip: Clip,
    readonly longestSide: number,
  ) {}

  get length(): number {
    return this.clip.count;
  }

  async read(index: number): Promise<Pixels> {
    const { data, width, height, bitmap } = await this.clip.frame(index, this.longestSide);
    bitmap.close();
    this.size.width = width;
    this.size.height = height;
    return { data, width, height };
  }
}
