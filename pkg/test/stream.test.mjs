// Streams: clips whose frames come once, directly and in workers.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { setImmediate, setTimeout } from 'node:timers/promises';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { Worker } from 'node:worker_threads';
import { segmentPair, segmentStream, Segmenter, SegmenterPool, VeroneseError } from 'veronese';
import { streamOf } from '../build/calls/stream.js';
import { frame, pair } from './support/frames.mjs';
import { all, checkMatrix, failure, timeless, until } from './support/shapes.mjs';

const COUNT = 7;
const SIZE = { width: 64, height: 48 };
const FAST = { quality: 'fast', lookAhead: 1 };

/** A short clip of a square that moves over a static background. */
const frames = (count = COUNT) => Array.from({ length: count }, (_, k) => frame(k / 2, SIZE));

/** A segmenter that ends with the test and counts its workers. */
function segmenter(t) {
  const counted = { started: 0, workers: [] };
  const worker = () => {
    const made = new Worker(new URL('../dist/worker-node.js', import.meta.url));
    counted.started += 1;
    counted.workers.push(made);
    return made;
  };
  counted.segmenter = new Segmenter(undefined, { worker });
  t.after(() => counted.segmenter.close());
  return counted;
}

/** A signal that is aborted after some milliseconds, which the process waits for. */
function after(milliseconds) {
  const controller = new AbortController();
  void setTimeout(milliseconds).then(() => controller.abort());
  return controller.signal;
}

/** A source that counts what is taken from it and knows whether it was closed. */
function source(list) {
  const taken = { count: 0, closed: false };
  taken.frames = (function* () {
    try {
      for (const one of list) {
        taken.count += 1;
        yield one;
      }
    } finally {
      taken.closed = true;
    }
  })();
  return taken;
}

