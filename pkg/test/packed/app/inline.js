// For a bundler that knows nothing of files beside the code: the modules inside, the worker as an entry of its own.

import { fitMotions, Segmenter, segmentPair } from 'veronese/inline';
import { first, second } from './frames.js';
import { measurements } from './measurements.js';
import { report } from './report.js';

async function main() {
  const direct = report(await segmentPair(first, second));
  const segmenter = new Segmenter(undefined, { worker: () => new Worker('/worker.js', { type: 'module' }) });
  const inWorker = report(await segmenter.segmentPair(first, second));
  const fits = [report(await fitMotions(measurements)), report(await segmenter.fitMotions(measurements))];
  segmenter.close();
  return { direct, inWorker, fits };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
