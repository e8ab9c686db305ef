// The entry for browsers, workers and bundlers.

import { packageFor } from './package.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

const frames = new URL('../wasm/veronese_bg.wasm', import.meta.url);

/**
 * Whether the package lies on another origin, such as a CDN's, from where browsers start no worker. Not told by `import.meta.url`, which
 * webpack replaces with a path of the machine that it runs on; and only where files have their own names, because a bundler's worker has
 * another one.
 */
function isAfar(): boolean {
  return /^http.*\/wasm\/veronese_bg\.wasm$/.test(frames.href) && frames.origin !== globalThis.origin;
}

/** A worker of the page's own origin, which imports the file and then forgets its address. */
function workerFromAfar(): Worker {
  const text = `import "${new URL('../dist/worker.js', frames).href}";URL.revokeObjectURL(location)`;
  return new Worker(URL.createObjectURL(new Blob([text], { type: 'text/javascript' })), { type: 'module', name: 'veronese' });
}

export const { init, initPoints, segmentPair, openClip, segmentStream, solvePair, fitMotions, Segmenter, SegmenterPool, segmentPairs } =
  packageFor({
    frames,
    points: new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url),
    // Bundlers look for this very expression.
    worker: () => (isAfar() ? workerFromAfar() : new Worker(new URL('./worker.js', import.meta.url), { type: 'module', name: 'veronese' })),
  });
