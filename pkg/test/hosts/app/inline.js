// For a bundler that knows nothing of files beside the code: the module inside, the worker as an entry of its own.

import { Segmenter, segmentPair } from 'veronese/inline';
import { first, second } from './frames.js';
import { report } from './report.js';

async function main() {
  const direct = report(await segmentPair(first, second));
  const segmenter = new Segmenter(undefined, { worker: () => new Worker('/worker.js', { type: 'module' }) });
  const inWorker = report(await segmenter.segmentPair(first, second));
  segmenter.close();
  return { direct, inWorker };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
