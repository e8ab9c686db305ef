//! Files to pixels. The bytes come out as the file has them: no colour conversion, no premultiplication, but turned the way
//! the camera was held. For opaque PNG files they are the bytes that Node decodes. A canvas keeps colours multiplied by alpha,
//! so half-transparent pixels come back rounded; and JPEG decoders differ from each other by a grey level here and there.

import type { Pixels } from 'veronese';
import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { fingerprintOfImage } from './fingerprints.js';

/** A decoded frame. `data` is RGBA, row by row; nobody changes it. */
export interface DecodedFrame extends Pixels {
  readonly name: string;
  /** What it is known by: the same when the same frame is opened again, from wherever. */
  readonly fingerprint: string;
  readonly data: Uint8ClampedArray<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
  /** Size of the file's picture, where it was made smaller. */
  readonly full: { readonly width: number; readonly height: number };
  /** The same pixels, ready to draw. */
  readonly bitmap: ImageBitmap;
  /** Milliseconds that decoding took. */
  readonly decoded: number;
}

/** Largest number of pixels the page decodes. */
const MOST_PIXELS = 16384 * 8192;

/** Decodes an image, no larger than `longestSide`. Throws a {@link PageError} `unreadable-image` when it is none. */
export async function frameFromBlob(blob: Blob, name: string, longestSide: number): Promise<DecodedFrame> {
  let fingerprint: string;
  let began: number;
  let bitmap: ImageBitmap;
  try {
    fingerprint = await fingerprintOfImage(blob);
    began = performance.now();
    bitmap = await createImageBitmap(blob, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch {
    throw new PageError('unreadable-image', strings.errors.unreadable(name));
  }
  return frameFromBitmap(bitmap, { name, fingerprint }, longestSide, began);
}

/** Takes the bitmap over. `began` is when work on it began. */
export async function frameFromBitmap(
  given: ImageBitmap,
  { name, fingerprint }: Pick<DecodedFrame, 'name' | 'fingerprint'>,
  longestSide: number,
  began: number,
): Promise<DecodedFrame> {
  const full = { width: given.width, height: given.height };
  if (full.width * full.height > MOST_PIXELS) {
    given.close();
    throw new PageError('frame-size-unsupported', strings.errors.tooLarge(name, full.width, full.height));
  }
  const { width, height } = smaller(full, longestSide);
  let bitmap = given;
  if (width !== full.width || height !== full.height) {
    bitmap = await createImageBitmap(given, { resizeWidth: width, resizeHeight: height, resizeQuality: 'high' });
    given.close();
  }
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  if (context === null) throw new PageError('unsupported-browser', strings.errors.noCanvas);
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  return { name, fingerprint, data, width, height, full, bitmap, decoded: performance.now() - began };
}

/** The size that keeps the longer side within `longest`. */
export function smaller({ width, height }: { width: number; height: number }, longest: number): { width: number; height: number } {
  const scale = Math.min(1, longest / Math.max(width, height));
  return { width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)) };
}

/** Fetches an image that is part of the page. */
export async function frameFromUrl(url: string, name: string, longestSide: number): Promise<DecodedFrame> {
  const response = await fetch(url).catch(() => null);
  if (response === null || !response.ok) throw new PageError('unreadable-image', strings.errors.unreachable(name));
  return frameFromBlob(await response.blob(), name, longestSide);
}
