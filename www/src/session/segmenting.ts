//! The one place that talks to the worker. The latest request wins: a new one ends the one before, and so does `cancel`, by the
//! package's own means (a worker is ended and the next request starts a fresh one).

import { type Pixels, type Progress, type Segmentation, Segmenter } from 'veronese';
import type { Settings } from '../state/settings.js';

interface Pair {
  readonly first: Pixels;
  readonly second: Pixels;
}

export class Segmenting {
  readonly #segmenter = new Segmenter();
  #current: AbortController | null = null;

  /** The segmentation; `null` when the request was cancelled or overtaken by another. Throws the package's errors. */
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

  /** The labels solved again under evidence, as {@link run} otherwise. */
  relabel(pair: Pair, segmentation: Segmentation, evidence: Uint16Array): Promise<Segmentation | null> {
    return this.#request((signal) =>
      this.#segmenter.relabel(pixelsOf(pair.first), pixelsOf(pair.second), segmentation, evidence, { signal }),
    );
  }

  cancel(): void {
    this.#current?.abort();
    this.#current = null;
  }

  /** Ends the worker. */
  close(): void {
    this.cancel();
    this.#segmenter.close();
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

/** Only the pixels: what else a frame holds need not be copied to the worker. */
function pixelsOf({ data, width, height }: Pixels): Pixels {
  return { data, width, height };
}
