// The entry for Node.

import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';
import { placesBy } from './named.js';
import { packageFor } from './package.js';
import { read } from './reading.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

export const { init, initPoints, segmentPair, segmentClip, fitMotions, Segmenter, SegmenterPool, segmentPairs } = packageFor({
  read,
  frames: new URL('../wasm/veronese_bg.wasm', import.meta.url),
  points: new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url),
  worker: () => new Worker(new URL('./worker-node.js', import.meta.url), { name: 'veronese' }),
  jobs: availableParallelism,
  // With a module of its own, which only files need.
  places: placesBy(async (place, maxSize) => (await import('./frame-files.js')).decodeFile(place, maxSize)),
});
