// The entry for browsers, workers and bundlers.

import { Api } from '../calls/api.js';
import { Core } from '../module/core.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import { glue } from '../module/glue.js';
import { segmenters } from '../pool/segmenter.js';

export { VeroneseError } from '../common/errors.js';
export { groupLabels } from '../calls/labels.js';
export { davisPalette } from '../common/palette.js';
export { version } from '../calls/version.js';

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
