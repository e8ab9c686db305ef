// Makes a job of each folder of frames whose result is not there yet.
//
// node produce-clips.mjs FOLDER… --out DIR [--quality fast|best]

import { mkdir, rename, writeFile } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { Queue } from 'bullmq';
import { clipJobOf, clipResultOf } from './clip.mjs';
import { connect } from './connection.mjs';
import { QUEUE } from './job.mjs';

const text = { type: 'string' };
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { out: text, quality: { ...text, default: 'best' } },
});
if (positionals.length === 0 || !values.out) {
  console.error('node produce-clips.mjs FOLDER… --out DIR [--quality fast|best]');
  process.exit(2);
}
const out = resolve(values.out);
const options = { quality: values.quality };

await mkdir(out, { recursive: true });
const connection = connect();
const queue = new Queue(QUEUE, { connection });
const [lines, counts] = [[], { clips: positionals.length, added: 0, done: 0 }];
for (const [index, name] of positionals.entries()) {
  const folder = resolve(name);
  const job = await clipJobOf(folder, options);
  lines.push(JSON.stringify({ index, folder, job }));
  if (await clipResultOf(out, job)) counts.done += 1;
  else {
    await queue.add('clip', { index, folder, job, out, options }, { jobId: job, attempts: 5, backoff: { type: 'exponential', delay: 1000 } });
    counts.added += 1;
  }
}
// Which job each clip is.
await writeFile(join(out, 'clips.jsonl.part'), `${lines.join('\n')}\n`);
await rename(join(out, 'clips.jsonl.part'), join(out, 'clips.jsonl'));
console.log(JSON.stringify(counts));
await queue.close();
await connection.quit();
