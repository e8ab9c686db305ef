// The entry for browsers, workers and bundlers.

import { glue } from './glue.js';
import { glue as pointsGlue } from './glue-points.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { segmenters } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () => new Core(glue, (place) => fetch(place), new URL('../wasm/veronese_bg.wasm', import.meta.url));
const newPoints = () =>
  new Core(pointsGlue, (place) => fetch(place), new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url));

export const { init, initPoints, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore(), newPoints());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  newPoints,
  // Bundlers look for this very expression.
  worker: () => new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'veronese' }),
  jobs: () => navigator.hardwareConcurrency,
});
