// The number of motions between two frames, found in a worker.

import { Segmenter } from 'veronese';
import { pixelsOf } from './pixels.js';

export class Motions {
  #segmenter = new Segmenter();
  #newer = new AbortController();

  /** Cancels what it is asked before; undefined if this call is cancelled too. */
  async between(first, second) {
    this.#newer.abort();
    this.#newer = new AbortController();
    const { signal } = this.#newer;
    const frames = await Promise.all([pixelsOf(first), pixelsOf(second)]);
    if (signal.aborted) return undefined;
    const segmentation = await this.#segmenter.segmentPair(...frames, { quality: 'fast', signal }).catch(() => undefined);
    return segmentation?.count;
  }

  close() {
    this.#newer.abort();
    this.#segmenter.close();
  }
}
