// For Node, Deno and Bun: a direct call and one in a worker.

import { Segmenter, segmentPair } from 'veronese';
import { first, second } from './frames.js';
import { labelHash } from './label-hash.js';

const segmenter = new Segmenter();
const hashes = [await labelHash(await segmentPair(first, second)), await labelHash(await segmenter.segmentPair(first, second))];
segmenter.close();
const { deno, bun, node } = process.versions;
console.log([deno ? `Deno ${deno}` : bun ? `Bun ${bun}` : `Node ${node}`, ...hashes].join('\n'));
