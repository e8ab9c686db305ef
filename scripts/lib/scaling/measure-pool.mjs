// node measure-pool.mjs FOLDER QUALITY WORKERS: seconds that a pool of so many workers takes for a clip, from its start to its last labels, and
// processor seconds, as JSON.

import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';

import { decodeImage } from '../../../pkg/dist/codecs.js';
import { SegmenterPool } from '../../../pkg/dist/node.js';

const [folder, quality, workers] = process.argv.slice(2);
const names = (await readdir(folder)).toSorted();
const pool = new SegmenterPool({ jobs: Number(workers) });
const [since, before] = [performance.now(), process.cpuUsage()];
const read = async (k) => decodeImage(await readFile(join(folder, names[k])));
let frames = 0;
for await (const _ of pool.segmentClip({ length: names.length, read }, { quality })) frames += 1;
if (frames !== names.length) throw new Error(`${frames} of ${names.length} frames`);
const seconds = (performance.now() - since) / 1000;
const { user, system } = process.cpuUsage(before);
process.stdout.write(JSON.stringify({ seconds: Number(seconds.toPrecision(3)), busy: Number(((user + system) / 1e6).toPrecision(3)) }));
pool.close();
