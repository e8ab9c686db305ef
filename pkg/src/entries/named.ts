// Node: frames that a caller names by a path or an address.

import type { FrameFile, Pixels } from '../../types/index.js';
import type { PairCall, Places } from '../calls/places.js';

function isPlace(frame: unknown): frame is FrameFile {
  if (typeof frame === 'string') return frame !== '';
  try {
    return frame instanceof URL;
  } catch {
    return false; // A revoked proxy, which whoever takes it refuses.
  }
}

/** `decode` reads and decodes a file. */
export function placesBy(decode: (place: FrameFile) => Promise<Pixels>): Places {
  const frame = async (given: unknown) => (isPlace(given) ? decode(given) : given);
  const pair =
    <Options, Result>(call: PairCall<Pixels, Options, Result>): PairCall<Pixels | FrameFile, Options, Result> =>
    (first, second, options) => {
      // Two frames of pixels are taken at once, and held no longer than by the call itself.
      if (![first, second].some(isPlace)) return call(first as Pixels, second as Pixels, options);
      return Promise.all([frame(first), frame(second)]).then(([one, other]) => call(one as Pixels, other as Pixels, options));
    };
  return { frame, pair };
}
