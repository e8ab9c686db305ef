//! The one place that talks to the worker. The latest request wins: a new one ends the one before, and so does `cancel`, by the
//! package's own means (a worker is ended and the next request starts a fresh one).

import { type Progress, type Segmentation, Segmenter } from 'veronese';
import type { LoadedFrame } from './frames.js';
import type { Settings } from './state.js';

export class Segmenting {
  readonly #segmenter = new Segmenter();
  #current: AbortController | null = null;

  /** The segmentation; `null` when the request was cancelled or overtaken by another. Throws the package's errors. */
  async run(
    pair: { readonly first: LoadedFrame; readonly second: LoadedFrame },
    settings: Settings,
    onProgress: (progress: Progress) => void,
  ): Promise<Segmentation | null> {
    this.cancel();
    const request = new AbortController();
    this.#current = request;
    const { signal } = request;
    try {
      const segmentation = await this.#segmenter.segmentPair(pixelsOf(pair.first), pixelsOf(pair.second), {
        ...settings,
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

/** Only the pixels: what else a frame holds need not be copied to the worker. */
function pixelsOf({ data, width, height }: LoadedFrame): { data: Uint8ClampedArray; width: number; height: number } {
  return { data, width, height };
}
