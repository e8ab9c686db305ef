// One run of `npm run bench:first` in Node.

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

import { Segmenter } from '../pkg/dist/node.js';
import { firstCalls, pairOf } from './first-call.js';

const [task, folder] = process.argv.slice(2);
const { size, ...rest } = JSON.parse(task);
const pair = await pairOf(size, async (name) => new Uint8Array(await readFile(join(folder, name))));
console.log(JSON.stringify(await firstCalls(Segmenter, pair, rest)));
