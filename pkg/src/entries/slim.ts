// The entry without places: the module and the workers' file are the caller's to name.

import { Api } from '../calls/api.js';
import { VeroneseError } from '../common/errors.js';
import { Core } from '../module/core.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import { glue } from '../module/glue.js';
import { segmenters } from '../pool/segmenter.js';

export { VeroneseError } from '../common/errors.js';
export { groupLabels } from '../calls/labels.js';
export { davisPalette } from '../common/palette.js';
export { version } from '../calls/version.js';

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
