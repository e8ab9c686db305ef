// Clips whose frames can be read again: corrections, edits, states and pairs that are known, directly and in workers.

import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { setImmediate } from 'node:timers/promises';
import { Worker } from 'node:worker_threads';
import { segmentClip, Segmenter, SegmenterPool, VeroneseError } from 'veronese';
import { frame } from './support/frames.mjs';
import { all, until } from './support/shapes.mjs';
import { cases } from './support/soak.mjs';

const COUNT = 7;
const SIZE = { width: 96, height: 72 };
const PIXELS = SIZE.width * SIZE.height;
const FAST = { quality: 'fast' };
const ALL = Array.from({ length: COUNT }, (_, index) => index);

const list = ALL.map((index) => frame(index / 2, SIZE));
/** A source that counts what is read, and may fail. */
function readable(fail = () => false, count = COUNT) {
  const source = { length: count, asked: [] };
  source.read = (index) => {
    source.asked.push(index);
    if (fail(index, source.asked)) throw MINE;
    return list[index];
  };
  return source;
}
const MINE = new Error('mine');

/** Where the square is in frame 3. */
const mask = (inside, outside) =>
  Uint8Array.from({ length: PIXELS }, (_, p) => {
    const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
    return x >= 27 && x < 63 && y >= 20 && y < 56 ? inside : outside;
  });

/** The frames of a clip, its tracks, its state, and the stages it went through. */
async function outcome(segment, source, options) {
  const stages = { pairs: [], corrections: [], labels: [] };
  const clip = segment(source, { ...FAST, onProgress: ({ stage, frame }) => stages[stage].push(frame), ...options });
  assert.equal(await clip.state(), undefined, 'nothing is known yet');
  return { frames: await all(clip), tracks: clip.tracks(), state: await clip.state(), stages };
}

/** Bytes with another mark. */
const marked = (bytes, mark) => new Uint8Array([...new TextEncoder().encode(mark), ...bytes.slice(mark.length)]);

const idsOf = (frames) => frames.map(({ objects }) => objects.map(({ id }) => id));

const whole = await outcome(segmentClip, readable());
const corrected = await outcome(segmentClip, readable(), { corrections: [{ frame: 3, labels: mask(9, 0) }] });

/** All ways to segment a clip. */
const [segmenter, pool] = [new Segmenter(), new SegmenterPool({ jobs: 3 })];
after(() => {
  segmenter.close();
  pool.close();
});
const WAYS = cases(
  [['directly', segmentClip], ['in several workers', (...args) => pool.segmentClip(...args)]],
  [['in a worker', (...args) => segmenter.segmentClip(...args)]],
);

