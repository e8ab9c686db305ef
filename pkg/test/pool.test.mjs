import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { segmentPair, segmentPairs, Segmenter, SegmenterPool, VeroneseError } from 'veronese';
import { frame, pair } from './support/frames.mjs';
import { all, failure, timeless } from './support/shapes.mjs';
import { stuckWorker } from './support/stopping.mjs';

const FILE = new URL('../dist/worker-node.js', import.meta.url);
const SIZE = { width: 64, height: 48 };

/** A pair whose square moves by (x, 1), with its number beside it. */
function input(number) {
  const [first, second] = pair({ ...SIZE, square: [number % 4, 1] });
  return { first, second, number };
}

/** A pool that ends with the test. */
function pool(t, options) {
  const made = new SegmenterPool(options);
  t.after(() => made.close());
  return made;
}

describe('SegmenterPool', () => {
  test('is a Segmenter with as many workers as there are calls, and not more than jobs', async (t) => {
    let started = 0;
    const worker = () => {
      started += 1;
      return new Worker(FILE);
    };
    const two = pool(t, { jobs: 2, worker });
    assert.ok(two instanceof Segmenter);
    assert.equal(two.jobs, 2);
    await two.segmentPair(...pair());
    assert.equal(started, 1, 'one call, one worker');
    await Promise.all(Array.from({ length: 5 }, () => two.segmentPair(...pair())));
    assert.equal(started, 2);
  });

  test('compiles the module once for all workers', async (t) => {
    const { compile } = WebAssembly;
    let compiled = 0;
    t.mock.method(WebAssembly, 'compile', (bytes) => {
      compiled += 1;
      return compile(bytes);
    });
    const three = pool(t, { jobs: 3 });
    await Promise.all(Array.from({ length: 6 }, () => three.segmentPair(...pair())));
    assert.equal(compiled, 1);
  });

  test('a cancelled call leaves the others alone', { timeout: 120_000 }, async (t) => {
    let workers = 0;
    // The first call would never end.
    const two = pool(t, { jobs: 2, worker: () => (workers++ === 0 ? stuckWorker() : new Worker(FILE)) });
    const controller = new AbortController();
    const others = [];
    const begin = () => others.push(...Array.from({ length: 4 }, () => two.segmentPair(...pair())));
    const onProgress = () => {
      begin();
      controller.abort('enough');
    };
    const error = await failure(two.segmentPair(...pair(), { signal: controller.signal, onProgress }));
    assert.equal(error.code, 'cancelled');
    assert.equal(others.length, 4);
    for (const other of others) assert.equal((await other).width, 64);
  });
});

describe('segmentPairs', () => {
  test('gives the direct results in the order of the pairs, with what came in', async () => {
    const inputs = Array.from({ length: 9 }, (_, number) => input(number));
    const outcomes = await all(segmentPairs(inputs, { jobs: 3, motions: 2 }));
    assert.deepEqual(outcomes.map(({ index }) => index), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    for (const [index, outcome] of outcomes.entries()) {
      assert.equal(outcome.input, inputs[index]);
      const { first, second } = inputs[index];
      assert.deepEqual(timeless(outcome.segmentation), timeless(await segmentPair(first, second, { motions: 2 })));
    }
  });

  test('takes pairs only when there is room: at most two for each worker, however slow the reader', async (t) => {
    let taken = 0;
    let returned = false;
    async function* source() {
      try {
        for (;;) yield input(taken++);
      } finally {
        returned = true;
      }
    }
    let read = 0;
    const two = pool(t, { jobs: 2 });
    for await (const { segmentation } of two.segmentPairs(source())) {
      assert.equal(segmentation.width, 64);
      read += 1;
      // Calls are worked on in their order: meanwhile those before these have begun.
      await Promise.all([two.segmentPair(...pair()), two.segmentPair(...pair())]);
      assert.ok(taken - read <= 4, `${taken} taken, ${read} read`);
      if (read === 6) break;
    }
    assert.ok(returned, 'leaving the loop ends the source');
  });

  test('one bad pair is an outcome with an error, the rest goes on', async () => {
    const bad = [{ first: frame(0), second: frame(1, { width: 70 }) }, {}, undefined, { first: frame(0) }];
    const inputs = [input(0), ...bad, input(1)];
    const outcomes = await all(segmentPairs(inputs, { jobs: 2 }));
    assert.deepEqual(
      outcomes.map(({ error }) => error?.code),
      [undefined, 'frame-size-mismatch', 'invalid-input', 'invalid-input', 'invalid-input', undefined],
    );
    assert.ok(outcomes[1].error instanceof VeroneseError);
    assert.equal(outcomes[5].segmentation.width, 64);
  });

  test('reports progress with the number of the pair, and takes promises of pairs', async () => {
    const seen = new Map();
    const onProgress = ({ pair }) => seen.set(pair, (seen.get(pair) ?? 0) + 1);
    await all(segmentPairs([input(0), Promise.resolve(input(1)), input(2)], { jobs: 2, onProgress }));
    assert.deepEqual([...seen.keys()].sort(), [0, 1, 2]);
    assert.equal(new Set(seen.values()).size, 1, 'as many stages each');
    assert.deepEqual(await all(segmentPairs([])), []);
  });
});
