// Every public entry with values that are not what it takes. A call either works or rejects with a VeroneseError of a published code,
// never `internal`; workers say the same as direct calls, word for word, and go on working.

import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { inspect, isDeepStrictEqual } from 'node:util';
import { Worker } from 'node:worker_threads';
import * as index from 'veronese';
import * as codecs from 'veronese/codecs';
import { VeroneseSegmenterElement } from 'veronese/element-class';
import * as formats from 'veronese/formats';
import { optionsOf } from '../build/element/options.js';
import { png } from './support/frames.mjs';
import { temporaryFolder } from './support/program.mjs';
import { CALLS, COMMANDS, EMPTY, FINITE, OPENINGS, OPTIONS, STREAMS, VALUES, all, checked, first, found, measurements, named, outcome, second } from './support/hostile.mjs';
import { failure } from './support/shapes.mjs';

/** All values in one place. */
async function everywhere(call, harmless, also = async () => {}) {
  for (const [name, value] of Object.entries(VALUES)) {
    try {
      const became = await outcome(() => call(value));
      assert.equal('result' in became, harmless.includes(name), became.message ?? 'it was not refused');
      await also(value, became);
    } catch (error) {
      throw new Error(`${name}: ${error.message}`, { cause: error });
    }
  }
}

/** One worker for all calls of a suite: no call may end it. */
function segmenterOf() {
  let started = 0;
  const worker = () => {
    started += 1;
    return new Worker(new URL('../dist/worker-node.js', import.meta.url));
  };
  const segmenter = new index.Segmenter(undefined, { worker });
  after(() => segmenter.close());
  return {
    segmenter,
    checkWorker: async () => {
      assert.equal((await segmenter.segmentPair(first, second)).width, 16);
      assert.equal(started, 1, 'no call has ended the worker');
    },
  };
}

/** In a worker everything is as it is directly. */
const alike = ([direct, there], harmless) => everywhere(direct, harmless, async (value, became) => {
  const other = await outcome(() => there(value));
  if (!isDeepStrictEqual(other, became)) assert.fail(`in a worker: ${inspect(other)}, directly: ${inspect(became)}`);
});

describe('direct calls and workers', () => {
  const { segmenter, checkWorker } = segmenterOf();
  for (const [place, [name, args, harmless]] of Object.entries(CALLS)) test(place, () => alike([index, segmenter].map((calls) => (value) => calls[name](...args(value))), harmless));
  test('the worker is the same', checkWorker);
});

describe('streams, directly and in workers', () => {
  const { segmenter, checkWorker } = segmenterOf();
  const calls = [index.segmentStream, (...args) => segmenter.segmentStream(...args)];
  for (const [place, [args, harmless]] of Object.entries(STREAMS)) test(place, () => alike(calls.map((call) => (value) => all(call(...args(value)))), harmless));
  test('the worker is the same', checkWorker);
});

describe('clips', () => {
  for (const [place, [args, harmless]] of Object.entries(OPENINGS)) {
    test(`openClip: ${place}`, async (t) => {
      const [{ path }, before] = [temporaryFolder(t), process.cwd()];
      process.chdir(path('.'));
      t.after(() => process.chdir(before));
      await everywhere(async (value) => (await index.openClip(...args(value))).close(), harmless);
    });
  }

  // They are checked where they are called: in a worker nothing is other.
  let clip;
  before(async () => {
    clip = await index.openClip([first, second]);
    await clip.segment({ quality: 'fast' });
    await clip.annotate({ frame: 0, object: 1, mask: new Uint8Array(256).fill(1, 0, 64) });
  });
  after(() => clip.close());
  for (const [place, [name, args, harmless]] of Object.entries(COMMANDS)) {
    test(place, async () => {
      const { undo } = clip.steps;
      await everywhere(async (value) => {
        const result = await clip[name](...args(value));
        while (clip.steps.undo > undo) await clip.undo();
        return result;
      }, harmless);
      assert.deepEqual([clip.steps.undo, clip.steps.waiting], [undo, 0]);
    });
  }
});

