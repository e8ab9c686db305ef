// For a bundler that copies files it is told of: the modules by their addresses.

import { fitMotions, init, initPoints, segmentPair } from 'veronese';
import address from 'veronese/veronese_bg.wasm';
import pointsAddress from 'veronese/veronese_points_bg.wasm';
import { first, second } from './frames.js';
import { measurements } from './measurements.js';
import { report } from './report.js';

async function main() {
  await init(new URL(address, import.meta.url));
  await initPoints(new URL(pointsAddress, import.meta.url));
  return { direct: report(await segmentPair(first, second)), fits: [report(await fitMotions(measurements))] };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
