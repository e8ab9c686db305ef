// How far it is, and what came out.
//
// node status.mjs --out DIR              counts, as JSON
// node status.mjs --out DIR --collect    writes DIR/results.jsonl, one line for each pair in their order; exit 1 while some are missing

import { createReadStream, createWriteStream, existsSync } from 'node:fs';
import { rename } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { parseArgs } from 'node:util';
import { Queue } from 'bullmq';
import { clipResultOf } from './clip.mjs';
import { connect } from './connection.mjs';
import { QUEUE, resultOf } from './job.mjs';

const { values } = parseArgs({ options: { out: { type: 'string' }, collect: { type: 'boolean', default: false } } });
if (!values.out) {
  console.error('node status.mjs --out DIR [--collect]');
  process.exit(2);
}
const out = resolve(values.out);
const lines = values.collect ? createWriteStream(join(out, 'results.jsonl.part')) : undefined;
const counts = { pairs: 0, done: 0, failed: 0, missing: 0 };
for await (const pair of listed('pairs.jsonl')) {
  const result = await resultOf(out, pair.job);
  counts.pairs += 1;
  counts[stateOf(result)] += 1;
  if (result && lines && !lines.write(`${JSON.stringify({ ...pair, ...result })}\n`))
    await new Promise((resume) => lines.once('drain', resume));
}
if (lines) {
  await new Promise((closed) => lines.end(closed));
  await rename(join(out, 'results.jsonl.part'), join(out, 'results.jsonl'));
}
if (!values.collect) {
  counts.clips = { clips: 0, done: 0, failed: 0, missing: 0 };
  for await (const { job } of listed('clips.jsonl')) {
    counts.clips.clips += 1;
    counts.clips[stateOf(await clipResultOf(out, job))] += 1;
  }
  const connection = connect();
  const queue = new Queue(QUEUE, { connection });
  counts.queue = await queue.getJobCounts('waiting', 'waiting-children', 'active', 'delayed', 'failed');
  await queue.close();
  await connection.quit();
}
console.log(JSON.stringify(counts));
process.exitCode = values.collect && counts.missing > 0 ? 1 : 0;

/** The jobs that a producer has listed, if it has run. */
async function* listed(name) {
  if (!existsSync(join(out, name))) return;
  for await (const line of createInterface({ input: createReadStream(join(out, name)) })) yield JSON.parse(line);
}

function stateOf(result) {
  if (!result) return 'missing';
  return result.error ? 'failed' : 'done';
}
