//! The only access to the worker of the pair, and the owner of the request under way. The latest request wins: a new one aborts the one
//! before, as `cancel` does. The package then ends the worker, and the next request starts a new one.

import { type Pixels, type Progress, type Segmentation, Segmenter } from 'veronese';
import type { Settings } from '../../state/settings.js';

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
  run(pair: Pair, settings: Settings, onProgress: (progress: Progress) => void = () => undefined): Promise<Segmentation | null> {
    const { longestSide: _, ...options } = settings;
    return this.#request((signal) =>
      this.#segmenter.segmentPair(pixelsOf(pair.first), pixelsOf(pair.second), {
        ...options,
        signal,
        onProgress: (progress) => {
          if (!signal.aborted) onProgress(progress);
        },
      }),
    );
  }

  /** Solves the labels again given evidence; otherwise like {@link run}. */
  relabel(pair: Pair, segmentation: Segmentation, evidence: Uint16Array): Promise<Segmentation | null> {
    return this.#request((signal) =>
      this.#segmenter.relabel(pixelsOf(pair.first), pixelsOf(pair.second), segmentation, evidence, { signal }),
    );
  }

  cancel(): void {
    this.#current?.abort();
    this.#current = null;
  }

  async #request(ask: (signal: AbortSignal) => Promise<Segmentation>): Promise<Segmentation | null> {
    this.cancel();
    const request = new AbortController();
    this.#current = request;
    const { signal } = request;
    try {
      const segmentation = await ask(signal);
      return signal.aborted ? null : segmentation;
    } catch (error) {
      if (signal.aborted) return null;
      throw error;
    } finally {
      if (this.#current === request) this.#current = null;
    }
  }
}

/** Only the pixels are copied to the worker. */
function pixelsOf({ data, width, height }: Pixels): Pixels {
  return { data, width, height };
}
