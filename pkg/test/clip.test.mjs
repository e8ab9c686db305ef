// Clips: directly and in workers.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { setImmediate, setTimeout } from 'node:timers/promises';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { Worker } from 'node:worker_threads';
import { segmentClip, segmentPair, Segmenter, SegmenterPool, VeroneseError } from 'veronese';
import { clipOf } from '../build/calls/clip.js';
import { frame, pair } from './support/frames.mjs';
import { all, checkMatrix, failure, timeless, until } from './support/shapes.mjs';
import { cases } from './support/soak.mjs';

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

/** Stops the time by which workers are waited for; `tick` has more of it pass than anybody waits. */
function withoutTime(t) {
  t.mock.timers.enable({ apis: ['setTimeout'] });
  return { tick: () => t.mock.timers.tick(60_000) };
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

describe('segmentClip', () => {
  test('gives every frame, in order, with objects that fit the labels, and their tracks', async () => {
    const clip = segmentClip({ length: COUNT, read: (index) => frames()[index] }, { quality: 'fast' });
    const given = await all(clip);
    assert.deepEqual(given.map(({ index }) => index), Array.from({ length: COUNT }, (_, k) => k));
    for (const { index, labels, width, height, objects, background } of given) {
      assert.deepEqual({ width, height }, SIZE);
      assert.ok(labels instanceof Uint8Array);
      assert.equal(labels.length, SIZE.width * SIZE.height);
      assert.deepEqual(new Set(labels), new Set([0, ...objects.map(({ id }) => id)]));
      const last = index === COUNT - 1;
      if (last) assert.equal(background, null);
      else checkMatrix(background);
      for (const { id, pixels, bbox: [x, y, w, h], confidence, matrix } of objects) {
        assert.equal(pixels, labels.filter((label) => label === id).length);
        const inside = labels.filter((label, p) => label === id && p % SIZE.width >= x && p % SIZE.width < x + w && Math.floor(p / SIZE.width) >= y && Math.floor(p / SIZE.width) < y + h);
        assert.equal(inside.length, pixels);
        assert.ok(confidence > 0.5 && confidence <= 1);
        if (last) assert.equal(matrix, null);
        else checkMatrix(matrix);
      }
    }
    assert.deepEqual(given.map(({ objects }) => objects.map(({ id }) => id)), Array(COUNT).fill([1]), 'the square keeps its number');

    const { objects: [square, ...others], background, dropped } = clip.tracks();
    assert.deepEqual([others, dropped], [[], 0]);
    assert.deepEqual([square.id, square.first, square.last], [1, 0, COUNT - 1]);
    assert.deepEqual(square.frames, given.map(({ index, objects: [{ id: _, ...seen }] }) => ({ frame: index, ...seen })));
    assert.deepEqual(background, given.slice(0, -1).map(({ index, background }) => ({ frame: index, matrix: background })));
  });

  test('takes iterables, promises, async iterables, and frames in place', async () => {
    const expected = await all(segmentClip(frames(), FAST));
    assert.deepEqual(await all(segmentClip(frames().map((one) => Promise.resolve(one)), FAST)), expected);
    assert.deepEqual(await all(segmentClip((async function* () { yield* frames(); })(), FAST)), expected);
    const read = [];
    const place = { length: COUNT, read: (index) => (read.push(index), index % 2 ? frames()[index] : Promise.resolve(frames()[index])) };
    assert.deepEqual(await all(segmentClip(place, FAST)), expected);
    assert.deepEqual(read, Array.from({ length: COUNT }, (_, k) => k));
  });

  test('waits for 8 frames of a stream and for a whole short clip, unless told otherwise', async () => {
    const taken = async (options, inPlace) => {
      let count = 0;
      const list = frames(12).map((one) => () => ((count += 1), one));
      const stream = (function* () { for (const one of list) yield one(); })();
      const clip = segmentClip(inPlace ? { length: list.length, read: (index) => list[index]() } : stream, { quality: 'fast', ...options });
      await clip.next();
      await clip.return();
      return count;
    };
    // One more is read while the last of them is worked on.
    assert.equal(await taken({}), 9 + 1);
    assert.equal(await taken({ lookAhead: 0 }), 1 + 1);
    assert.equal(await taken({ lookAhead: 2 }, true), 3 + 1);
    assert.equal(await taken({}, true), 12 + 1 + 1);
  });

  test('asks for frames only when the reader waits for one, and lets the source reuse its buffer', async () => {
    const buffer = frame(0, SIZE);
    let asked = 0;
    const reusing = (function* () {
      for (const one of frames()) {
        asked += 1;
        buffer.data.set(one.data);
        yield buffer;
      }
    })();
    const clip = segmentClip(reusing, FAST);
    // While another one is read to its end.
    const expected = await all(segmentClip(frames(), FAST));
    assert.equal(asked, 0);
    const given = [(await clip.next()).value];
    assert.equal(asked, 2 + 1);
    await all(segmentClip(frames(2), FAST));
    assert.equal(asked, 2 + 1);
    given.push(...(await all(clip)));
    assert.deepEqual(given, expected);
  });

  test('reads one frame while another is worked on, and waits neither for it nor for more', async () => {
    let asked = 0;
    const silent = (async function* () {
      while (++asked < 3) yield frame(0, SIZE);
      await new Promise(() => {});
    })();
    const work = [];
    const perform = async ({ call }) => {
      if (call === 'pushClip') return new Promise((resolve) => work.push(() => resolve({ index: work.length - 1, objects: [], background: null })));
    };
    const clip = clipOf(silent, { lookAhead: 0 }, async () => ({ perform, release() {} }));
    for (const index of [0, 1]) {
      const next = clip.next();
      for (let turn = 0; turn < 50; turn += 1) await setImmediate();
      assert.deepEqual([work.length, asked], [index + 1, index + 2], 'the next frame was asked for, and no other');
      work[index]();
      assert.equal((await next).value.index, index);
    }
    await clip.return();
  });

  test('transfers frames where it is asked to', async () => {
    const list = frames(2);
    await all(segmentClip(list, { ...FAST, transfer: true }));
    assert.deepEqual(list.map(({ data }) => data.length), [0, 0]);
  });

  test('reports progress', async () => {
    const progress = [];
    const onProgress = (one) => progress.push(one);
    const place = { length: 2, read: (index) => frames(2)[index] };
    await all(segmentClip(frames(2), { ...FAST, onProgress }));
    await all(segmentClip(place, { ...FAST, onProgress }));
    await all(segmentClip(place, { quality: 'fast', onProgress }));
    const told = (of, stage = 'pairs') => [{ frame: 0, of, stage }, { frame: 1, of, stage }];
    assert.deepEqual(progress, [...told(undefined), ...told(2), ...told(2), ...told(2, 'labels')]);
  });

  test('no frames and one frame are no clip, but of a live stream, whose frames are answered as they come', async () => {
    for (const [count, found] of [[0, 'none'], [1, 'one']]) {
      const whole = { length: count, read: (index) => frames(count)[index] };
      for (const given of [segmentClip(frames(count)), segmentClip(whole), segmentClip(whole, { lookAhead: 2 })]) {
        const { given: seen, error } = await until(given);
        assert.deepEqual([seen, error.code, error.message], [[], 'too-few-frames', `a clip needs two frames, found ${found}`]);
      }
      const live = await all(segmentClip(frames(count), { lookAhead: 0 }));
      assert.deepEqual(live.map(({ objects, background }) => [objects, background]), Array(count).fill([[], null]));
    }
  });

  test('several clips in one thread do not disturb each other', async () => {
    const expected = await all(segmentClip(frames(4), FAST));
    const [one, other] = [segmentClip(frames(4), FAST), segmentClip(frames(4), FAST)];
    for (const frame of expected) {
      assert.deepEqual((await one.next()).value, frame);
      assert.deepEqual((await other.next()).value, frame);
    }
  });

  test('a clip whose module was replaced says so, and takes no other clip for its own', async () => {
    const mine = new Error('mine');
    const lost = segmentClip(frames(), FAST);
    await lost.next();
    assert.equal(await failure(segmentPair(...pair(), { onProgress: () => { throw mine; } })), mine);
    const next = segmentClip(frames(), FAST);
    const [first] = [(await next.next()).value];
    const { error } = await until(lost);
    assert.deepEqual([error.code, /lost/.test(error.message)], ['internal', true]);
    assert.deepEqual([first, ...(await all(next))], await all(segmentClip(frames(), FAST)));
  });
});

/** Both ways to segment a clip. */
const WAYS = [
  ['directly', () => segmentClip],
  [
    'in a worker',
    (t) => {
      const { segmenter: made } = segmenter(t);
      return (...args) => made.segmentClip(...args);
    },
  ],
];

for (const [way, make] of WAYS) {
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
      const early = await until(make(t)(before.frames, { signal: AbortSignal.abort() }));
      assert.deepEqual([early.error.code, before.count], ['cancelled', 0]);
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

// Of this the way changes nothing.
for (const [way, make] of cases(WAYS.slice(0, 1), WAYS.slice(1))) {
  describe(`a clip ${way}`, () => {
    test('whose source throws gives first what there was', async (t) => {
      const mine = new Error('mine');
      const failing = async function* () {
        yield* frames(3);
        throw mine;
      };
      assert.deepEqual(await until(make(t)(failing(), FAST)), { given: [0, 1, 2], error: mine });
      const place = { length: 5, read: (index) => (index < 3 ? frames()[index] : Promise.reject(mine)) };
      assert.deepEqual(await until(make(t)(place, FAST)), { given: [0, 1, 2], error: mine });
    });

    test('with a frame that does not fit gives first those before it, and closes its source', async (t) => {
      const cases = [
        ['frame-size-mismatch', frame(0, { width: 70, height: 48 })],
        ['invalid-input', { ...SIZE, data: 'text' }],
        ['invalid-input', undefined],
        ['frame-size-unsupported', { width: 1, height: 1, data: new Uint8Array(4) }],
        ['pixel-count-mismatch', { ...SIZE, data: new Uint8Array(4) }],
      ];
      for (const [code, bad] of cases) {
        const taken = source([...frames(3), bad, ...frames(3)]);
        const { given, error } = await until(make(t)(taken.frames, FAST));
        assert.ok(error instanceof VeroneseError);
        assert.deepEqual([given, error.code, taken.count, taken.closed], [[0, 1, 2], code, 4, true]);
        assert.match(error.message, /frame/);
      }
      assert.match((await until(make(t)([frame(0, SIZE), {}], FAST))).error.message, /^frame 1 /);
    });

    test('refuses options and frames before it takes anything', async (t) => {
      const cases = [
        [{ lookAhead: 9 }, /lookAhead/],
        [{ before: frame(0) }, /there is no option 'before'/],
        [{ signal: {} }, /signal/],
      ];
      for (const [options, message] of cases) {
        const taken = source(frames(2));
        const { error } = await until(make(t)(taken.frames, options));
        assert.deepEqual([error.code, taken.count], ['invalid-option', 0]);
        assert.match(error.message, message);
      }
    });
  });
}

describe('Segmenter.segmentClip', () => {
  test('gives the same bits as a direct call, in one worker', async (t) => {
    const counted = segmenter(t);
    const [there, here] = [counted.segmenter.segmentClip(frames(), FAST), segmentClip(frames(), FAST)];
    assert.deepEqual(await all(there), await all(here));
    assert.deepEqual(there.tracks(), here.tracks());
    assert.equal(counted.started, 1);
  });

  test('keeps its worker when it is cancelled, left or fails, and when another call is cancelled beside it', async (t) => {
    const counted = segmenter(t);
    const expected = await all(segmentClip(frames(), FAST));
    // In the middle of a frame.
    const controller = new AbortController();
    const onProgress = ({ frame }) => frame === 2 && controller.abort();
    const { error } = await until(counted.segmenter.segmentClip(frames(), { ...FAST, onProgress, signal: controller.signal }));
    assert.equal(error.code, 'cancelled');
    for await (const _ of counted.segmenter.segmentClip(frames(), FAST)) break;
    await until(counted.segmenter.segmentClip([frame(0, SIZE), undefined], FAST));
    // Between two frames of a clip.
    const clip = counted.segmenter.segmentClip(frames(), FAST);
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

  test('a second clip waits for the first, and can be cancelled while it does', async (t) => {
    const { segmenter: made } = segmenter(t);
    withoutTime(t);
    const first = made.segmentClip(frames(3), FAST);
    await first.next();
    const taken = source(frames(3));
    const second = made.segmentClip(taken.frames, FAST);
    const answer = second.next();
    const controller = new AbortController();
    const third = until(made.segmentClip(frames(), { signal: controller.signal }));
    controller.abort();
    assert.equal((await third).error.code, 'cancelled');
    assert.equal(taken.count, 0);
    assert.equal((await all(first)).length, 2);
    assert.equal((await answer).value.index, 0);
    assert.equal((await all(second)).length, 2);
  });

  test('a clip in the loop of another is refused where it would wait for ever; a pool has room for it', async (t) => {
    const { segmenter: made } = segmenter(t);
    const { tick } = withoutTime(t);
    const outer = [];
    for await (const { index } of made.segmentClip(frames(3), FAST)) {
      outer.push(index);
      if (index > 0) continue;
      const inner = until(made.segmentClip(frames(3), FAST));
      tick();
      const { given, error } = await inner;
      assert.deepEqual([given, error.code], [[], 'worker-busy']);
      assert.match(error.message, /SegmenterPool/);
    }
    assert.deepEqual(outer, [0, 1, 2]);
    const pool = new SegmenterPool({ jobs: 2 });
    t.after(() => pool.close());
    for await (const _ of pool.segmentClip(frames(3), FAST)) assert.equal((await all(pool.segmentClip(frames(3), FAST))).length, 3);
  });

  test('a clip that waits for its source is waited for', async (t) => {
    const { segmenter: made } = segmenter(t);
    const { tick } = withoutTime(t);
    const slow = function* () {
      for (const one of frames(3)) {
        tick();
        yield one;
      }
    };
    const clips = [made.segmentClip(slow(), { ...FAST, lookAhead: 0 }), made.segmentClip(frames(3), FAST)];
    assert.deepEqual((await Promise.all(clips.map(all))).map(({ length }) => length), [3, 3]);
  });

  test('a clip that was dropped after a frame gives its worker back, and its memory', { timeout: 120_000 }, async (t) => {
    setFlagsFromString('--expose-gc');
    const collect = runInNewContext('gc');
    // The caller keeps nothing of the clip.
    const drop = async (segment) => void (await segment(frames(3), FAST).next());
    const collectUntil = async (isFreed) => {
      while (!isFreed()) {
        t.signal.throwIfAborted();
        collect();
        await setImmediate();
      }
    };
    const { segmenter: made } = segmenter(t);
    withoutTime(t);
    await drop((...args) => made.segmentClip(...args));
    let next;
    void until(made.segmentClip(frames(3), FAST)).then((outcome) => (next = outcome));
    await collectUntil(() => next);
    assert.deepEqual(next, { given: [0, 1, 2], error: undefined });
    const calls = [];
    const perform = async ({ call }) => {
      calls.push(call);
      return { index: 0, objects: [], background: null };
    };
    await drop((...args) => clipOf(...args, async () => ({ perform, release: () => calls.push('release') })));
    await collectUntil(() => calls.includes('release'));
    assert.deepEqual(calls, ['beginClip', 'pushClip', 'endClip', 'release']);
  });

  test('clips of a pool run side by side, and pairs go to the other workers', async (t) => {
    const pool = new SegmenterPool({ jobs: 2 });
    t.after(() => pool.close());
    const clips = [pool.segmentClip(frames(3), FAST), pool.segmentClip(frames(3), FAST)];
    await Promise.all(clips.map((clip) => clip.next()));
    assert.equal((await pool.segmentPair(...pair())).width, 64);
    for (const clip of clips) assert.equal((await all(clip)).length, 2);
  });

  test('a worker that dies, and one that is closed, end the clip with an error; a later clip gets a fresh worker', async (t) => {
    const counted = segmenter(t);
    const dying = counted.segmenter.segmentClip(frames(), FAST);
    await dying.next();
    await counted.workers[0].terminate();
    assert.equal((await until(dying)).error.code, 'worker-failed');
    const closing = counted.segmenter.segmentClip(frames(), FAST);
    await closing.next();
    const waiting = until(counted.segmenter.segmentClip(frames(), FAST));
    await setTimeout(0);
    counted.segmenter.close();
    assert.equal((await until(closing)).error.code, 'cancelled');
    assert.equal((await waiting).error.code, 'cancelled');
    assert.equal((await all(counted.segmenter.segmentClip(frames(3), FAST))).length, 3);
    assert.equal(counted.started, 3);
  });
});
