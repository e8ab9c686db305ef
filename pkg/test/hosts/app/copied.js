// For a bundler that copies files it is told of: the module by its address.

import { init, segmentPair } from 'veronese';
import address from 'veronese/veronese_bg.wasm';
import { first, second } from './frames.js';
import { report } from './report.js';

async function main() {
  await init(new URL(address, import.meta.url));
  return { direct: report(await segmentPair(first, second)) };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