describe('segmentPairs and pools', () => {
  test('pairs that are none', () => {
    const iterable = (value) => [VALUES['empty list'], VALUES['list of null'], VALUES['sparse list']].includes(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView)) || value === VALUES.map || typeof value === 'string';
    return everywhere((value) => all(index.segmentPairs(iterable(value) ? 5 : value, { jobs: 1 })), []);
  });
  test('options', () => everywhere((value) => all(index.segmentPairs([], value)), named((value) => typeof value === 'object' && value !== null && !Array.isArray(value)).concat('undefined')));
  test('signal', () => everywhere((value) => all(index.segmentPairs([], { signal: value })), ['undefined']));

  test('a pair, and an option of all pairs', async (t) => {
    const pool = new index.SegmenterPool({ jobs: 1 });
    t.after(() => pool.close());
    for (const [name, value] of Object.entries(VALUES)) {
      const good = { first, second };
      // A value that cannot even be awaited is an error of the source.
      const inputs = [/throwing|proxy/.test(name) ? undefined : value, { first: value, second }, { first, second: value }, good];
      const outcomes = await all(pool.segmentPairs(inputs));
      assert.deepEqual(outcomes.map(({ error }) => error !== undefined), [true, true, true, false]);
      for (const { error } of outcomes.slice(0, 3)) checked(error);
    }
    for (const options of [{ nonsense: 1 }, { motions: () => 5 }, { quality: null }, { onProgress: () => { throw new Error('mine'); } }]) {
      const [{ error }] = await all(pool.segmentPairs([{ first, second }], options));
      checked(error);
    }
  });

  for (const [name, make] of [['SegmenterPool', (options) => new index.SegmenterPool(options)], ['Segmenter', (options) => new index.Segmenter(undefined, options)]]) {
    test(`new ${name}`, async () => {
      await everywhere(make, OPTIONS);
      await everywhere((worker) => make({ worker }), ['undefined', 'function']);
      await everywhere((nonsense) => make({ nonsense }), ['undefined']);
    });
  }

  test('jobs, a source, a source of points, and what a function makes instead of a worker', async () => {
    const using = async (segmenter, call) => {
      try {
        return await call(segmenter);
      } finally {
        segmenter.close();
      }
    };
    const segment = (segmenter) => segmenter.segmentPair(first, second);
    await everywhere((jobs) => new index.SegmenterPool({ jobs }), ['undefined', 'one']);
    await everywhere((value) => using(new index.Segmenter(value), segment), ['undefined', 'null']);
    await everywhere((value) => using(new index.Segmenter(undefined, { points: value }), (segmenter) => segmenter.fitMotions(measurements)), ['undefined', 'null']);
    await everywhere((value) => using(new index.Segmenter(undefined, { worker: () => value }), segment), []);
    const cause = new Error('mine');
    const error = await failure(using(new index.Segmenter(undefined, { worker: () => { throw cause; } }), segment));
    assert.deepEqual([checked(error).code, error.cause], ['worker-failed', cause]);
  });
});

describe('pictures and labels', () => {
  test('groupLabels', async () => {
    await everywhere((value) => index.groupLabels(value), []);
    await everywhere((value) => index.groupLabels({ labels: value, motions: [] }), ['no bytes', 'three bytes', 'shared bytes', 'bytes that are called something else']);
    await everywhere((value) => index.groupLabels({ labels: found.labels, motions: value }), ['empty list']);
    await everywhere((value) => index.groupLabels({ labels: found.labels, motions: [value] }), []);
    await everywhere((value) => index.groupLabels({ labels: found.labels, motions: [{ label: 0, group: value }] }), ['zero', 'one']);
    await everywhere((value) => index.groupLabels({ labels: found.labels, motions: [{ label: value, group: 0 }] }), ['zero', 'one']);
  });

  test('codecs', async () => {
    await everywhere((value) => codecs.decodeImage(value), []);
    const palette = index.davisPalette();
    for (const [channels, options] of [[1], [3], [1, { palette }]]) {
      const bytes = new Uint8Array(4 * 4 * channels);
      // 16 bytes are also four pixels of four.
      const four = channels === 1 && !options ? ['one'] : [];
      await everywhere((value) => codecs.encodePng(value, 4, bytes, options), four);
      await everywhere((value) => codecs.encodePng(4, value, bytes, options), four);
      await everywhere((value) => codecs.encodePng(2 ** 32 + 4, 4, value, options), []);
      await everywhere((value) => codecs.encodePng(4, 4, value, options), ['bytes that are called something else']);
    }
    await everywhere((value) => codecs.encodePng(4, 4, new Uint8Array(16), value), OPTIONS);
    await everywhere((value) => codecs.encodePng(4, 4, new Uint8Array(16), { nonsense: value }), ['undefined']);
    await everywhere((value) => codecs.encodePng(4, 4, new Uint8Array(16), { palette: value }), ['undefined']);
    await everywhere((value) => codecs.encodePng(4, 4, new Uint8Array(16), { palette: [[0, 0, value]] }), ['zero', 'half', 'one']);
    assert.equal((await codecs.decodeImage(png(first))).width, 16);
  });

  test('what the attributes of the element may say', async () => {
    for (const [name, values] of Object.entries({
      motions: ['0', '11', '2.5', 'AUTO', 'two', '1e9', '-1', 'NaN', '0x'],
      quality: ['good', 'FAST', '1', 'null'],
    })) {
      for (const value of values) {
        const options = optionsOf((asked) => (asked === name ? value : null));
        const { code, message } = await outcome(() => index.segmentPair(first, second, options));
        assert.equal(code, 'invalid-option', value);
        assert.ok(message.includes(`'${name}'`), message);
      }
    }
    assert.deepEqual(optionsOf(() => ''), { subject: true }, 'what is set without a value is on, or as if it were not there');
    assert.deepEqual([...VeroneseSegmenterElement.observedAttributes].sort(), ['first', 'grouped', 'motions', 'name', 'quality', 'required', 'second', 'src', 'subject']);
  });
});

