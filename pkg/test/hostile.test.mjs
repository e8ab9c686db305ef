// Every public entry with values that are not what it takes. A call either works or rejects with a VeroneseError of a published code,
// never `internal`; workers say the same as direct calls, word for word, and go on working.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, describe, test } from 'node:test';
import { inspect, isDeepStrictEqual } from 'node:util';
import { Worker } from 'node:worker_threads';
import * as index from 'veronese';
import * as codecs from 'veronese/codecs';
import { VeroneseSegmenterElement } from 'veronese/element-class';
import * as formats from 'veronese/formats';
import * as inline from 'veronese/inline';
import * as slim from 'veronese/slim';
import { glue } from '../build/module/glue.js';
import { optionsOf } from '../build/element/options.js';
import { png } from './support/frames.mjs';
import { CALLS, CLIPS, EMPTY, FINITE, OPTIONS, VALUES, all, checked, first, found, measurements, named, outcome, second } from './support/hostile.mjs';
import { failure } from './support/shapes.mjs';
import { soaking } from './support/soak.mjs';

const read = (path) => readFileSync(new URL(path, import.meta.url));

const { throwing, text, floats, NaN: none, 'detached bytes': detached } = VALUES;
const SOME = { throwing, text, floats, none, detached };

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

describe('direct calls and workers', () => {
  const { segmenter, checkWorker } = segmenterOf();
  for (const [place, [name, args, harmless]] of Object.entries(CALLS)) {
    test(place, async () => {
      await everywhere((value) => index[name](...args(value)), harmless, async (value, direct) => {
        const there = await outcome(() => segmenter[name](...args(value)));
        if (!isDeepStrictEqual(there, direct)) assert.fail(`in a worker: ${inspect(there)}, directly: ${inspect(direct)}`);
      });
      await checkWorker();
    });
  }

  // They have the checks in common: with npm run soak all values.
  test('the other entries say the same', async () => {
    await slim.init(read('../wasm/veronese_bg.wasm'));
    await slim.initPoints(read('../wasm/points/veronese_points_bg.wasm'));
    for (const [place, [name, args]] of Object.entries(CALLS)) {
      for (const value of Object.values(soaking ? VALUES : SOME)) {
        // In Node alone the entry reads files.
        const isFile = typeof value === 'string' && value !== '' && /^segmentPair: (first|second)$/.test(place);
        const [expected, ...others] = await Promise.all([...(isFile ? [] : [index]), slim, inline, codecs.api].map(
          (entry) => entry[name](...args(value)).then(() => 'done', ({ name, code, message }) => `${name} ${code}: ${message}`),
        ));
        for (const other of others) assert.equal(other, expected, place);
      }
    }
  });

  test('frames are refused in the words of the core', async () => {
    const cases = [
      [{ data: new Uint8Array(4), width: 1, height: 1 }, second],
      [{ data: new Uint8Array(4 * 16 * 4097), width: 4097, height: 16 }, second],
      [{ ...first, data: new Uint8Array(5) }, second],
      [first, { ...second, data: new Uint8Array(16 * 16 * 3) }],
    ];
    await index.init();
    await glue.instantiate(new WebAssembly.Module(read('../wasm/veronese_bg.wasm')));
    for (const frames of cases) {
      const { code, message } = await failure(index.segmentPair(...frames));
      // The package knows a remedy, too.
      assert.throws(() => glue.segmentPair(...frames, {}, () => {}), { code, message: message.replace(/; option 'maxSize'.*/, '') });
    }
  });
});

