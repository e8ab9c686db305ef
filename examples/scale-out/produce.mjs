// Makes the jobs: every pair of consecutive frames of a folder whose result is not there yet.
//
// node produce.mjs FOLDER --out DIR [--quality fast|best] [--ahead 10000]

import { createReadStream, createWriteStream } from 'node:fs';
import { mkdir, readdir, rename } from 'node:fs/promises';
import { createHash } from 'node:crypto';
import { join, resolve } from 'node:path';
import { pipeline } from 'node:stream/promises';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';
import { Queue } from 'bullmq';
import { connect } from './connection.mjs';
import { jobOf, QUEUE, resultOf } from './job.mjs';

/** Jobs that are added in one request. */
const CHUNK = 500;

const text = { type: 'string' };
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { out: text, quality: { ...text, default: 'best' }, ahead: { ...text, default: '10000' } },
});
if (positionals.length !== 1 || !values.out) {
  console.error('node produce.mjs FOLDER --out DIR [--quality fast|best] [--ahead 10000]');
  process.exit(2);
}
const folder = resolve(positionals[0]);
const out = resolve(values.out);
const options = { quality: values.quality };

const frames = (await readdir(folder)).filter((name) => /\.(png|jpe?g|webp|bmp|p[bgpn]m)$/i.test(name)).sort();
await mkdir(out, { recursive: true });
const connection = connect();
const queue = new Queue(QUEUE, { connection });

// Which job each pair is: what the collector goes by. Equal pairs are one job.
const manifest = createWriteStream(join(out, 'pairs.jsonl.part'));
let [added, done, chunk, first] = [0, 0, [], undefined];
for (const [position, name] of frames.entries()) {
  const second = { path: join(folder, name), hash: await hashOf(join(folder, name)) };
  if (first) {
    const job = jobOf([first.hash, second.hash], options);
    const pair = { index: position - 1, first: first.path, second: second.path, job };
    if (!manifest.write(`${JSON.stringify(pair)}\n`)) await new Promise((resume) => manifest.once('drain', resume));
    if (await resultOf(out, job)) done += 1;
    else
      chunk.push({
        name: 'pair',
        data: { ...pair, out, options },
        opts: { jobId: job, attempts: 5, backoff: { type: 'exponential', delay: 1000 } },
      });
    if (chunk.length >= CHUNK) await flush();
  }
  first = second;
}
await flush();
await new Promise((closed) => manifest.end(closed));
await rename(join(out, 'pairs.jsonl.part'), join(out, 'pairs.jsonl'));
console.log(JSON.stringify({ pairs: Math.max(0, frames.length - 1), added, done }));
await queue.close();
await connection.quit();

/** Adds what was gathered when the workers have got near enough, so that the queue's memory has a bound. */
async function flush() {
  while ((await queue.getWaitingCount()) > Number(values.ahead)) await sleep(500);
  // A job that is there already, waiting or under way, is left alone; finished ones are not kept.
  await queue.addBulk(chunk);
  added += chunk.length;
  chunk = [];
}

async function hashOf(path) {
  const hash = createHash('sha256');
  await pipeline(createReadStream(path), hash);
  return hash.digest('hex');
}
