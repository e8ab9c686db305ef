// Frames that are named instead of given, where something can read them: in Node.

import type { FrameFile, Pixels } from '../../types/index.js';

/** Reads and decodes a file. */
export type Decode = (place: FrameFile) => Promise<Pixels>;

export function isPlace(frame: unknown): frame is FrameFile {
  if (typeof frame === 'string') return frame !== '';
  try {
    return frame instanceof URL;
  } catch {
    return false; // A revoked proxy, which whoever takes it refuses.
  }
}

/** A call that takes two frames, which may also be named. Two frames of pixels are taken at once, and held no longer than by the call itself. */
export function withPlaces<Options, Result>(decode: Decode | undefined, call: (first: Pixels, second: Pixels, options?: Options) => Promise<Result>) {
  return (first: Pixels | FrameFile, second: Pixels | FrameFile, options?: Options): Promise<Result> => {
    if (decode === undefined || ![first, second].some(isPlace)) return call(first as Pixels, second as Pixels, options);
    const read = [first, second].map(async (frame) => (isPlace(frame) ? decode(frame) : frame));
    return Promise.all(read).then(([one, other]) => call(one as Pixels, other as Pixels, options));
  };
}
