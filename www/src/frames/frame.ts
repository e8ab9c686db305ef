//! Files to pixels. Bytes are decoded without colour conversion or premultiplication, and rotated by their EXIF orientation. For
//! opaque PNG files they are the same bytes as in Node. A canvas premultiplies by alpha, so half-transparent pixels are rounded, and
//! JPEG decoders differ by a grey level here and there.

import type { Pixels } from 'veronese';
import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { fingerprintOfImage } from './fingerprints.js';

/** A decoded frame. `data` is RGBA, row-major, and never changed. */
export interface DecodedFrame extends Pixels {
  readonly name: string;
  /** Identifies the frame: the same whenever its content is opened again. */
  readonly fingerprint: string;
  readonly data: Uint8ClampedArray<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
  /** Size of the image in the file, before it was scaled down. */
  readonly full: { readonly width: number; readonly height: number };
  /** The same pixels, for drawing. */
  readonly bitmap: ImageBitmap;
  /** Milliseconds that decoding took. */
  readonly decoded: number;
  /** Of an image. */
  readonly file?: File;
}

/** The page decodes no more pixels than this. */
const MOST_PIXELS = 16384 * 8192;

/** Decodes an image and scales it down to `longestSide`. Throws a {@link PageError} `unreadable-image`. */
export async function frameFromFile(file: File, name: string, longestSide: number): Promise<DecodedFrame> {
  let fingerprint: string;
  let began: number;
  let bitmap: ImageBitmap;
  try {
    fingerprint = await fingerprintOfImage(file);
    began = performance.now();
    bitmap = await createImageBitmap(file, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  } catch {
    throw new PageError('unreadable-image', strings.errors.unreadable(name));
  }
  return { ...(await frameFromBitmap(bitmap, { name, fingerprint }, longestSide, began)), file };
}

/** Takes ownership of the bitmap. `began`: the time at which decoding began, milliseconds. */
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

/** The files of two frames, with names that differ: those that were read, or the pixels on screen. */
export async function filesOf(frames: readonly (DecodedFrame | File)[]): Promise<File[]> {
  const files = await Promise.all(frames.map(async (frame) => (frame instanceof File ? frame : (frame.file ?? pngOf(frame)))));
  if (files[0]?.name !== files[1]?.name) return files;
  return files.map((file, k) => new File([file], file.name.replace(/(\.[^.]*)?$/, ` ${k + 1}$1`), { type: file.type }));
}

async function pngOf({ bitmap, name, width, height }: DecodedFrame): Promise<File> {
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')?.drawImage(bitmap, 0, 0);
  const type = 'image/png';
  return new File([await canvas.convertToBlob({ type })], `${name.replace(/[\\/:*?"<>|#]/g, '_')}.png`, { type });
}

/** The size scaled down so that the longer side is at most `longest`. */
export function smaller({ width, height }: { width: number; height: number }, longest: number): { width: number; height: number } {
  const scale = Math.min(1, longest / Math.max(width, height));
  return { width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)) };
}

/** Fetches an image that is part of the page. */
export async function fetchImage(url: string): Promise<File> {
  const name = url.replace(/^.*\//, '');
  const response = await fetch(url).catch(() => null);
  if (response === null || !response.ok) throw new PageError('unreadable-image', strings.errors.unreachable(name));
  return new File([await response.blob()], name);
}
