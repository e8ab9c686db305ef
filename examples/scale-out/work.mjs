// Does jobs until it is told to end (Ctrl-C: what is under way is finished first).
//
// node work.mjs [--jobs N] [--lock 30000]

import { availableParallelism } from 'node:os';
import { parseArgs } from 'node:util';
import { Worker } from 'bullmq';
import { SegmenterPool } from 'veronese';
import { performClip } from './clip.mjs';
import { connect } from './connection.mjs';
import { perform, QUEUE } from './job.mjs';

const { values } = parseArgs({ options: { jobs: { type: 'string' }, lock: { type: 'string', default: '30000' } } });
const jobs = Number(values.jobs ?? availableParallelism());
// A worker that was killed no longer renews its locks: after so many milliseconds another takes its jobs.
const lock = Number(values.lock);

const connection = connect();
const pool = new SegmenterPool({ jobs });
const worker = new Worker(QUEUE, ({ name, data }) => (name === 'clip' ? performClip(pool, data) : perform(pool, data)), {
  connection,
  concurrency: jobs,
  lockDuration: lock,
  stalledInterval: lock,
  // A killed machine is not the job's fault.
  maxStalledCount: 100,
  removeOnComplete: { count: 0 },
  removeOnFail: { count: 1000 },
});
worker.on('completed', ({ name, data: { index } }, done) => console.log(JSON.stringify(name === 'clip' ? { clip: index, ...done } : { index, did: done })));
worker.on('failed', (job, error) => console.error(`${job?.data.first ?? job?.data.folder}: ${error.message}`));
worker.on('error', () => undefined); // The connection speaks for itself.

let ending = false;
for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, async () => {
    if (ending) process.exit(130);
    ending = true;
    await worker.close();
    pool.close();
    await connection.quit().catch(() => undefined);
  });
}
