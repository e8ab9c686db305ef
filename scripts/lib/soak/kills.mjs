// Worker threads that are ended from outside while they work: their call is rejected, and every other answer is right.

import assert from 'node:assert/strict';
import { setTimeout as sleep } from 'node:timers/promises';
import { Worker } from 'node:worker_threads';
import { SegmenterPool, segmentPair } from '../../../pkg/dist/node.js';
import { random } from '../random.mjs';
import { flatMemory, hashOf, sameAsBefore } from './checks.mjs';
import { OPTIONS, REFERENCE, pairOf } from './frames.mjs';

/** Pairs between which one worker is killed. */
const BATCH = 8;
/** A kill comes within this time after a batch has begun, milliseconds. */
const LATEST = 600;

const frames = (number) => Object.values(pairOf(number)).slice(0, 2);

/** Yields how many kills are done after each. */
export async function* kills({ from, total, references, jobs, seed }) {
  const alive = new Set();
  const worker = () => {
    const made = new Worker(new URL('../../../pkg/dist/worker-node.js', import.meta.url));
    alive.add(made);
    made.once('exit', () => alive.delete(made));
    return made;
  };
  const pool = new SegmenterPool({ jobs, worker });
  const memory = flatMemory();
  const right = new Map();
  for (let k = 0; k < BATCH; k += 1) right.set(k, hashOf(await segmentPair(...frames(k), OPTIONS)));
  let rejected = 0;
  try {
    for (let done = from; done < total; done += 1) {
      const next = random(seed + done);
      const calls = Array.from({ length: BATCH }, (_, k) => pool.segmentPair(...frames(k), OPTIONS));
      const outcomes = Promise.allSettled(calls);
      await sleep(LATEST * next());
      const list = [...alive];
      const killed = list[Math.floor(next() * list.length)];
      if (killed) await killed.terminate();
      const failed = [];
      for (const [k, { value, reason }] of (await outcomes).entries()) {
        if (reason) failed.push(reason);
        else assert.equal(hashOf(value), right.get(k), `pair ${k} after ${done + 1} kills`);
      }
      assert.ok(failed.length <= 1, `${failed.length} calls were rejected for one worker`);
      for (const { name, code } of failed) assert.deepEqual([name, code], ['VeroneseError', 'worker-failed']);
      rejected += failed.length;
      sameAsBefore(references, 'pairs', hashOf(await pool.segmentPair(...frames(REFERENCE), OPTIONS)));
      yield { done: done + 1, note: `${memory(process.memoryUsage().rss)}, ${rejected} calls rejected` };
    }
  } finally {
    pool.close();
  }
}
