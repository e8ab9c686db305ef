// The entry without places: the module and the workers' file are the caller's to name.

import { glue } from './glue.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { VeroneseError } from './errors.js';
import { segmenters } from './segmenter.js';

export { VeroneseError } from './errors.js';
export { groupLabels } from './labels.js';
export { davisPalette } from './palette.js';
export { version } from './version.js';

const newCore = () => new Core(glue, (place) => fetch(place));

export const { init, segmentPair, relabel, fitMotions, paintLabels } = new Api(newCore());

export const { Segmenter, SegmenterPool, segmentPairs } = segmenters({
  newCore,
  worker: () => {
    throw new VeroneseError('invalid-option', "option 'worker' is needed here: a function that makes a worker of veronese/worker");
  },
  jobs: () => globalThis.navigator?.hardwareConcurrency ?? 1,
});
