// The entry that holds its module: for bundlers that lose files, and for pages of one file.

import { glue } from './glue.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { VeroneseError } from './errors.js';
import { packed } from './inline-module.js';
import { segmenters } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

/** Base64 of deflated bytes, of which this is about half as long as base64 of the bytes themselves. */
async function unpacked(): Promise<Uint8Array<ArrayBuffer>> {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The address is never fetched: it only says that there is a place, so that nothing is unpacked before it is needed.
const newCore = () => new Core(glue, (place) => (String(place) === PLACE.href ? unpacked() : fetch(place)), PLACE);
const PLACE = new URL('veronese:inline');

export const { init, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  worker: () => {
    throw new VeroneseError('invalid-option', "option 'worker' is needed here: a function that makes a worker of veronese/worker");
  },
  jobs: () => globalThis.navigator?.hardwareConcurrency ?? 1,
});
