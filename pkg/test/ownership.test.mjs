// Who owns the bytes: what a call needs is taken when it is made, whatever happens to the caller's arrays afterwards.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { Worker } from 'node:worker_threads';
import { decode } from 'fast-png';
import { fitMotions, segmentPair, segmentPairs, Segmenter, SegmenterPool } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';
import { encode } from 'veronese/formats';
import { Api } from '../build/calls/api.js';
import { Core } from '../build/module/core.js';
import { glue } from '../build/module/glue.js';
import { glue as pointsGlue } from '../build/module/glue-points.js';
import { frame, pair, points, png } from './support/frames.mjs';
import { failure, timeless } from './support/shapes.mjs';

const module = (file) => new URL(`../wasm/${file}_bg.wasm`, import.meta.url);
const read = async (place) => readFileSync(place);

/** The direct calls on modules that are yet to be loaded. */
function unloaded() {
  glue.forgetInstance();
  pointsGlue.forgetInstance();
  return new Api(new Core(glue, read, module('veronese')), new Core(pointsGlue, read, module('points/veronese_points')));
}

function pool(t) {
  const made = new SegmenterPool({ jobs: 1 });
  t.after(() => made.close());
  return made;
}

const HOSTS = {
  'direct, the module not loaded': unloaded,
  'direct, the module loaded': () => ({ segmentPair, fitMotions }),
  'in a worker that is busy': (t) => {
    const busy = pool(t);
    void busy.segmentPair(...pair());
    return busy;
  },
};

const scribble = (arrays) => arrays.forEach((array) => array.fill(77));

/** Copies that may be written to. */
const own = ({ data, ...rest }) => ({ ...rest, data: new Uint8Array(data) });
const [first, second] = pair();
const found = await segmentPair(first, second);

/** Arguments of each call, the arrays in them that can be given away, and what writes to the rest. */
const CALLS = {
  segmentPair: () => {
    const frames = [own(first), own(second)];
    return { args: frames, arrays: frames.map(({ data }) => data), spoil: () => frames.forEach((frame) => (frame.width = 3)) };
  },
  fitMotions: () => {
    const measurements = points(80, 1, 2);
    return { args: [measurements], arrays: Object.values(measurements), spoil: () => {} };
  },
};
const WANTED = {
  segmentPair: timeless(found),
  fitMotions: timeless(await fitMotions(points(80, 1, 2))),
};

describe('arguments that are written to after the call, or given away, change nothing', () => {
  for (const [title, make] of Object.entries(HOSTS)) {
    for (const [name, prepare] of Object.entries(CALLS)) {
      test(`${name}, ${title}`, async (t) => {
        for (const options of [undefined, { transfer: true }]) {
          const { args, arrays, spoil } = prepare();
          const result = make(t)[name](...args, options);
          if (options) assert.deepEqual(arrays.map(({ length }) => length), arrays.map(() => 0), 'at once');
          else scribble(arrays);
          spoil();
          assert.deepEqual(timeless(await result), WANTED[name]);
        }
      });
    }
  }

  test('segmentPairs, from a generator that has one buffer for each frame', async () => {
    const input = (number) => pair({ square: [number % 4, 1] });
    async function* reusing() {
      const [one, other] = [own(first), own(second)];
      for (let number = 0; number < 7; number++) {
        const [from, to] = input(number);
        one.data.set(from.data);
        other.data.set(to.data);
        yield { first: one, second: other };
      }
    }
    for await (const { index, segmentation } of segmentPairs(reusing(), { jobs: 2 })) {
      assert.deepEqual(timeless(segmentation), timeless(await segmentPair(...input(index))), `pair ${index}`);
    }
  });

  test('decodeImage and encodePng', async () => {
    const picture = frame(0, { width: 37, height: 21 });
    const file = Uint8Array.from(png(picture));
    const decoded = decodeImage(file);
    scribble([file]);
    assert.deepEqual(new Uint8Array((await decoded).data), new Uint8Array(picture.data));
    const palette = Array.from({ length: 256 }, (_, k) => [k, 255 - k, 7]);
    for (const [channels, options] of [[1], [3], [1, { palette }]]) {
      const bytes = Uint8Array.from({ length: 15 * channels }, (_, k) => k);
      const [wanted, encoded] = [[...bytes], encodePng(5, 3, bytes, options)];
      scribble([bytes]);
      assert.deepEqual([...decode(await encoded).data], wanted);
    }
  });
});

/** A segmenter whose messages to its worker are looked at. */
function watched(t) {
  const posted = [];
  const worker = () => {
    const made = new Worker(new URL('../dist/worker-node.js', import.meta.url));
    const post = made.postMessage.bind(made);
    made.postMessage = (message, ...rest) => {
      posted.push({ bytes: [...buffersIn(message.task)].reduce((sum, { byteLength }) => sum + byteLength, 0) });
      post(message, ...rest);
    };
    return made;
  };
  const made = new Segmenter(undefined, { worker });
  t.after(() => made.close());
  return { segmenter: made, posted };
}

function buffersIn(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) found.add(value.buffer);
  else if (typeof value === 'object' && value !== null) Object.values(value).forEach((entry) => buffersIn(entry, found));
  return found;
}

