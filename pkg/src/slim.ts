// The entry without places: the module and the workers' file are the caller's to name.

import { glue } from './glue.js';
import { glue as pointsGlue } from './glue-points.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { VeroneseError } from './errors.js';
import { segmenters } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () => new Core(glue, (place) => fetch(place));
const newPoints = () => new Core(pointsGlue, (place) => fetch(place));

export const { init, initPoints, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore(), newPoints());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  newPoints,
  worker: () => {
    throw new VeroneseError('invalid-option', "option 'worker' is needed here: a function that makes a worker of veronese/worker");
  },
  jobs: () => globalThis.navigator?.hardwareConcurrency ?? 1,
});
