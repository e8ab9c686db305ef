// Pairs in Node, through a pool that stays.

import assert from 'node:assert/strict';
import { SegmenterPool } from '../../../pkg/dist/node.js';
import { flatMemory, hashOf, sameAsBefore } from './checks.mjs';
import { OPTIONS, REFERENCE, pairOf } from './frames.mjs';

const BATCH = 50;

/** Yields how many are done, and the memory, after each batch. */
export async function* pairs({ from, total, references, jobs }) {
  const pool = new SegmenterPool({ jobs });
  const memory = flatMemory();
  try {
    for (let done = from; done < total; ) {
      const count = Math.min(BATCH, total - done);
      await batch(pool, done, count, references);
      done += count;
      sameAsBefore(references, 'pairs', hashOf(await pool.segmentPair(...Object.values(pairOf(REFERENCE)).slice(0, 2), OPTIONS)));
      yield { done, note: memory(process.memoryUsage().rss) };
    }
  } finally {
    pool.close();
  }
}

async function batch(pool, start, count, references) {
  function* inputs() {
    for (let k = start; k < start + count; k += 1) yield pairOf(k);
  }
  let answered = 0;
  for await (const { input, segmentation, error } of pool.segmentPairs(inputs(), OPTIONS)) {
    assert.equal(error, undefined, `pair ${input.number}: ${error?.message}`);
    if (input.number === REFERENCE) sameAsBefore(references, 'pairs', hashOf(segmentation));
    answered += 1;
  }
  assert.equal(answered, count, 'every pair is answered');
}
