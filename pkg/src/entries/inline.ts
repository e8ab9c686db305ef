// The entry that holds its modules: for bundlers that lose files, and for pages of one file.

import { frames, points } from './inline-module.js';
import { packageFor } from './package.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

// Never fetched: the address only stands for a module, so that nothing is unpacked before it is needed.
const FRAMES = new URL('veronese:frames');
const POINTS = new URL('veronese:points');
const INSIDE = new Map([
  [FRAMES.href, frames],
  [POINTS.href, points],
]);

/** Base64 of deflated bytes, of which this is about half as long as base64 of the bytes themselves. */
async function unpacked(packed: string): Promise<Uint8Array<ArrayBuffer>> {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export const { init, initPoints, segmentPair, openClip, segmentStream, solvePair, fitMotions, Segmenter, SegmenterPool, segmentPairs } =
  packageFor({
    read: (place) => {
      const packed = INSIDE.get(String(place));
      return packed === undefined ? fetch(place) : unpacked(packed);
    },
    frames: FRAMES,
    points: POINTS,
  });
