// The entry for browsers, workers and bundlers.

import { packageFor } from './package.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

export const { init, initPoints, segmentPair, segmentClip, relabel, fitMotions, paintLabels, Segmenter, SegmenterPool, segmentPairs } = packageFor({
  frames: new URL('../wasm/veronese_bg.wasm', import.meta.url),
  points: new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url),
  // Bundlers look for this very expression.
  worker: () => new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'veronese' }),
});
