// The entry without addresses: the modules and the workers' file are the caller's to name.

import { packageFor } from './package.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

export const { init, initPoints, segmentPair, openClip, segmentStream, solvePair, fitMotions, Segmenter, SegmenterPool, segmentPairs } =
  packageFor({});
