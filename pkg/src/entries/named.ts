// Node: frames that a caller names by a path or an address, or gives as a stream of bytes.

import type { FrameFile, Pixels, SegmentOptions } from '../../types/index.js';
import type { PairCall, Places } from '../calls/places.js';

function isPlace(frame: unknown): frame is FrameFile {
  if (typeof frame === 'string') return frame !== '';
  try {
    return frame instanceof URL || typeof (Object(frame) as Partial<AsyncIterable<unknown>>)[Symbol.asyncIterator] === 'function';
  } catch {
    return false; // A revoked proxy, which whoever takes it refuses.
  }
}

/** `decode` reads and decodes a file. */
export function placesBy(decode: (place: FrameFile, maxSize: number | undefined) => Promise<Pixels>): Places {
  const frame = async (given: unknown, maxSize?: number) => (isPlace(given) ? decode(given, maxSize) : given);
  const pair =
    <Options extends SegmentOptions, Result>(call: PairCall<Pixels, Options, Result>): PairCall<Pixels | FrameFile, Options, Result> =>
    (first, second, options) => {
      // Two frames of pixels are taken at once, and held no longer than by the call itself.
      if (![first, second].some(isPlace)) return call(first as Pixels, second as Pixels, options);
      const { maxSize } = Object(options) as SegmentOptions;
      const frames = [frame(first, maxSize), frame(second, maxSize)];
      // Of two that fail the first is named, whichever fails sooner.
      const settled = Promise.allSettled(frames).then(() => Promise.all(frames));
      return settled.then(([one, other]) => call(one as Pixels, other as Pixels, options));
    };
  return { frame, pair };
}