describe('what goes to a worker', () => {
  const size = 64 * 48 * 4;

  /** The frames as views into one large buffer. */
  function views(Buffer = ArrayBuffer, options) {
    const buffer = new Buffer(64 * size, options);
    return [first, second].map(({ data, ...rest }, k) => {
      const view = new Uint8Array(buffer, (7 + k) * size, size);
      view.set(data);
      return { ...rest, data: view };
    });
  }

  test('is what the views show, not the whole buffer', async (t) => {
    const { segmenter, posted } = watched(t);
    await segmenter.segmentPair(...views());
    const { positions, derivatives } = points(80, 1, 2);
    const wide = new Float64Array(2 ** 16);
    wide.set(positions, 5);
    wide.set(derivatives, 1000);
    await segmenter.fitMotions({ positions: wide.subarray(5, 165), derivatives: wide.subarray(1000, 1240) });
    assert.deepEqual(posted.map(({ bytes }) => bytes), [2 * size, 8 * (160 + 240)]);
  });

  test('may be shared or resizable memory', async (t) => {
    const { segmenter } = watched(t);
    for (const frames of [views(SharedArrayBuffer), views(ArrayBuffer, { maxByteLength: 128 * size }), views(SharedArrayBuffer, { maxByteLength: 128 * size })]) {
      for (const transfer of [false, true]) {
        const again = frames.map(({ data, ...rest }) => ({ ...rest, data }));
        const call = transfer && frames[0].data.buffer instanceof ArrayBuffer ? frames.map(own) : again;
        assert.deepEqual(timeless(await segmenter.segmentPair(...call, { transfer })), WANTED.segmentPair);
        assert.deepEqual(timeless(await segmentPair(...again)), WANTED.segmentPair);
      }
    }
  });

  test('leaves nothing of the caller behind while the call waits', async (t) => {
    setFlagsFromString('--expose-gc');
    const collect = runInNewContext('gc');
    const lane = pool(t);
    const running = lane.segmentPair(...pair({ width: 1024, height: 1024 }));
    const weak = [];
    const waiting = (() => {
      const frames = [own(first), own(second)];
      const measurements = points(80, 1, 2);
      const owned = [...frames.map(({ data }) => data.buffer), ...Object.values(measurements).map(({ buffer }) => buffer)];
      weak.push(...owned.map((buffer) => new WeakRef(buffer)));
      return [lane.segmentPair(...frames), lane.fitMotions(measurements)];
    })();
    await new Promise((resolve) => setImmediate(resolve));
    collect();
    assert.deepEqual(weak.map((reference) => reference.deref()), [undefined, undefined, undefined, undefined]);
    lane.close();
    for (const call of [running, ...waiting]) assert.equal((await failure(call)).code, 'cancelled');
  });
});

describe('transfer: true', () => {
  test('both frames in one buffer, and one frame twice', async (t) => {
    const worker = pool(t);
    const size = first.data.length;
    const twoIn = () => {
      const both = new Uint8Array(2 * size + 3);
      both.set(first.data, 3);
      both.set(second.data, size + 3);
      return [{ ...first, data: both.subarray(3, size + 3) }, { ...second, data: both.subarray(size + 3) }];
    };
    for (const calls of [{ segmentPair }, worker]) {
      assert.deepEqual(timeless(await calls.segmentPair(...twoIn(), { transfer: true })), WANTED.segmentPair);
      const still = own(first);
      assert.equal((await calls.segmentPair(still, still, { transfer: true })).count, 1);
    }
  });

  test('what cannot be given away is copied', async (t) => {
    const tiny = pair({ width: 16, height: 16 });
    const pooled = tiny.map(({ data, ...rest }) => ({ ...rest, data: Buffer.from(data) }));
    assert.ok(pooled[0].data.buffer.byteLength > pooled[0].data.length, "one of Node's shared pools");
    const memory = new WebAssembly.Memory({ initial: 1 });
    const inModule = tiny.map(({ data, ...rest }, k) => ({ ...rest, data: new Uint8Array(memory.buffer, 2048 * k, data.length) }));
    inModule.forEach(({ data }, k) => data.set(tiny[k].data));
    const wanted = timeless(await segmentPair(...tiny));
    for (const calls of [{ segmentPair }, pool(t)]) {
      for (const frames of [pooled, inModule]) {
        assert.deepEqual(timeless(await calls.segmentPair(...frames, { transfer: true })), wanted);
        assert.equal(frames[0].data.length, 16 * 16 * 4);
      }
    }
  });

  test('in segmentPairs too; a frame that was given away is refused', async () => {
    const shared = own(second);
    const outcomes = [];
    for await (const { error } of segmentPairs([{ first: own(first), second: shared }, { first: shared, second: own(first) }], { jobs: 1, transfer: true })) outcomes.push(error);
    assert.deepEqual([outcomes[0], outcomes[1].code, /given away/.test(outcomes[1].message)], [undefined, 'invalid-input', true]);
  });

  test('nothing is given away by a call that is refused', async (t) => {
    for (const calls of [{ segmentPair }, pool(t)]) {
      const frames = [own(first), own(second)];
      for (const options of [{ transfer: true, nonsense: 1 }, { transfer: true, motions: {} }, { transfer: 1 }, { transfer: true, signal: AbortSignal.abort() }]) {
        assert.match((await failure(calls.segmentPair(...frames, options))).code, /^(invalid-|cancelled)/);
        assert.deepEqual(frames.map(({ data }) => data.length), [first.data.length, second.data.length]);
      }
    }
  });
});

test('what is encoded at once is taken before the call returns', async () => {
  const frame = { labels: Uint8Array.of(0, 1), width: 2, height: 1, motions: [{ label: 1, matrix: [1, 2, 3, 4, 5, 6] }] };
  for (const format of ['coco', 'davis']) {
    for (const make of [(frame) => frame, (frame) => [frame]]) {
      const [expected, mine] = [await encode(format, make(structuredClone(frame))), structuredClone(frame)];
      const files = encode(format, make(mine));
      scribble([mine.labels]);
      mine.motions[0].matrix.fill(99);
      assert.deepEqual(await files, expected, format);
    }
  }
});
