// Thousands of calls take no more memory than the first ones, and give the same answer to the same question.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { SegmenterPool, segmentPair, segmentStream } from 'veronese';
import { frame, pair } from './support/frames.mjs';
import { all, timeless } from './support/shapes.mjs';
import { soaking } from './support/soak.mjs';

const [PAIRS, FRAMES] = [2000, 2000];
const SIZE = { width: 320, height: 240 };
const OPTIONS = { quality: 'fast' };
/** Calls between two looks at the memory. */
const BATCH = 50;
/** Looks until which it may grow: modules are compiled, and heaps find their size. */
const SETTLING = 8;
const LEEWAY = { share: 0.25, bytes: 2 ** 26 };

/** Throws once the memory of this process has grown after it had settled. */
function flatMemory() {
  const seen = [];
  return () => {
    seen.push(process.memoryUsage().rss);
    const settled = Math.max(...seen.slice(0, SETTLING));
    assert.ok(seen.at(-1) <= settled * (1 + LEEWAY.share) + LEEWAY.bytes, `from ${settled} to ${seen.at(-1)} bytes in ${seen.length} looks`);
  };
}

describe('in the long run', { skip: !soaking && 'npm run soak -- package' }, () => {
  test('pairs in a pool', async (t) => {
    const pool = new SegmenterPool({ jobs: 2 });
    t.after(() => pool.close());
    // Speeds repeat after 13 × 11 × 7 pairs.
    const pairOf = (k) => pair({ ...SIZE, background: [((k % 7) - 3) / 4, 0.25], square: [(k % 13) - 6, ((k % 11) - 5) / 2] });
    function* inputs() {
      for (let k = 0; k < PAIRS; k += 1) {
        const [first, second] = pairOf(k);
        yield { first, second };
      }
    }
    const expected = timeless(await segmentPair(...pairOf(1), OPTIONS));
    const checkMemory = flatMemory();
    let answered = 0;
    for await (const { error } of pool.segmentPairs(inputs(), OPTIONS)) {
      assert.equal(error, undefined);
      answered += 1;
      if (answered % BATCH > 0) continue;
      assert.deepEqual(timeless(await pool.segmentPair(...pairOf(1), OPTIONS)), expected);
      checkMemory();
    }
    assert.equal(answered, PAIRS);
  });

  test('the frames of a stream', async () => {
    // The square goes to and fro.
    const frameAt = (k) => frame(k % 80 < 40 ? k % 80 : 80 - (k % 80), { ...SIZE, square: [2.5, 1] });
    function* frames() {
      for (let k = 0; k < FRAMES; k += 1) yield frameAt(k);
    }
    const short = () => all(segmentStream([0, 1, 2, 3].map(frameAt), OPTIONS));
    const expected = await short();
    const checkMemory = flatMemory();
    let answered = 0;
    for await (const { index, objects } of segmentStream(frames(), { ...OPTIONS, lookAhead: 2 })) {
      assert.equal(index, answered++);
      assert.ok(objects.length < 20, `${objects.length} objects in frame ${index}, where one square moves`);
      if (answered % BATCH > 0) continue;
      assert.deepEqual(await short(), expected);
      checkMemory();
    }
    assert.equal(answered, FRAMES);
  });
});