describe('segmentStream', () => {
  test('gives every frame, in order, with objects that fit the labels, and their tracks', async () => {
    const clip = segmentStream(frames(), { quality: 'fast' });
    const given = await all(clip);
    assert.deepEqual(given.map(({ index }) => index), Array.from({ length: COUNT }, (_, k) => k));
    for (const { index, labels, width, height, objects, background } of given) {
      assert.deepEqual({ width, height }, SIZE);
      assert.ok(labels instanceof Uint8Array);
      assert.equal(labels.length, SIZE.width * SIZE.height);
      assert.deepEqual(new Set(labels), new Set([0, ...objects.map(({ id }) => id)]));
      const isInside = index > 0 && index < COUNT - 1;
      if (isInside) checkMatrix(background);
      for (const { id, pixels, bbox: [x, y, w, h], confidence, matrix } of objects) {
        assert.equal(pixels, labels.filter((label) => label === id).length);
        const inside = labels.filter((label, p) => label === id && p % SIZE.width >= x && p % SIZE.width < x + w && Math.floor(p / SIZE.width) >= y && Math.floor(p / SIZE.width) < y + h);
        assert.equal(inside.length, pixels);
        assert.ok(confidence > 0.5 && confidence <= 1);
        if (isInside) checkMatrix(matrix);
      }
    }
    assert.deepEqual(given.map(({ objects }) => objects.map(({ id }) => id)), Array(COUNT).fill([1]), 'the square keeps its number');

    const { objects: [square, ...others], background, dropped } = clip.tracks();
    assert.deepEqual([others, dropped], [[], 0]);
    assert.deepEqual([square.id, square.first, square.last], [1, 0, COUNT - 1]);
    // Nothing moves on from the last frame.
    const seen = given.map(({ index, objects: [{ id: _, ...seen }] }) => ({ frame: index, ...seen, ...(index === COUNT - 1 && { matrix: null }) }));
    assert.deepEqual(square.frames, seen);
    assert.deepEqual(background, given.slice(0, -1).flatMap(({ index, background }) => (background ? [{ frame: index, matrix: background }] : [])));
  });

  test('takes iterables, promises and async iterables; asks for frames only when the reader waits for one, and lets the source reuse its buffer', async () => {
    const expected = await all(segmentStream(frames(), FAST));
    assert.deepEqual(await all(segmentStream(frames().map((one) => Promise.resolve(one)), FAST)), expected);
    assert.deepEqual(await all(segmentStream((async function* () { yield* frames(); })(), FAST)), expected);
    const buffer = frame(0, SIZE);
    const reusing = (function* () { for (const one of frames()) yield (buffer.data.set(one.data), buffer); })();
    assert.deepEqual(await all(segmentStream(reusing, FAST)), expected);
    // It waits for 8 frames unless told otherwise, and one more is read while the last of them is worked on.
    for (const [options, count] of [[{}, 9], [{ lookAhead: 0 }, 1], [{ lookAhead: 2 }, 3]]) {
      const taken = source(frames(12));
      const clip = segmentStream(taken.frames, { quality: 'fast', ...options });
      assert.equal(taken.count, 0);
      await clip.next();
      assert.equal(taken.count, count + 1);
      await all(segmentStream(frames(2), FAST));
      assert.equal(taken.count, count + 1);
      await clip.return();
    }
  });

  test('reads one frame while another is worked on, and waits neither for it nor for more', async () => {
    let asked = 0;
    const silent = (async function* () {
      while (++asked < 3) yield frame(0, SIZE);
      await new Promise(() => {});
    })();
    const work = [];
    const perform = async ({ call }) => {
      if (call === 'pushStream') return new Promise((resolve) => work.push(() => resolve({ index: work.length - 1, objects: [], background: null })));
    };
    const clip = streamOf(silent, { lookAhead: 0 }, () => ({ perform, release() {} }));
    for (const index of [0, 1]) {
      const next = clip.next();
      for (let turn = 0; turn < 50; turn += 1) await setImmediate();
      assert.deepEqual([work.length, asked], [index + 1, index + 2], 'the next frame was asked for, and no other');
      work[index]();
      assert.equal((await next).value.index, index);
    }
    await clip.return();
  });

  test('reports progress, and transfers frames where it is asked to', async () => {
    const [list, progress] = [frames(2), []];
    await all(segmentStream(list, { ...FAST, transfer: true, onProgress: (one) => progress.push(one) }));
    assert.deepEqual(progress, [{ frame: 0 }, { frame: 1 }]);
    assert.deepEqual(list.map(({ data }) => data.length), [0, 0]);
  });

  test('no frames and one frame are no clip, but of a live stream, whose frames are answered as they come', async () => {
    for (const [count, found] of [[0, 'none'], [1, 'one']]) {
      for (const given of [segmentStream(frames(count)), segmentStream(frames(count), { lookAhead: 2 })]) {
        const { given: seen, error } = await until(given);
        assert.deepEqual([seen, error.code, error.message], [[], 'too-few-frames', `a clip needs two frames, found ${found}`]);
      }
      const live = await all(segmentStream(frames(count), { lookAhead: 0 }));
      assert.deepEqual(live.map(({ objects, background }) => [objects, background]), Array(count).fill([[], null]));
    }
  });

  test('a clip whose module was replaced says so, and takes no other clip for its own', async () => {
    const mine = new Error('mine');
    const lost = segmentStream(frames(), FAST);
    await lost.next();
    assert.equal(await failure(segmentPair(...pair(), { onProgress: () => { throw mine; } })), mine);
    const next = segmentStream(frames(), FAST);
    const [first] = [(await next.next()).value];
    const { error } = await until(lost);
    assert.deepEqual([error.code, /lost/.test(error.message)], ['internal', true]);
    assert.deepEqual([first, ...(await all(next))], await all(segmentStream(frames(), FAST)));
  });

  test('a clip whose source throws gives first what there was', async () => {
    const mine = new Error('mine');
    const failing = async function* () {
      yield* frames(3);
      throw mine;
    };
    assert.deepEqual(await until(segmentStream(failing(), FAST)), { given: [0, 1, 2], error: mine });
  });

  test('a clip with a frame that does not fit gives first those before it, and closes its source', async () => {
    const cases = [
      ['frame-size-mismatch', frame(0, { width: 70, height: 48 })],
      ['invalid-input', { ...SIZE, data: 'text' }],
      ['invalid-input', undefined],
      ['frame-size-unsupported', { width: 1, height: 1, data: new Uint8Array(4) }],
      ['pixel-count-mismatch', { ...SIZE, data: new Uint8Array(4) }],
    ];
    for (const [code, bad] of cases) {
      const taken = source([...frames(3), bad, ...frames(3)]);
      const { given, error } = await until(segmentStream(taken.frames, FAST));
      assert.ok(error instanceof VeroneseError);
      assert.deepEqual([given, error.code, taken.count, taken.closed], [[0, 1, 2], code, 4, true]);
      assert.match(error.message, /frame/);
    }
    assert.match((await until(segmentStream([frame(0, SIZE), {}], FAST))).error.message, /^frame 1 /);
  });

  test('refuses options before it takes anything', async () => {
    const taken = source(frames(2));
    const { error } = await until(segmentStream(taken.frames, { lookAhead: 9 }));
    assert.deepEqual([error.code, /lookAhead/.test(error.message), taken.count], ['invalid-option', true, 0]);
  });
});