for (const [way, segment] of WAYS) {
  describe(`a whole clip ${way}`, () => {
    test('reads every frame for its pairs and for its labels', async () => {
      const source = readable();
      const { frames, tracks, state, stages } = await outcome(segment, source);
      assert.deepEqual({ frames, tracks, state }, { frames: whole.frames, tracks: whole.tracks, state: whole.state });
      assert.deepEqual(stages, { pairs: ALL, corrections: [], labels: ALL });
      assert.deepEqual(source.asked, [...ALL, ...ALL]);
      assert.deepEqual(idsOf(frames), ALL.map(() => [1]));
    });

    test('a state takes the place of all pairs', async () => {
      const source = readable();
      const again = await outcome(segment, source, { state: whole.state });
      assert.deepEqual({ ...again, stages: 0 }, { ...whole, stages: 0 });
      assert.deepEqual([again.stages.pairs, source.asked], [[], ALL]);
      const corrections = [{ frame: 3, labels: mask(9, 0) }];
      const later = await outcome(segment, list, { state: whole.state, corrections });
      assert.deepEqual({ ...later, stages: 0 }, { ...corrected, stages: 0 });
      assert.deepEqual(later.stages.pairs, []);
      // It keeps corrections until they are taken back, and edits.
      const kept = await outcome(segment, list, { state: later.state, edits: { delete: [9] } });
      // Without the annotated object, the objects that it took over are there again.
      assert.deepEqual(idsOf((await outcome(segment, list, { state: kept.state })).frames), ALL.map(() => [1]));
      const back = await outcome(segment, list, { state: later.state, corrections: [{ frame: 3, labels: mask(255, 255) }] });
      assert.deepEqual(idsOf(back.frames), idsOf(whole.frames));
    });

    test('an interrupted run goes on with the pairs that are known', async () => {
      const kept = new Map();
      const onPairs = async (index, pairs) => {
        kept.set(index, pairs);
        if (index === 3) throw MINE;
      };
      assert.deepEqual(await until(segment(readable(), { ...FAST, onPairs })), { given: [], error: MINE });
      // Several workers may have come further.
      assert.deepEqual([...kept.keys()].sort().slice(0, 4), [0, 1, 2, 3]);
      for (const index of ALL.slice(4)) kept.delete(index);
      kept.set(1, kept.get(1).slice(0, 40));
      kept.set(2, new Uint8Array(3));
      const solved = [];
      const options = { knownPairs: async (index) => kept.get(index), onPairs: (index) => void solved.push(index) };
      const { frames, tracks, state } = await outcome(segment, readable(), options);
      assert.deepEqual(solved.sort(), [1, 2, 4, 5, 6], 'damaged ones are solved again');
      assert.deepEqual({ frames, tracks, state }, { frames: whole.frames, tracks: whole.tracks, state: whole.state });
      assert.deepEqual(kept.get(0).length > 0, true, 'the bytes stay the caller\'s');
      const unfit = await until(segment(readable(), { ...FAST, knownPairs: () => 'pairs' }));
      assert.deepEqual([unfit.error.code, unfit.given], ['invalid-input', []]);
    });

    test('a frame that cannot be read the first time ends the clip before it, one of the second time there', async () => {
      for (const fail of [(index) => index === 4, (index, { length }) => length === COUNT + 5]) {
        const source = readable(fail);
        assert.deepEqual(await until(segment(source, FAST)), { given: [0, 1, 2, 3], error: MINE });
      }
      const corrections = [{ frame: 3, labels: mask(9, 0) }];
      const early = await until(segment(readable((index) => index === 2), { ...FAST, corrections }));
      assert.deepEqual(early, { given: [0, 1], error: MINE }, 'what is said of a later frame does not matter');
      const midway = await until(segment(readable((_, { length }) => length === COUNT + 2), { ...FAST, corrections }));
      assert.deepEqual(midway, { given: [], error: MINE });
      const other = { length: COUNT, read: (index) => (index === 2 ? frame(0, { width: 80, height: 72 }) : list[index]) };
      const { given, error } = await until(segment(other, FAST));
      assert.deepEqual([given, error.code, error.message.startsWith('frame 2 ')], [[0, 1], 'frame-size-mismatch', true]);
    });

    test('is cancelled in each of its passes, and left early', async () => {
      const options = { ...FAST, corrections: [{ frame: 3, labels: mask(9, 0) }] };
      for (const [stage, given] of [['pairs', []], ['corrections', []], ['labels', [0, 1, 2, 3]]]) {
        const controller = new AbortController();
        const onProgress = (progress) => progress.stage === stage && progress.frame === 4 && controller.abort();
        const ended = await until(segment(readable(), { ...options, onProgress, signal: controller.signal }));
        assert.deepEqual([ended.given, ended.error.code], [given, 'cancelled'], stage);
      }
      const source = readable();
      for await (const { index } of segment(source, FAST)) if (index === 1) break;
      assert.deepEqual(source.asked, [...ALL, 0, 1, 2]);
      assert.deepEqual((await outcome(segment, list.slice(0, 2), { lookAhead: 'all' })).frames.length, 2);
    });

    test('is cancelled while it waits for the caller to keep or find pairs', async () => {
      for (const name of ['onPairs', 'knownPairs']) {
        const controller = new AbortController();
        const waiting = (index) => {
          if (index < 2) return undefined;
          setTimeout(() => controller.abort(), 10);
          return new Promise(() => {});
        };
        const ended = await until(segment(readable(), { ...FAST, [name]: waiting, signal: controller.signal }));
        assert.deepEqual([ended.given, ended.error.code], [[], 'cancelled'], name);
        assert.deepEqual(await all(segment(readable(), FAST)), whole.frames, 'its worker is free');
      }
    });
  });
}

