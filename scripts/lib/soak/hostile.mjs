// Calls at random with values that do not belong there: each works or is refused with a published code, the same directly and in a worker.

import assert from 'node:assert/strict';
import { inspect, isDeepStrictEqual } from 'node:util';
import { Segmenter, segmentPair } from '../../../pkg/dist/node.js';
import * as direct from '../../../pkg/dist/node.js';
import { outcomeOf, randomCall } from '../../../pkg/test/support/hostile.mjs';
import { random } from '../random.mjs';
import { flatMemory, hashOf, sameAsBefore } from './checks.mjs';
import { OPTIONS, REFERENCE, pairOf } from './frames.mjs';

const BATCH = 100;

/** Yields how many calls are done after each batch. The call of a number is the same for the same seed. */
export async function* hostile({ from, total, references, seed }) {
  const segmenter = new Segmenter();
  const memory = flatMemory();
  let refused = 0;
  try {
    for (let done = from; done < total; ) {
      const call = randomCall(random(seed * 1_000_003 + done));
      const where = `call ${done} of seed ${seed}: ${call.place}: ${call.words}`;
      try {
        const here = await outcomeOf(direct, call);
        const there = await outcomeOf(segmenter, call);
        assert.ok(isDeepStrictEqual(there, here), `in a worker: ${inspect(there)}, directly: ${inspect(here)}`);
        if (here.code !== undefined) refused += 1;
      } catch (error) {
        throw new Error(`${where}: ${error.message}`, { cause: error });
      }
      done += 1;
      if (done % BATCH !== 0 && done !== total) continue;
      const { first, second } = pairOf(REFERENCE);
      for (const answer of [segmentPair, segmenter.segmentPair.bind(segmenter)]) sameAsBefore(references, 'pairs', hashOf(await answer(first, second, OPTIONS)));
      yield { done, note: `${memory(process.memoryUsage().rss)}, ${refused} of ${done - from} refused` };
    }
  } finally {
    segmenter.close();
  }
}