for (const [way, make] of [['directly', () => segmentStream], ['in a worker', (t) => (...args) => segmenter(t).segmenter.segmentStream(...args)]]) {
  describe(`a clip ${way}`, () => {
    test('is cancelled between frames, and closes its source', async (t) => {
      const controller = new AbortController();
      const taken = source(frames());
      const given = [];
      const error = await failure((async () => {
        for await (const { index } of make(t)(taken.frames, { ...FAST, signal: controller.signal })) {
          given.push(index);
          if (index === 1) controller.abort('enough');
        }
      })());
      assert.deepEqual([given, error.code, error.cause, taken.closed], [[0, 1], 'cancelled', 'enough', true]);
      const before = source(frames());
      assert.deepEqual([(await until(make(t)(before.frames, { signal: AbortSignal.abort() }))).error.code, before.count], ['cancelled', 0]);
    });

    test('is cancelled by a timer while a source without pauses feeds it, and while a source lets it wait', async (t) => {
      const endless = (function* () { for (;;) yield frame(0, SIZE); })();
      assert.equal((await until(make(t)(endless, { ...FAST, signal: after(30) }))).error.code, 'cancelled');
      const controller = new AbortController();
      let closed = false;
      const iterator = {
        next: () => {
          void setTimeout(20).then(() => controller.abort());
          return new Promise(() => {});
        },
        return: async () => ((closed = true), {}),
      };
      const silent = { [Symbol.asyncIterator]: () => iterator };
      assert.equal((await until(make(t)(silent, { signal: controller.signal }))).error.code, 'cancelled');
      assert.equal(closed, true);
    });

    test('whose listener throws ends with that', async (t) => {
      const mine = new Error('mine');
      const onProgress = ({ frame }) => {
        if (frame === 3) throw mine;
      };
      const taken = source(frames());
      assert.deepEqual(await until(make(t)(taken.frames, { ...FAST, onProgress })), { given: [0, 1], error: mine });
      assert.equal(taken.closed, true);
    });

    test('that the reader leaves closes its source, and the next clip works', async (t) => {
      const segment = make(t);
      const taken = source(frames());
      for await (const { index } of segment(taken.frames, FAST)) if (index === 1) break;
      assert.equal(taken.closed, true);
      assert.ok(taken.count < COUNT);
      assert.equal((await all(segment(frames(3), FAST))).length, 3);
    });
  });
}