// Of this the way changes nothing.
for (const [way, segment] of cases(WAYS.slice(0, 1), WAYS.slice(1))) {
  describe(`a whole clip ${way}`, () => {
    test('a correction holds to the pixel and spreads both ways', async () => {
      const source = readable();
      const { frames, tracks, stages } = await outcome(segment, source, { corrections: [{ frame: 3, labels: mask(9, 0) }] });
      assert.deepEqual(frames[3].labels, mask(9, 0));
      assert.deepEqual(idsOf(frames), ALL.map(() => [9]));
      assert.deepEqual(tracks.objects.map(({ id, first, last }) => [id, first, last]), [[9, 0, COUNT - 1]]);
      assert.deepEqual(stages, { pairs: ALL, corrections: [3, 4, 5, 6, 2, 1, 0], labels: ALL });
      assert.deepEqual(frames, corrected.frames);
    });

    test('edits merge, remove and name', async () => {
      // One half of the square is an object of its own.
      const corrections = [{ frame: 3, labels: mask(9, 0).map((label, p) => (label > 0 && p % SIZE.width < 45 ? 1 : label)) }];
      const halves = await outcome(segment, readable(), { corrections });
      assert.deepEqual(idsOf(halves.frames)[3], [1, 9]);
      const edits = { merge: [[9, 1]], names: { 9: 'square', 30: 'nobody' } };
      const merged = await outcome(segment, readable(), { state: whole.state, corrections, edits });
      const labels = halves.frames.map(({ labels }) => labels.map((label) => (label > 0 ? 9 : 0)));
      assert.deepEqual(merged.frames.map(({ labels }) => labels), labels);
      assert.deepEqual(merged.tracks.objects.map(({ id, name }) => [id, name]), [[9, 'square']]);
      // Numbers that no object has change nothing, which a note says.
      for (const merge of [[[9, 1]], [[9, 8]], [[1, 9]]]) {
        const { frames, tracks } = await outcome(segment, readable(), { state: whole.state, edits: { merge, names: { 9: 'nobody' } } });
        assert.deepEqual(frames, whole.frames);
        assert.deepEqual(tracks.objects, whole.tracks.objects);
        assert.ok(tracks.notes?.some(({ code }) => code === 'object-missing'));
      }
      for (const name of ['delete', 'background']) {
        const { frames, tracks } = await outcome(segment, readable(), { state: whole.state, edits: { [name]: [1, 77] } });
        assert.deepEqual([idsOf(frames), tracks.objects], [ALL.map(() => []), []]);
        assert.ok(frames.every(({ labels }) => labels.every((label) => label === 0)));
      }
    });

    test('changesOnly gives the frames that corrections and edits change', async () => {
      const changes = async (options) => (await outcome(segment, readable(), { state: whole.state, changesOnly: true, ...options })).frames;
      const frames = await changes({ corrections: [{ frame: 3, labels: mask(9, 0) }] });
      assert.deepEqual(frames, ALL.map((index) => corrected.frames[index]));
      for (const edits of [{ delete: [2] }, { merge: [[2, 1]] }]) assert.deepEqual(await changes({ edits }), []);
      assert.deepEqual((await changes({ edits: { delete: [1] } })).map(({ index }) => index), ALL);
      assert.deepEqual(await changes({}), []);
      const again = [{ frame: 3, labels: mask(9, 0) }];
      assert.deepEqual(await changes({ state: corrected.state, corrections: again }), [], 'what was said before changes nothing');
      const corrections = [{ frame: 3, labels: whole.frames[3].labels }];
      const given = new Map((await changes({ corrections })).map((one) => [one.index, one]));
      const { frames: every } = await outcome(segment, list, { state: whole.state, corrections });
      for (const one of every) assert.deepEqual(one, given.get(one.index) ?? whole.frames[one.index]);
    });

    test('frames must be those of the state, and the same whenever they are read', async () => {
      const altered = (index) => ({ ...list[index], data: list[index].data.map((value, at) => (at === 4000 ? value ^ 1 : value)) });
      const transparent = list.map(({ data, ...size }) => ({ data: data.map((value, at) => (at % 4 === 3 ? 7 : value)), ...size }));
      assert.deepEqual((await outcome(segment, transparent, { state: whole.state })).frames, whole.frames, 'alpha is ignored');
      const other = list.with(3, altered(3));
      const found = await until(segment(other, { state: whole.state }));
      assert.deepEqual([found.given, found.error.code], [[0, 1, 2], 'invalid-option']);
      assert.match(found.error.message, /'state': frame 3 is not the one that was segmented/);
      const corrections = [{ frame: 2, labels: mask(9, 0) }];
      const reached = await until(segment(other, { state: whole.state, corrections }));
      assert.deepEqual([reached.given, reached.error.message], [[], found.error.message]);
      const stranger = await until(segment([...list].reverse(), { state: whole.state }));
      assert.deepEqual([stranger.given, stranger.error.code], [[], 'invalid-option']);
      const source = readable();
      const read = (index) => (source.read(index) && source.asked.length > COUNT && index === 4 ? altered(4) : list[index]);
      const twice = await until(segment({ length: COUNT, read }, FAST));
      assert.deepEqual([twice.given, twice.error.code], [[0, 1, 2, 3], 'invalid-input']);
      assert.match(twice.error.message, /^frame 4 is not the one that was segmented$/);
    });

    test('shows what the pairs tell while they are solved, and returns the same', async () => {
      const previews = [];
      const onPreview = async (preview) => void previews.push(preview);
      const { frames, tracks, state } = await outcome(segment, readable(), { onPreview });
      assert.deepEqual({ frames, tracks, state }, { frames: whole.frames, tracks: whole.tracks, state: whole.state });
      assert.deepEqual(previews.map(({ index, labels }) => [index, labels.length]), ALL.slice(0, -1).map((index) => [index, PIXELS]));
      assert.deepEqual(previews[3].objects.map(({ id, pixels }) => [id, Math.abs(pixels - 36 * 36) < 200]), [[1, true]], 'the square');
      const failing = until(segment(readable(), { ...FAST, onPreview: ({ index }) => { if (index === 2) throw MINE; } }));
      assert.deepEqual(await failing, { given: [], error: MINE });
    });

    test('refuses corrections, edits and states before any pair is solved', async () => {
      const said = (frame, labels = mask(1, 255)) => ({ corrections: [{ frame: 0, labels: mask(1, 255) }, { frame, labels }] });
      const damaged = whole.state.slice(0, -1);
      const cases = [
        [{ corrections: [5] }, /'corrections': must be a list/],
        [said(COUNT), /number 1 must have a frame from 0 to 6/],
        [said(0), /number 1 is of frame 0, as one before is/],
        [said(2, [1]), /number 1 must have labels, a Uint8Array/],
        [said(2, new Uint8Array(12)), /that of frame 2 has 12 labels, a frame has 96×72 pixels/],
        [{ ...said(2, new Uint8Array(12)), state: whole.state }, /that of frame 2 has 12 labels/],
        ...[
          [{ label: 1, box: [0, 0, 9, 9], click: [0, 0] }, /must have a box or a click, not both/],
          [{}, /must have labels, a Uint8Array/],
        ].map(([entry, message]) => [{ corrections: [{ frame: 0, ...entry }] }, message]),
        [{ corrections: [{ frame: 0, label: 1, click: [0, 0] }, { frame: 0, label: 1, box: [0, 0, 9, 9] }] }, /number 1 points to object 1 in frame 0, as one before does/],
        [{ edits: [] }, /'edits': must be an object/],
        [{ edits: { join: [] } }, /'edits': there is no edit 'join'; there are merge/],
        [{ edits: { merge: [2, 5] } }, /'merge' must be lists of two or more objects, numbers from 1 to 254/],
        [{ edits: { merge: [[2]] } }, /'merge' must be lists/],
        [{ edits: { merge: [[2, 255]] } }, /'merge' must be lists/],
        [{ edits: { merge: [[2, 5], [3, 5]] } }, /object 5 cannot become object 2 and object 3/],
        [{ edits: { merge: [[2, 5]], delete: [5] } }, /object 5 cannot become object 2 and background/],
        [{ edits: { background: [0] } }, /'background' must be a list of objects/],
        [{ edits: { names: { 0: 'ground' } } }, /'names' has a name for '0'/],
        [{ edits: { names: { 1: 5 } } }, /'names' must have a text for object 1/],
        [{ state: whole.state, frames: list.slice(1) }, /'state': it is of a clip of 7 frames, not 6/],
        [{ state: damaged }, /'state': it is damaged/],
        [{ state: new Uint8Array(50) }, /'state': these bytes are not of this version: segment the clip again/],
        [{ state: marked(whole.state, 'VERCLIP2') }, /'state': these bytes are not of this version/],
        [{ state: whole.state, lookAhead: 9 }, /'lookAhead'/],
      ];
      for (const [{ frames = list, ...options }, message] of cases) {
        const stages = [];
        const { given, error } = await until(segment(frames, { ...FAST, ...options, onProgress: ({ stage }) => stages.push(stage) }));
        assert.ok(error instanceof VeroneseError, String(error));
        assert.deepEqual([given, stages, error.code], [[], [], 'invalid-option'], error.message);
        assert.match(error.message, message);
      }
      assert.equal((await until(segment(list, { state: 'text' }))).error.code, 'invalid-input');
      const other = ALL.map(() => frame(0, { width: 80, height: 72 }));
      assert.equal((await until(segment(other, { state: whole.state }))).error.code, 'frame-size-mismatch');
    });
  });
}

