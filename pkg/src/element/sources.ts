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
    const blob = source instanceof Blob ? source : await fetched(name, source, base, signal);
    bitmap = await createImageBitmap(blob, { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    return pixelsOfImage(bitmap);
  } catch (cause) {
    throw cause instanceof VeroneseError ? cause : unreadable(name, cause);
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

/** Throws `unreadable-image` with the address, and what its server answered. */
async function fetched(name: string, source: string | URL, base: string, signal: AbortSignal | undefined): Promise<Blob> {
  const url = URL.canParse(String(source), base) ? new URL(source, base) : null;
  if (url === null) throw new VeroneseError('unreadable-image', `${name} cannot be loaded: '${source}' is no address`);
  const answer = await answered(url.href, { signal: signal ?? null });
  if (typeof answer === 'string') throw new VeroneseError('unreadable-image', `${name} cannot be loaded: ${answer}`);
  return answer.blob();
}

/** What a server answers with success; otherwise a sentence with the address and the status. */
export async function answered(address: string, request: RequestInit): Promise<Response | string> {
  const response = await fetch(address, request).catch((thrown: Error) => thrown);
  if (response instanceof Error) return `${address} cannot be reached, or its origin does not allow this page to read it (CORS): ${response.message}`;
  return response.ok ? response : `${address} answered ${`${response.status} ${response.statusText}`.trim()}`;
}
