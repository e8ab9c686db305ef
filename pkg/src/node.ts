// The entry for Node.

import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';
import { glue } from './glue.js';
import { glue as pointsGlue } from './glue-points.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { read } from './reading.js';
import { segmenters } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () => new Core(glue, read, new URL('../wasm/veronese_bg.wasm', import.meta.url));
const newPoints = () => new Core(pointsGlue, read, new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url));

export const { init, initPoints, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore(), newPoints());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  newPoints,
  worker: () => new Worker(new URL('./worker-node.js', import.meta.url), { name: 'veronese' }),
  jobs: availableParallelism,
});