describe('Segmenter.segmentStream', () => {
  test('gives the same bits as a direct call, in one worker, and one may be in the loop of another', async (t) => {
    const counted = segmenter(t);
    const here = segmentStream(frames(), FAST);
    const expected = await all(here);
    const there = counted.segmenter.segmentStream(frames(), FAST);
    const given = [];
    for await (const frame of there) {
      given.push(frame);
      if (frame.index === 0) assert.deepEqual(await all(counted.segmenter.segmentStream(frames(), FAST)), expected);
    }
    assert.deepEqual(given, expected);
    assert.deepEqual(there.tracks(), here.tracks());
    assert.equal(counted.started, 1);
  });

  test('keeps its worker when it is cancelled, left or fails, and when another call is cancelled beside it', async (t) => {
    const counted = segmenter(t);
    const expected = await all(segmentStream(frames(), FAST));
    // In the middle of a frame.
    const controller = new AbortController();
    const onProgress = ({ frame }) => frame === 2 && controller.abort();
    const { error } = await until(counted.segmenter.segmentStream(frames(), { ...FAST, onProgress, signal: controller.signal }));
    assert.equal(error.code, 'cancelled');
    for await (const _ of counted.segmenter.segmentStream(frames(), FAST)) break;
    await until(counted.segmenter.segmentStream([frame(0, SIZE), undefined], FAST));
    // Between two frames of a clip.
    const clip = counted.segmenter.segmentStream(frames(), FAST);
    const given = [(await clip.next()).value];
    const beside = new AbortController();
    const pairs = [
      counted.segmenter.segmentPair(...pair(), { signal: beside.signal, onProgress: () => beside.abort() }),
      counted.segmenter.segmentPair(...pair()),
    ];
    assert.equal((await failure(pairs[0])).code, 'cancelled');
    assert.deepEqual(timeless(await pairs[1]), timeless(await segmentPair(...pair())));
    given.push(...(await all(clip)));
    assert.deepEqual(given, expected);
    assert.equal(counted.started, 1, 'one worker did all of it');
  });

  test('a clip that was dropped after a frame gives its memory back', { timeout: 120_000 }, async (t) => {
    setFlagsFromString('--expose-gc');
    const collect = runInNewContext('gc');
    // The caller keeps nothing of the clip.
    const drop = async (segment) => void (await segment(frames(3), FAST).next());
    const calls = [];
    const perform = async ({ call }) => (calls.push(call), { index: 0, objects: [], background: null });
    await drop((...args) => streamOf(...args, () => ({ perform, release: () => calls.push('release') })));
    while (!calls.includes('release')) {
      t.signal.throwIfAborted();
      collect();
      await setImmediate();
    }
    assert.deepEqual(calls, ['beginStream', 'pushStream', 'finishStream', 'release']);
  });

  test('clips of a pool run side by side, and pairs go to the other workers', async (t) => {
    const pool = new SegmenterPool({ jobs: 2 });
    t.after(() => pool.close());
    const clips = [pool.segmentStream(frames(3), FAST), pool.segmentStream(frames(3), FAST)];
    await Promise.all(clips.map((clip) => clip.next()));
    assert.equal((await pool.segmentPair(...pair())).width, 64);
    for (const clip of clips) assert.equal((await all(clip)).length, 2);
  });

  test('a worker that dies, and one that is closed, end the clip with an error; a later clip gets a fresh worker', async (t) => {
    const counted = segmenter(t);
    const dying = counted.segmenter.segmentStream(frames(), FAST);
    await dying.next();
    await counted.workers[0].terminate();
    assert.equal((await until(dying)).error.code, 'worker-failed');
    const closing = counted.segmenter.segmentStream(frames(), FAST);
    await closing.next();
    counted.segmenter.close();
    assert.equal((await until(closing)).error.code, 'cancelled');
    assert.equal((await all(counted.segmenter.segmentStream(frames(3), FAST))).length, 3);
    assert.equal(counted.started, 3);
  });
});
