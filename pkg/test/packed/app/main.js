// The calls of a page: a direct call, one in a worker, a pool; measurements. Bundled or served as it is.

import { fitMotions, Segmenter, segmentPair, segmentPairs } from 'veronese';
import { first, second } from './frames.js';
import { measurements } from './measurements.js';
import { report } from './report.js';

async function main() {
  const direct = report(await segmentPair(first, second));
  const segmenter = new Segmenter();
  const inWorker = report(await segmenter.segmentPair(first, second));
  const fits = [report(await fitMotions(measurements)), report(await segmenter.fitMotions(measurements))];
  segmenter.close();
  const pooled = [];
  for await (const { segmentation } of segmentPairs([{ first, second }, { first, second }], { jobs: 2 })) pooled.push(report(segmentation));
  return { direct, inWorker, pooled, fits };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