describe('formats', () => {
  const labels = Uint8Array.of(0, 1, 255, 1);
  const frame = { labels, width: 2, height: 2 };
  const { encode, readMask } = formats;

  test('format and metadata', async () => {
    await everywhere((value) => encode(value, frame), []);
    const call = (metadata) => encode('label-studio', [frame], metadata);
    await everywhere(call, OPTIONS);
    await everywhere((value) => call({ nonsense: value }), ['undefined']);
    const text = ['undefined', 'text', 'empty text'];
    for (const name of ['clip', 'fromName', 'toName', 'modelVersion']) await everywhere((value) => call({ [name]: value }), text);
    await everywhere((value) => call({ names: value }), ['undefined', 'empty list', 'sparse list', ...EMPTY]);
    await everywhere((value) => call({ names: { 1: value } }), text);
    await everywhere((value) => call({ classes: value }), ['undefined', 'empty list']);
    await everywhere((value) => call({ classes: [value] }), ['text', 'empty text']);
    await everywhere((value) => call({ labels: value }), ['undefined', 'empty list']);
    await everywhere((value) => call({ labels: [value] }), ['zero', 'one']);
    await everywhere((value) => call({ tracked: value }), ['undefined', 'true', 'false']);
    await everywhere((value) => call({ frameRate: value }), ['undefined', ...named((value) => Number.isFinite(value) && value > 0)]);
    await everywhere((value) => call({ timestamps: value }), ['undefined', 'empty list']);
    await everywhere((value) => call({ timestamps: [value] }), FINITE);
    await everywhere((value) => call({ tolerance: value }), ['undefined', ...named((value) => Number.isFinite(value) && value >= 0)]);
    await everywhere((value) => call({ shape: value }), ['undefined']);
    await assert.rejects(call({ classes: ['a', 'a'] }), { code: 'invalid-option' });
  });

  async function* later(...frames) {
    yield* frames;
  }

  test('frames, also those that come later', async () => {
    for (const call of [(frame) => encode('coco-polygon', frame), (frame) => encode('coco-polygon', [{ ...frame }]), (frame) => encode('coco-polygon', later(frame))]) {
      for (const name of ['labels', 'width', 'height']) await everywhere((value) => call({ ...frame, [name]: value }), []);
      const matrix = [0, 0, 0, 0, 0, 0];
      await everywhere((value) => call({ ...frame, motions: value }), ['undefined', 'empty list']);
      await everywhere((value) => call({ ...frame, motions: [value] }), []);
      await everywhere((value) => call({ ...frame, motions: [{ label: value, matrix }] }), ['zero', 'one']);
      await everywhere((value) => call({ ...frame, motions: [{ label: 1, matrix: matrix.with(2, value) }] }), FINITE);
      await everywhere((value) => call({ ...frame, index: value }), ['undefined', 'zero', 'one', '300', 'more than 32 bits']);
      await assert.rejects(call({ ...frame, motions: [1, 1].map((label) => ({ label, matrix })) }), { code: 'invalid-input', message: 'motions has a label twice' });
    }
  });

  // Of each kind one: a document, tracks, pictures.
  for (const [format, ...more] of [['coco-polygon', 'empty text'], ['cvat-video', 'empty text'], ['davis']]) {
    test(`${format}: names of frames, and lists of what is no frame`, async () => {
      await everywhere((value) => encode(format, [frame, { ...frame, image: value }]), ['undefined', 'text', ...more]);
      await everywhere((value) => encode(format, value), []);
      await everywhere((value) => encode(format, [frame, value]), []);
      await everywhere((value) => encode(format, later(frame, value)), []);
    });
  }

  test('readMask', async () => {
    const call = (source, options) => readMask(source, options);
    await everywhere(call, []);
    await everywhere((png) => call({ png }), []);
    await everywhere((rle) => call({ rle }), []);
    await everywhere((counts) => call({ rle: { size: [2, 2], counts } }), []);
    await everywhere((count) => call({ rle: { size: [2, 2], counts: [4, count] } }), ['zero']);
    await everywhere((side) => call({ rle: { size: [side, 1], counts: [1] } }), ['one']);
    await everywhere((id) => call({ rle: { size: [2, 2], counts: [0, 4] }, id }), ['undefined', 'one']);
    await everywhere((data) => call({ data, width: 2, height: 2 }), ['bytes that are called something else']);
    await everywhere((width) => call({ data: new Uint8Array(4), width, height: 1 }), ['one']);
    await everywhere((options) => call({ data: new Uint8Array(4), width: 1, height: 1 }, options), OPTIONS);
    await everywhere((levels) => call({ data: new Uint8Array(4), width: 1, height: 1 }, { levels }), ['undefined', 'one', '300']);
  });
});
