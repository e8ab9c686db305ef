// Sources of a frame, and its pixels.

import type { FrameSource } from '../../types/element-class.js';
import type { Pixels } from '../../types/index.js';
import { taken } from '../calls/taking.js';
import { checkedPixels } from '../calls/tasks.js';
import { reading } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';

/** A frame that nobody else can change; or why it cannot be used. */
export type Kept = string | Blob | Pixels | VeroneseError;

/** Where addresses begin, and when to stop. */
export interface Place {
  base: string;
  signal?: AbortSignal | undefined;
}

/** Copies what others could change. `name` is how errors call the frame. */
export function kept(name: string, source: FrameSource): Kept {
  if (typeof source === 'string' || source instanceof Blob) return source;
  try {
    if (source instanceof URL) return source.href;
    if (source instanceof ImageBitmap) return pixelsOfImage(source);
    const { data, ...size } = reading(() => checkedPixels(name, source));
    return { ...size, data: taken([data], false)[0] as Uint8Array };
  } catch (thrown) {
    return thrown instanceof VeroneseError ? thrown : unreadable(name, thrown);
  }
}

/** Decodes a frame. Pixels are checked and not copied. */
export async function pixelsOf(name: string, source: FrameSource, { base, signal }: Place): Promise<Pixels> {
  if (source instanceof ImageBitmap) return pixelsOfImage(source);
  if (typeof source !== 'string' && !(source instanceof URL) && !(source instanceof Blob)) return reading(() => checkedPixels(name, source));
  let bitmap: ImageBitmap | undefined;
  try {
    const blob = source instanceof Blob ? source : await fetched(new URL(source, base), signal);
    bitmap = await createImageBitmap(blob, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    return pixelsOfImage(bitmap);
  } catch (cause) {
    throw unreadable(name, cause);
  } finally {
    bitmap?.close();
  }
}

export function pixelsOfImage(image: ImageBitmap): Pixels {
  const { width, height } = image;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  if (context === null) throw new VeroneseError('internal', 'this browser gives no canvas to read pixels from');
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height);
}

function unreadable(name: string, cause: unknown): VeroneseError {
  return new VeroneseError('unreadable-image', `${name} is not an image that this browser can read`, { cause });
}

async function fetched(url: URL, signal: AbortSignal | undefined): Promise<Blob> {
  const response = await fetch(url, { signal: signal ?? null });
  if (!response.ok) throw new Error(`${url.href} answered ${response.status}`);
  return response.blob();
}
