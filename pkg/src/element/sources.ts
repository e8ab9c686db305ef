// Sources of a frame, and its pixels.

import type { FrameSource } from '../../types/element-class.js';
import type { Pixels } from '../../types/index.js';
import { isPicture, pixelsOfPicture } from '../calls/places.js';
import { taken } from '../calls/taking.js';
import { checkedPixels } from '../calls/tasks.js';
import { reading } from '../common/checks.js';
import { VeroneseError, veroneseError } from '../common/errors.js';

/** A frame that nobody else can change; or why it cannot be used. */
export type Kept = string | Blob | Pixels | Promise<Pixels> | VeroneseError;

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
    if (isPicture(source)) {
      const pixels = pixelsOfPicture(name, source);
      // Whoever asks for the pixels hears of it.
      pixels.catch(() => undefined);
      return pixels;
    }
    const { data, ...size } = reading(() => checkedPixels(name, source));
    return { ...size, data: taken([data], false)[0] as Uint8Array };
  } catch (thrown) {
    return veroneseError(thrown);
  }
}

/** Decodes a frame. Pixels are checked and not copied. */
export async function pixelsOf(name: string, source: FrameSource, { base, signal }: Place): Promise<Pixels> {
  const picture = typeof source === 'string' || source instanceof URL ? await fetched(name, source, base, signal) : source;
  return isPicture(picture) ? pixelsOfPicture(name, picture) : reading(() => checkedPixels(name, picture));
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
  if (response instanceof Error)
    return `${address} cannot be reached, or its origin does not allow this page to read it (CORS): ${response.message}`;
  return response.ok ? response : `${address} answered ${`${response.status} ${response.statusText}`.trim()}`;
}