describe('what makes a clip a whole one', () => {
  const stagesOf = async (source, options) => (await outcome(segmentClip, source, options)).stages.labels.length > 0;

  test('an array is a stream unless more is asked for', async () => {
    assert.equal(await stagesOf(list), false);
    for (const options of [{ lookAhead: 'all' }, { corrections: [] }, { edits: {} }, { onPairs: () => {} }]) {
      const { frames, stages } = await outcome(segmentClip, list, options);
      assert.deepEqual([frames, stages.labels], [whole.frames, ALL]);
    }
  });

  test('frames to read are a whole clip unless they are looked ahead a few frames and no more is asked for', async () => {
    assert.equal(await stagesOf(readable(), { lookAhead: 2 }), false);
    const { frames } = await outcome(segmentClip, readable(), { lookAhead: 2, edits: {} });
    const stream = await outcome(segmentClip, readable(), { lookAhead: 2 });
    assert.deepEqual(frames.map(({ labels }) => labels), stream.frames.map(({ labels }) => labels));
    assert.equal(stream.state, undefined);
  });

  test('what comes once cannot be one, and nothing is taken from it', async () => {
    const options = [{ lookAhead: 'all' }, { corrections: [] }, { edits: {} }, { state: whole.state }, { changesOnly: true }, { onPairs() {} }, { knownPairs() {} }, { onPreview() {} }];
    for (const option of options) {
      let taken = 0;
      const once = (function* () { for (const one of list) yield ((taken += 1), one); })();
      const { error } = await until(segmentClip(once, option));
      assert.deepEqual([error.code, taken], ['invalid-option', 0]);
      assert.match(error.message, new RegExp(`option '${Object.keys(option)[0]}': needs frames that can be read again: an array, or \\{ length, read\\(index\\) \\}`));
    }
  });

  test('frames of an array are transferred when they are read for the last time', async () => {
    const own = list.map(({ data, ...size }) => ({ data: data.slice(), ...size }));
    assert.deepEqual(await all(segmentClip(own, { ...FAST, lookAhead: 'all', transfer: true })), whole.frames);
    assert.deepEqual(own.map(({ data }) => data.length), ALL.map(() => 0));
  });
});

