// The entry for Node.

import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';
import { Api } from '../calls/api.js';
import { Core } from '../module/core.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import { glue } from '../module/glue.js';
import { segmenters } from '../pool/segmenter.js';
import { read } from './reading.js';

export { VeroneseError } from '../common/errors.js';
export { groupLabels } from '../calls/labels.js';
export { davisPalette } from '../common/palette.js';
export { version } from '../calls/version.js';

const newCore = () => new Core(glue, read, new URL('../wasm/veronese_bg.wasm', import.meta.url));
const newPoints = () => new Core(pointsGlue, read, new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url));

export const { init, initPoints, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore(), newPoints());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  newPoints,
  worker: () => new Worker(new URL('./worker-node.js', import.meta.url), { name: 'veronese' }),
  jobs: availableParallelism,
});
