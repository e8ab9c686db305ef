// Makes jobs of each folder of frames whose result is not there yet: one for each block of its pairs, and one that puts the clip together
// when those have ended.
//
// node produce-clips.mjs FOLDER… --out DIR [--quality fast|best] [--block 16] [--ahead 10000]
// node produce-clips.mjs --list FILE …     the same of the folders that a file names, one a line

import { createReadStream, createWriteStream } from 'node:fs';
import { mkdir, rename } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';
import { FlowProducer, Queue } from 'bullmq';
import { blockJobOf, missingBlocks } from './block.mjs';
import { clipJobOf, clipResultOf, framesOf, hashesOf } from './clip.mjs';
import { connect } from './connection.mjs';
import { QUEUE } from './job.mjs';

const text = { type: 'string' };
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    out: text,
    list: text,
    quality: { ...text, default: 'best' },
    block: { ...text, default: '16' },
    ahead: { ...text, default: '10000' },
  },
});
const size = Number(values.block);
if ((positionals.length === 0) === !values.list || !values.out || !(size >= 1)) {
  console.error('node produce-clips.mjs (FOLDER… | --list FILE) --out DIR [--quality fast|best] [--block PAIRS] [--ahead 10000]');
  process.exit(2);
}
const out = resolve(values.out);
const options = { quality: values.quality };
const retried = { attempts: 5, backoff: { type: 'exponential', delay: 1000 } };

await mkdir(out, { recursive: true });
const connection = connect();
const queue = new Queue(QUEUE, { connection });
const flows = new FlowProducer({ connection });

// Which job each clip is.
const manifest = createWriteStream(join(out, 'clips.jsonl.part'));
const counts = { clips: 0, done: 0, queued: 0, added: 0, blocks: 0 };
for await (const name of values.list ? createInterface({ input: createReadStream(values.list) }) : positionals) {
  const [index, folder] = [counts.clips++, resolve(name)];
  const hashes = await hashesOf(folder, await framesOf(folder));
  const job = clipJobOf(hashes, options);
  if (!manifest.write(`${JSON.stringify({ index, folder, job })}\n`)) await new Promise((resume) => manifest.once('drain', resume));
  if (await clipResultOf(out, job)) counts.done += 1;
  else if (await isQueued(job)) counts.queued += 1;
  else await add({ index, folder, job, out, options }, hashes);
}
await new Promise((closed) => manifest.end(closed));
await rename(join(out, 'clips.jsonl.part'), join(out, 'clips.jsonl'));
console.log(JSON.stringify(counts));
await flows.close();
await queue.close();
await connection.quit();

/** Whether a clip's job waits or is under way. One that has failed for good is taken out, to be tried again. */
async function isQueued(job) {
  const there = await queue.getJob(job);
  if (!there) return false;
  if (!(await there.isFailed())) return true;
  await there.remove();
  return false;
}

async function add(clip, hashes) {
  // The queue's memory has a bound.
  while ((await queue.getWaitingCount()) > Number(values.ahead)) await sleep(500);
  const missing = await missingBlocks(out, clip.job, hashes.length, size);
  const children = missing.map(({ from, to }) => {
    const job = blockJobOf(clip.job, hashes.slice(from, to + 1));
    const { index, folder } = clip;
    // The clip's job does not wait for a block that has failed for good, and solves its pairs. None is kept under a name that may come again:
    // a clip that is added later would wait for it.
    const gone = { removeOnComplete: true, removeOnFail: true, removeDependencyOnFailure: true };
    return {
      name: 'block',
      queueName: QUEUE,
      data: { index, job, clip: clip.job, folder, from, to, out, options },
      opts: { jobId: job, ...retried, ...gone },
    };
  });
  // A single block would only make the clip wait.
  const blocks = children.length > 1 ? children : [];
  await flows.add({ name: 'clip', queueName: QUEUE, data: clip, opts: { jobId: clip.job, ...retried }, children: blocks });
  counts.added += 1;
  counts.blocks += blocks.length;
}