describe('clips', () => {
  test('mark what is unknown, and nothing else changes', async () => {
    const marked = await outcome(segmentClip, readable(), { markUnknown: true });
    const count = marked.frames.reduce((sum, { labels }) => sum + labels.filter((label) => label === 255).length, 0);
    assert.ok(count > 0, 'something is unknown');
    marked.frames.forEach(({ labels }, index) => {
      labels.forEach((label, p) => label === 255 || assert.equal(label, whole.frames[index].labels[p]));
    });
    for (const markUnknown of [true, false]) {
      const again = await outcome(segmentClip, list, { state: whole.state, markUnknown });
      assert.deepEqual(again.frames, (markUnknown ? marked : whole).frames);
    }
    const streamed = await outcome(segmentClip, list, { markUnknown: true, lookAhead: 2 });
    assert.ok(streamed.frames.some(({ labels }) => labels.includes(255)));
  });

  test('end without a motion to the next frame, streams too', async () => {
    for (const lookAhead of [0, 2, 'all']) {
      const { tracks } = await outcome(segmentClip, list, { lookAhead });
      assert.ok(tracks.objects.length > 0);
      const last = tracks.objects.flatMap(({ frames }) => frames.filter(({ frame }) => frame === COUNT - 1));
      assert.deepEqual(last.map(({ matrix }) => matrix), last.map(() => null));
      assert.ok(last.length > 0);
      // The first frame of a stream that waits for none comes from nowhere.
      assert.deepEqual(tracks.background.map(({ frame }) => frame), ALL.slice(lookAhead === 0 ? 1 : 0, -1));
    }
  });

  test('are the same to the bit with any number of workers, whichever of their pairs are known', async (t) => {
    const count = 21;
    const moving = Array.from({ length: count }, (_, index) => frame(index / 2));
    const pairs = new Map();
    const alone = await outcome(segmentClip, { length: count, read: (index) => moving[index] }, { onPairs: (index, bytes) => void pairs.set(index, bytes) });
    const some = [1, 2, 3, 9, 14, 20];
    for (const [jobs, ...ways] of cases([[3, some]], [[3, []], [8, [], some], [2, [], some]])) {
      const pool = new SegmenterPool({ jobs });
      t.after(() => pool.close());
      for (const known of ways) {
        const [solved, previews] = [[], []];
        const { frames, tracks, state, stages } = await outcome((...args) => pool.segmentClip(...args), { length: count, read: async (index) => moving[index] }, {
          knownPairs: (index) => (known.includes(index) ? pairs.get(index) : undefined),
          onPairs: (index, bytes) => {
            solved.push(index);
            assert.deepEqual(bytes, pairs.get(index), `pairs of frame ${index}`);
          },
          onPreview: ({ index }) => void previews.push(index),
        });
        assert.deepEqual({ frames, tracks, state }, { frames: alone.frames, tracks: alone.tracks, state: alone.state }, `${jobs} workers`);
        assert.deepEqual(stages, alone.stages);
        assert.deepEqual(previews, stages.pairs.slice(0, -1), 'in their order');
        assert.deepEqual(solved.sort((one, other) => one - other), stages.pairs.filter((index) => !known.includes(index)));
      }
    }
  });

  test('of a pool outlive a worker that only helps', async (t) => {
    const outcomeWithout = (number) => {
      const workers = [];
      const worker = () => {
        workers.push(new Worker(new URL('../dist/worker-node.js', import.meta.url)));
        return workers.at(-1);
      };
      const pool = new SegmenterPool({ jobs: 3, worker });
      t.after(() => pool.close());
      let ended = false;
      const onPairs = async () => {
        if (ended || workers.length <= number) return;
        ended = true;
        await workers[number].terminate();
      };
      return until(pool.segmentClip(readable(), { ...FAST, onPairs })).finally(() => assert.equal(ended, true));
    };
    assert.deepEqual((await outcomeWithout(2)), { given: ALL, error: undefined });
    // The first worker has the clip.
    assert.equal((await outcomeWithout(0)).error.code, 'worker-failed');
  });

  test('of a pool do not wait for workers that others keep busy, start none when it is closed, and give them back', { timeout: 120_000 }, async (t) => {
    const untilIt = async (isSo) => {
      while (!isSo()) {
        t.signal.throwIfAborted();
        await setImmediate();
      }
    };
    const workers = [];
    // The first worker never answers, so that its call lasts however slow the others are.
    const worker = () => {
      const one = workers.length ? new Worker(new URL('../dist/worker-node.js', import.meta.url)) : new Worker('setInterval(() => {}, 1000)', { eval: true });
      one.once('exit', () => (one.ended = true));
      workers.push(one);
      return one;
    };
    const pool = new SegmenterPool({ jobs: 4, worker });
    t.after(() => pool.close());
    const controller = new AbortController();
    const busy = pool.segmentPair(list[0], list[1], { signal: controller.signal }).catch(({ code }) => code);
    assert.deepEqual(await all(pool.segmentClip(readable(), FAST)), whole.frames);
    controller.abort();
    assert.equal(await busy, 'cancelled');
    // The cancelled call's worker has ended as it would have without a clip; of the others, one keeps the clip.
    await untilIt(() => workers.filter(({ ended }) => !ended).length === 1);

    let given;
    const slow = { length: COUNT, read: (index) => (index < 5 ? list[index] : new Promise((resolve) => (given = () => resolve(list[index])))) };
    const closed = until(pool.segmentClip(slow, FAST));
    await untilIt(() => given);
    pool.close();
    const { length } = workers;
    given();
    assert.equal((await closed).error.code, 'cancelled');
    // Nothing that waits for no worker is left to do after so many turns.
    for (let turn = 0; turn < 50; turn += 1) await setImmediate();
    assert.equal(workers.length, length, 'no worker was started');
  });

  test('of a pool leave its other calls their turn', { timeout: 120_000 }, async (t) => {
    const pool = new SegmenterPool({ jobs: 2 });
    t.after(() => pool.close());
    // The clip cannot end before the pair has an answer.
    let pair;
    const held = { length: COUNT, read: async (index) => (index < 5 || (await pair)) && list[index] };
    const clip = all(pool.segmentClip(held, FAST));
    pair = pool.segmentPair(list[0], list[1], FAST);
    assert.equal((await pair).labels.length, PIXELS);
    assert.deepEqual(await clip, whole.frames);
  });
});
