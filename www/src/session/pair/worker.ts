//! The only access to the worker of the pair, and the owner of the request under way. The latest request wins: a new one aborts the one
//! before, as `cancel` does. The package then ends the worker, and the next request starts a new one.

import { type Pixels, type Progress, type SegmentOptions, type Segmentation, Segmenter } from 'veronese';

interface Pair {
  readonly first: Pixels;
  readonly second: Pixels;
}

export class PairWorker {
  readonly #segmenter = new Segmenter();
  #current: AbortController | null = null;
  #warm = false;

  /** Starts the worker and lets it warm up until there is a request. Called when frames that will be segmented are being decoded. */
  prepare(): void {
    if (this.#warm) return;
    this.#warm = true;
    this.#segmenter.warmUp().catch(() => undefined); // the request that needs the worker reports why there is none
  }

  /** Segments a pair; `null` if the request was cancelled or replaced by another. Throws the package's errors. */
  async run(pair: Pair, options: SegmentOptions, onProgress: (progress: Progress) => void = () => undefined): Promise<Segmentation | null> {
    this.cancel();
    const request = new AbortController();
    this.#current = request;
    const { signal } = request;
    try {
      const segmentation = await this.#segmenter.segmentPair(pixelsOf(pair.first), pixelsOf(pair.second), {
        ...options,
        signal,
        onProgress: (progress) => {
          if (!signal.aborted) onProgress(progress);
        },
      });
      return signal.aborted ? null : segmentation;
    } catch (error) {
      if (signal.aborted) return null;
      throw error;
    } finally {
      if (this.#current === request) this.#current = null;
    }
  }

  cancel(): void {
    this.#current?.abort();
    this.#current = null;
  }
}

/** Only the pixels are copied to the worker. */
function pixelsOf({ data, width, height }: Pixels): Pixels {
  return { data, width, height };
}
