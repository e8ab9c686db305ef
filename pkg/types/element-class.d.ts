// Types of `veronese/element-class`: the element's class, to register under a name of your own.

import type { Pixels, Progress, Segmentation, VeroneseError } from './index.js';

/** A frame: a URL, a file, a bitmap, or pixels. */
export type FrameSource = string | URL | Blob | ImageBitmap | Pixels;

export interface VeroneseSegmenterEventMap extends HTMLElementEventMap {
  progress: CustomEvent<Progress> & ProgressEvent;
  result: CustomEvent<Segmentation>;
  error: CustomEvent<VeroneseError> & ErrorEvent;
}

/**
 * Segments two frames and shows the masks over the first one.
 *
 * Attributes: `first` and `second` (image URLs), `motions` (`auto` or 1 to 10), `quality` (`fast` or `best`), `seed`,
 * `grouped` (masks are groups of motions). The element segments when it is connected and whenever an attribute changes.
 *
 * Events: `progress`, `result` and `error`, each with a `detail`. They do not bubble.
 *
 * CSS: `--veronese-opacity`, `--veronese-background`, `--veronese-font`, `--veronese-status-colour`,
 * `--veronese-status-background`, and `--veronese-colour-K` for mask K. Parts: `picture`, `frame`, `masks`, `status`.
 */
export class VeroneseSegmenterElement extends HTMLElement {
  static readonly observedAttributes: string[];
  /** The last result. */
  readonly result: Segmentation | undefined;
  /** Sets both frames and segments them. Pixels and bitmaps are copied before the call returns. */
  setFrames(first: FrameSource, second: FrameSource): Promise<Segmentation>;
  /** Segments the frames with the current attributes. A new call cancels the previous one, which rejects with code `cancelled`. */
  segment(): Promise<Segmentation>;
  /** Stops at once; the last result is kept. */
  abort(): void;
  /** One number per pixel: labels, or groups if the element is `grouped`; 255 is unlabelled. */
  labels(): Uint8Array | undefined;
  /** 255 where the label (or group) is, 0 elsewhere. */
  mask(wanted: number): Uint8Array | undefined;
  addEventListener<K extends keyof VeroneseSegmenterEventMap>(
    type: K,
    listener: (this: VeroneseSegmenterElement, event: VeroneseSegmenterEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}
