// The entry for Node.

import { availableParallelism } from 'node:os';
import { Worker } from 'node:worker_threads';
import type { FrameFile } from '../../types/index.js';
import { isPicture, placesBy } from '../calls/places.js';
import { packageFor } from './package.js';
import { read } from './reading.js';

export { davisPalette, groupLabels, VeroneseError, version } from './package.js';

export const { init, initPoints, segmentPair, openClip, segmentStream, solvePair, fitMotions, Segmenter, SegmenterPool, segmentPairs } =
  packageFor({
    read,
    frames: new URL('../wasm/veronese_bg.wasm', import.meta.url),
    points: new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url),
    worker: () => new Worker(new URL('./worker-node.js', import.meta.url), { name: 'veronese' }),
    jobs: availableParallelism,
    journal: async (name) => (await import('./journal-file.js')).openFile(name),
    // With a module of its own, which only files need.
    places: placesBy(isFile, async (place, maxSize) => (await import('./frame-files.js')).decodeFile(place, maxSize)),
  });

/** A path, an address, a file in memory, or a stream of bytes. */
function isFile(frame: unknown): frame is FrameFile {
  if (typeof frame === 'string') return frame !== '';
  try {
    if (isPicture(frame) && 'arrayBuffer' in frame) return true;
    return frame instanceof URL || typeof (Object(frame) as Partial<AsyncIterable<unknown>>)[Symbol.asyncIterator] === 'function';
  } catch {
    return false; // A revoked proxy, which whoever takes it refuses.
  }
}
