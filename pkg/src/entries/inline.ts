// The entry that holds its modules: for bundlers that lose files, and for pages of one file.

import { Api } from '../calls/api.js';
import { VeroneseError } from '../common/errors.js';
import { Core } from '../module/core.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import { glue } from '../module/glue.js';
import { segmenters } from '../pool/segmenter.js';
import { frames, points } from './inline-module.js';

export { VeroneseError } from '../common/errors.js';
export { groupLabels } from '../calls/labels.js';
export { davisPalette } from '../common/palette.js';
export { version } from '../calls/version.js';

/** Base64 of deflated bytes, of which this is about half as long as base64 of the bytes themselves. */
async function unpacked(packed: string): Promise<Uint8Array<ArrayBuffer>> {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The address is never fetched: it only says that there is a place, so that nothing is unpacked before it is needed.
const INSIDE = new URL('veronese:inline');
const readerOf = (packed: string) => (place: URL | string) => (String(place) === INSIDE.href ? unpacked(packed) : fetch(place));
const newCore = () => new Core(glue, readerOf(frames), INSIDE);
const newPoints = () => new Core(pointsGlue, readerOf(points), INSIDE);

export const { init, initPoints, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore(), newPoints());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  newPoints,
  worker: () => {
    throw new VeroneseError('invalid-option', "option 'worker' is needed here: a function that makes a worker of veronese/worker");
  },
  jobs: () => globalThis.navigator?.hardwareConcurrency ?? 1,
});