describe('clips, directly and in workers', () => {
  const { segmenter, checkWorker } = segmenterOf();
  for (const [place, [args, harmless]] of Object.entries(CLIPS)) {
    test(place, async () => {
      await everywhere((value) => all(index.segmentClip(...args(value))), harmless, async (value, direct) => {
        const there = await outcome(() => all(segmenter.segmentClip(...args(value))));
        if (!isDeepStrictEqual(there, direct)) assert.fail(`in a worker: ${inspect(there)}, directly: ${inspect(direct)}`);
      });
      await checkWorker();
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

  test('new SegmenterPool', async () => {
    await everywhere((value) => new index.SegmenterPool(value), OPTIONS);
    await everywhere((value) => new index.SegmenterPool({ jobs: value }), ['undefined', 'one']);
    await everywhere((value) => new index.SegmenterPool({ worker: value }), ['undefined', 'function']);
    await everywhere((value) => new index.SegmenterPool({ nonsense: value }), ['undefined']);
  });

  test('new Segmenter', async () => {
    await everywhere((value) => new index.Segmenter(undefined, value), OPTIONS);
    await everywhere((value) => new index.Segmenter(undefined, { worker: value }), ['undefined', 'function']);
    await everywhere((value) => new index.Segmenter(undefined, { nonsense: value }), ['undefined']);
  });

  test('a source, a source of points, and what a function makes instead of a worker', async () => {
    const using = async (segmenter, call) => {
      try {
        return await call(segmenter);
      } finally {
        segmenter.close();
      }
    };
    const segment = (segmenter) => segmenter.segmentPair(first, second);
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
    const encoders = [[codecs.encodeGreyPng, 1], [codecs.encodeColourPng, 3], [codecs.encodeIndexedPng, 1]];
    for (const [encoder, channels] of encoders) {
      const bytes = new Uint8Array(4 * 4 * channels);
      const palette = index.davisPalette();
      await everywhere((value) => encoder(value, 4, bytes, palette), []);
      await everywhere((value) => encoder(4, value, bytes, palette), []);
      await everywhere((value) => encoder(2 ** 32 + 4, 4, value, palette), []);
      await everywhere((value) => encoder(4, 4, value, palette), channels === 1 ? ['bytes that are called something else'] : []);
    }
    await everywhere((value) => codecs.encodeIndexedPng(4, 4, new Uint8Array(16), value), []);
    await everywhere((value) => codecs.encodeIndexedPng(4, 4, new Uint8Array(16), [[0, 0, value]]), ['zero', 'half', 'one']);
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

describe('init', () => {
  test('a source that is none', async () => {
    // Instances of their own, which have loaded nothing yet.
    const fresh = async (call) => call(await import(`../dist/slim.js?${Math.random()}`));
    for (const value of Object.values(VALUES)) {
      for (const name of ['init', 'initPoints']) {
        const error = await failure(fresh((entry) => entry[name](value)));
        assert.equal(error.name, 'VeroneseError');
        assert.equal(checked(error).code, 'wasm-load-failed');
      }
    }
  });
});

describe('formats', () => {
  const labels = Uint8Array.of(0, 1, 255, 1);
  const frame = { labels, width: 2, height: 2 };
  const whole = [labels, 2, 2];
  const ONE = ['encodeCoco', 'encodeCvatXml', 'encodeCvatPoints', 'encodeLabelStudio', 'encodeLabelMe', 'encodeYolo', 'encodeSupervisely', 'encodeWebAnnotation', 'encodeVeronese', 'encodeFlow'];
  const SHAPED = ['encodeCoco', 'encodeCvatXml', 'encodeLabelStudio', 'encodeLabelMe'];
  const MANY = ['encodeCocoImages', 'encodeCocoVideo', 'encodeCvatImages', 'encodeCvatVideo', 'encodeCvatMots', 'encodeMots', 'encodeMotChallenge', 'encodeLabelStudioVideo'];
  const calls = {
    ...Object.fromEntries(ONE.map((name) => [name, (meta) => formats[name](...whole, meta)])),
    ...Object.fromEntries(MANY.map((name) => [name, (meta) => formats[name]([frame], meta)])),
  };

  // Frames of MOTS become files of an archive, so that they need a name.
  const imageNames = (name) => ['undefined', 'text', ...(name === 'encodeCvatMots' ? [] : ['empty text'])];

  for (const name of [...ONE, 'encodeDavis', 'encodeCocoRle', 'encodeCocoRleCounts']) {
    test(`${name}: labels and sizes`, async () => {
      await everywhere((value) => formats[name](value, 4, 4), ['bytes that are called something else']);
      await everywhere((value) => formats[name](labels, value, 2), []);
      await everywhere((value) => formats[name](labels, 2, value), []);
    });
  }

  for (const [name, call] of Object.entries(calls)) {
    test(`${name}: what is known beside the labels`, async () => {
      await everywhere(call, OPTIONS);
      await everywhere((value) => call({ image: value }), imageNames(name));
      await everywhere((value) => call({ names: value }), ['undefined', 'empty list', 'sparse list', ...EMPTY]);
      await everywhere((value) => call({ names: { 1: value } }), ['undefined', 'text', 'empty text']);
      await everywhere((value) => call({ classes: value }), ['undefined', 'empty list']);
      await everywhere((value) => call({ classes: [value] }), ['text', 'empty text']);
      await everywhere((value) => call({ motions: value }), ['undefined', 'empty list']);
      await everywhere((value) => call({ motions: [value] }), []);
      await everywhere((value) => call({ motions: [{ label: value, matrix: [0, 0, 0, 0, 0, 0] }] }), ['zero', 'one']);
      await everywhere((value) => call({ motions: [{ label: 1, matrix: [0, 0, value, 0, 0, 0] }] }), FINITE);
      await everywhere((value) => call({ motions: [{ label: 1, matrix: [0, 0, 0, 0, 0, 0], bbox: value }] }), ['undefined']);
      await everywhere((value) => call({ labels: value }), ['undefined', 'empty list']);
      await everywhere((value) => call({ labels: [value] }), ['zero', 'one']);
      await everywhere((value) => call({ nonsense: value }), ['undefined']);
    });
  }

  for (const name of [...SHAPED, 'encodeYolo', 'encodeWebAnnotation']) {
    test(`${name}: options`, async () => {
      await everywhere((value) => formats[name](...whole, {}, value), OPTIONS);
      await everywhere((value) => formats[name](...whole, {}, { shape: value }), ['undefined']);
      await everywhere((value) => formats[name](...whole, {}, { tolerance: value }), ['undefined', 'zero', 'half', 'one', '300', 'more than 32 bits', 'more than 53 bits']);
      await everywhere((value) => formats[name](...whole, {}, { nonsense: value }), ['undefined']);
      await everywhere((value) => formats[name](...whole, {}, { modelVersion: value }), ['undefined', ...(name === 'encodeLabelStudio' ? ['text', 'empty text'] : [])]);
    });
  }

  test('encodeYolo: classes', async () => {
    await everywhere((value) => formats.encodeYolo(...whole, {}, { classes: value }), ['undefined']);
    await everywhere((value) => formats.encodeYolo(...whole, {}, { classes: ['motion-0', 'motion-1', value] }), ['text', 'empty text']);
  });

  for (const name of ['encodeCocoImages', 'encodeCvatImages', 'encodeCvatVideo', 'encodeLabelStudioVideo']) {
    test(`${name}: options`, async () => {
      await everywhere((value) => formats[name]([frame], {}, value), OPTIONS);
      await everywhere((value) => formats[name]([frame], {}, { shape: value }), ['undefined']);
      await everywhere((value) => formats[name]([frame], {}, { nonsense: value }), ['undefined']);
      await everywhere((value) => formats[name]([frame], {}, { modelVersion: value }), ['undefined', ...(name === 'encodeLabelStudioVideo' ? ['text', 'empty text'] : [])]);
    });
  }

  for (const name of MANY) {
    test(`${name}: what is known of the clip`, async () => {
      await everywhere((value) => formats[name]([frame], { clip: value }), ['undefined', 'text', 'empty text']);
      await everywhere((value) => formats[name]([frame], { tracked: value }), ['undefined', 'true', 'false']);
      await everywhere((value) => formats[name]([frame], { frameRate: value }), ['undefined', ...named((value) => Number.isFinite(value) && value > 0)]);
      await everywhere((value) => formats[name]([frame], { timestamps: value }), ['undefined', 'empty list']);
      await everywhere((value) => formats[name]([frame], { timestamps: [value] }), FINITE);
    });

    test(`${name}: frames that come later`, async () => {
      async function* later(...frames) {
        yield* frames;
      }
      assert.deepEqual(await formats[name](later(frame)), formats[name]([frame]));
      await everywhere((value) => formats[name](later(frame, value)), []);
      await everywhere((value) => formats[name](later(frame), value), OPTIONS);
      await assert.rejects(async () => formats[name](later()), { name: 'VeroneseError', code: 'invalid-input' });
    });

    test(`${name}: frames`, async () => {
      await everywhere((value) => formats[name](value), []);
      await everywhere((value) => formats[name]([frame, value]), []);
      await everywhere((value) => formats[name]([{ ...frame, labels: value }]), []);
      await everywhere((value) => formats[name]([{ ...frame, width: value }]), []);
      await everywhere((value) => formats[name]([frame, { ...frame, image: value }]), imageNames(name));
      await everywhere((value) => formats[name]([{ ...frame, motions: value }]), ['undefined', 'empty list']);
    });
  }

  test('decodeVeronese', async () => {
    const document = formats.encodeVeronese(...whole, { names: { 1: 'car' }, motions: found.motions });
    await everywhere((value) => formats.decodeVeronese(value), []);
    const harmless = {
      image: ['text', 'empty text'], motions: ['empty list'], names: EMPTY, convention: Object.keys(VALUES), version: ['one'],
    };
    for (const name of Object.keys(document)) {
      await everywhere((value) => formats.decodeVeronese({ ...document, [name]: value }), harmless[name] ?? []);
    }
    await everywhere((value) => formats.decodeVeronese({ ...document, runs: [0, value] }), []);
    await everywhere((value) => formats.decodeVeronese({ ...document, runs: [value, 4] }), ['zero', 'one']);
  });
});
