//! The frames of a clip as the package reads them: whenever it needs one, so that few stay in memory, or none.

import type { ClipFrame, Pixels } from 'veronese';
import type { Clip } from '../../clips/clip.js';
import { packed } from '../../result/runs.js';
import { smaller } from '../../frames/frame.js';
import type { LoadedFrame } from '../../state/pair.js';
import type { TrackedFrame } from '../../state/tracked.js';

export class ClipFrames {
  readonly length: number;
  /** The pixels of the first frame that was read, while all others are the same. */
  #first: Uint8ClampedArray | null = null;
  #differ = false;

  /** `longestSide`: to which frames are scaled down. `shown`: the frames on screen, which are not decoded again. */
  constructor(
    readonly clip: Clip,
    readonly longestSide: () => number,
    readonly shown: () => readonly (LoadedFrame | null)[],
  ) {
    this.length = clip.count;
  }

  /** Whether all frames that have been read have the same pixels. */
  get same(): boolean {
    return this.#first !== null;
  }

  async read(index: number): Promise<Pixels> {
    const side = this.longestSide();
    const seen = this.shown().find((frame): frame is LoadedFrame => frame !== null && isFrameOf(frame, this.clip, index, side));
    if (seen !== undefined) return this.#compared(seen);
    const frame = await this.clip.frame(index, side);
    frame.bitmap.close();
    return this.#compared(frame);
  }

  #compared({ data, width, height }: LoadedFrame): Pixels {
    const first = this.#first;
    if (!this.#differ) {
      this.#differ = first !== null && !data.every((value, k) => value === first[k]);
      this.#first = this.#differ ? null : (first ?? data.slice());
    }
    return { data, width, height };
  }
}

/** Whether a frame is that of the clip with this index, at the size for this longest side. */
export function isFrameOf({ origin, full, width }: LoadedFrame, clip: Clip, index: number, longestSide: number): boolean {
  return origin?.clip === clip && origin.index === index && smaller(full, longestSide).width === width;
}

export function masksOf({ labels, width, height, objects, background }: ClipFrame): TrackedFrame {
  return { runs: packed(labels, width, height), objects, background };
}
