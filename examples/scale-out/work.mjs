// Does jobs until it is interrupted (Ctrl-C: a job under way is finished first).
//
// node work.mjs [--jobs N] [--lock 30000]

import { availableParallelism } from 'node:os';
import { parseArgs } from 'node:util';
import { Worker } from 'bullmq';
import { Segmenter } from 'veronese';
import { performBlock } from './block.mjs';
import { performClip } from './clip.mjs';
import { connect } from './connection.mjs';
import { perform, QUEUE } from './job.mjs';

const { values } = parseArgs({ options: { jobs: { type: 'string' }, lock: { type: 'string', default: '30000' } } });
const jobs = Number(values.jobs ?? availableParallelism());
// A worker that was killed no longer renews its locks: after so many milliseconds another takes its jobs.
const lock = Number(values.lock);

const connection = connect();
// Each job under way has a worker of its own. The workers of a pool would help one job while the next one waits for them, and a kill would
// cost as many jobs.
const idle = Array.from({ length: jobs }, () => new Segmenter());
const kinds = { pair: perform, block: performBlock, clip: performClip };
const work = async ({ name, data }) => {
  const segmenter = idle.pop();
  try {
    return await kinds[name](segmenter, data);
  } finally {
    idle.push(segmenter);
  }
};
const worker = new Worker(QUEUE, work, {
  connection,
  concurrency: jobs,
  lockDuration: lock,
  stalledInterval: lock,
  // A killed machine is not the job's fault.
  maxStalledCount: 100,
  removeOnComplete: { count: 0 },
  removeOnFail: { count: 1000 },
});
worker.on('completed', ({ name, data: { index, from } }, done) => {
  console.log(JSON.stringify(name === 'pair' ? { index, did: done } : { clip: index, block: from, ...done }));
});
worker.on('failed', (job, error) => console.error(`${job?.data.first ?? job?.data.folder}: ${error.message}`));
worker.on('error', () => undefined); // The connection speaks for itself.

let ending = false;
for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, async () => {
    if (ending) process.exit(130);
    ending = true;
    await worker.close();
    for (const segmenter of idle) segmenter.close();
    await connection.quit().catch(() => undefined);
  });
}
