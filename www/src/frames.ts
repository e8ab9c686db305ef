//! Files to pixels. The bytes come out as the file has them: no colour conversion, no premultiplication, but turned the way
//! the camera was held. For opaque PNG files they are the bytes that Node decodes. A canvas keeps colours multiplied by alpha,
//! so half-transparent pixels come back rounded; and JPEG decoders differ from each other by a grey level here and there.

import type { Pixels } from 'veronese';
import { PageError } from './errors.js';
import { strings } from './strings.js';

/** A decoded frame. `data` is RGBA, row by row; nobody changes it. */
export interface LoadedFrame extends Pixels {
  readonly name: string;
  readonly data: Uint8ClampedArray<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
  /** The same pixels, ready to draw. */
  readonly bitmap: ImageBitmap;
  /** Milliseconds that decoding took. */
  readonly decoded: number;
}

/** Largest number of pixels the page decodes: the package's own limit, 4096 × 4096, is checked there with a better sentence. */
const MOST_PIXELS = 8192 * 8192;

/** Decodes an image. Throws a {@link PageError} `unreadable-image` when it is none. */
export async function frameFromBlob(blob: Blob, name: string): Promise<LoadedFrame> {
  const began = performance.now();
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(blob, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch {
    throw new PageError('unreadable-image', strings.errors.unreadable(name));
  }
  const { width, height } = bitmap;
  if (width * height > MOST_PIXELS) {
    bitmap.close();
    throw new PageError('frame-size-unsupported', strings.errors.tooLarge(name, width, height));
  }
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  if (context === null) throw new PageError('unsupported-browser', strings.errors.noCanvas);
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  return { name, data, width, height, bitmap, decoded: performance.now() - began };
}

/** Fetches an image that is part of the page. */
export async function frameFromUrl(url: string, name: string): Promise<LoadedFrame> {
  const response = await fetch(url).catch(() => null);
  if (response === null || !response.ok) throw new PageError('unreadable-image', strings.errors.unreachable(name));
  return frameFromBlob(await response.blob(), name);
}

const naturally = new Intl.Collator('en', { numeric: true });

/** Files in the order of a film: `frame2.png` before `frame10.png`. */
export function filesByName(files: Iterable<File>): File[] {
  return [...files].sort((a, b) => naturally.compare(a.name, b.name));
}
