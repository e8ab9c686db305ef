import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { fitMotions, groupLabels, segmentPair, VeroneseError } from 'veronese';
import { api as codecsApi, decodeImage } from '../dist/codecs.js';
import { frame, pair, points } from './support/frames.mjs';
import { checkLabels, checkPair, checkPoints, failure, timeless } from './support/shapes.mjs';
import { cases } from './support/soak.mjs';

describe('segmentPair', () => {
  test('gives every field of the contract', async () => {
    const result = await segmentPair(...pair({ width: 64, height: 48 }));
    checkPair(result, 64, 48);
    checkLabels(result.labels, result);
    assert.equal(Object.getPrototypeOf(result.labels), Uint8Array.prototype);
    assert.equal(result.labels.byteOffset, 0);
    assert.equal(result.labels.buffer.byteLength, 64 * 48, 'a copy of its own, not a view of the module');
    const { software, ...settings } = result.settings;
    assert.deepEqual(settings, { motions: 'auto', quality: 'best', markUnknown: false, subject: false });
    assert.equal(result.unlabelled, 0, 'nothing is unlabelled unless asked for');
    assert.deepEqual(structuredClone(result), result);
    assert.equal(JSON.stringify(result).includes('null'), false);
  });

  test('takes every option and says so in settings', async () => {
    const options = { motions: 1, quality: 'fast', markUnknown: true, subject: true };
    const result = await segmentPair(...pair(), options);
    checkPair(result, 64, 48);
    const { software, ...settings } = result.settings;
    assert.deepEqual(settings, options);
    assert.equal(result.count, 1);
  });

  test('says how sure every label is where it is asked, by an array of its own', async () => {
    const without = await segmentPair(...pair());
    assert.equal('confidence' in without, false);
    const { confidence, ...rest } = await segmentPair(...pair(), { confidence: true });
    assert.deepEqual(timeless(rest), timeless(without));
    assert.equal(Object.getPrototypeOf(confidence), Uint8Array.prototype);
    assert.deepEqual([confidence.length, confidence.buffer.byteLength], [64 * 48, 64 * 48]);
    const mean = confidence.reduce((sum, sure) => sum + sure, 0) / confidence.length;
    assert.ok(mean > 128, `mean confidence ${mean}`);
    assert.equal((await segmentPair(...pair(), { confidence: false })).confidence, undefined);
  });

  test('has a junction of motions that touch, with either quality', async () => {
    const sample = (name) => decodeImage(readFileSync(new URL(`../../www/public/samples/intel-two-cars/${name}.png`, import.meta.url)));
    const frames = [await sample('first'), await sample('second')];
    for (const quality of cases(['fast'], ['best'])) {
      const { junctions, labels, width, motions } = await segmentPair(...frames, { quality });
      assert.ok(junctions.length >= 2, quality);
      const touching = new Set();
      labels.forEach((label, p) => {
        const right = (p + 1) % width === 0 ? label : labels[p + 1];
        for (const other of [right, labels[p + width] ?? label]) if (other !== label) touching.add([label, other].sort().join());
      });
      for (const junction of junctions) assert.ok(touching.has(junction.labels.join()), `${quality}: ${junction.labels}`);
      // A pair that was joined for its continuous flow is likelier to be one thing than a car and the road.
      const likelihoods = (joined) =>
        junctions.filter(({ labels: [a, b] }) => (motions[a].group === motions[b].group) === joined).map(({ likelihood }) => likelihood);
      assert.ok(Math.min(...likelihoods(true), 1) > Math.min(...likelihoods(false)), quality);
    }
  });

  test('takes bytes of any kind and views into a larger buffer alike, leaves them as they were, and gives the same bits from the build with codecs', async () => {
    const [first, second] = pair();
    const copies = structuredClone([first, second]);
    const expected = timeless(await segmentPair(first, second));
    assert.deepEqual([first, second], copies);
    const shifted = new Uint8Array(first.data.length + 5);
    shifted.set(first.data, 5);
    for (const data of [new Uint8Array(first.data), Buffer.from(first.data), shifted.subarray(5)]) {
      assert.deepEqual(timeless(await segmentPair({ ...first, data }, second)), expected);
    }
    assert.deepEqual(timeless(await codecsApi.segmentPair(first, second)), expected);
  });

  test('constant and identical frames, smallest and oblong ones get an answer', async () => {
    const grey = { data: new Uint8Array(64 * 48 * 4).fill(90), width: 64, height: 48 };
    const sizes = [[16, 16], [16, 300], [300, 16], [17, 19]];
    for (const frames of [[grey, grey], [frame(0), frame(0)], ...sizes.map(([width, height]) => pair({ width, height }))]) {
      const result = await segmentPair(...frames);
      checkPair(result, frames[0].width, frames[0].height);
      checkLabels(result.labels, result);
    }
  });
});

describe('segmentPair refuses', () => {
  const [first, second] = pair();
  const bytes = (n) => new Uint8Array(n);
  const cases = [
    ['frames that differ in size', 'frame-size-mismatch', [first, frame(1, { width: 65 })]],
    ['a 1×1 frame', 'frame-size-unsupported', [{ data: bytes(4), width: 1, height: 1 }, second]],
    ['a 0×0 frame', 'frame-size-unsupported', [{ data: bytes(0), width: 0, height: 0 }, second]],
    ['a side of 4097', 'frame-size-unsupported', [{ data: bytes(4097 * 16 * 4), width: 4097, height: 16 }, second]],
    ['too few bytes', 'pixel-count-mismatch', [{ ...first, data: bytes(100) }, second]],
    ['RGB bytes', 'pixel-count-mismatch', [{ ...first, data: bytes(64 * 48 * 3) }, second]],
    ['no second frame', 'invalid-input', [first]],
    ['a width of 64.5', 'invalid-input', [{ ...first, width: 64.5 }, second]],
    ['a frame before, which is no option', 'invalid-option', [first, second, { before: first }]],
    ['a seed, which is no option', 'invalid-option', [first, second, { seed: 1 }]],
    ['a misspelt option', 'invalid-option', [first, second, { motion: 2 }]],
    ['an option of fitMotions', 'invalid-option', [first, second, { method: 'paper' }]],
    ['eleven motions', 'invalid-option', [first, second, { motions: 11 }]],
    ['an unknown quality', 'invalid-option', [first, second, { quality: 'slow' }]],
  ];
  for (const [title, code, args] of cases) test(title, () => refuses(segmentPair, code, args));
});

/** With an error of this code, in one line. */
async function refuses(call, code, args) {
  const error = await failure(call(...args));
  assert.ok(error instanceof VeroneseError, error.stack);
  assert.deepEqual([error.name, error.code], ['VeroneseError', code], error.message);
  assert.match(error.message, /^[^\n]{10,}$/);
}

describe('fitMotions', () => {
  test('gives every field of the contract', async () => {
    for (const method of ['paper', 'best']) {
      const result = await fitMotions(points(60, 1.5, -0.5), { motions: 1, method });
      checkPoints(result, 60);
      assert.equal(result.count, 1);
      assert.equal('stages' in result, method === 'paper');
      const [, , u, , , v] = result.motions[0].matrix;
      assert.ok(Math.hypot(u - 1.5, v + 0.5) < 1e-6);
    }
  });

  test('labels are a Uint8Array of their own, settings say what was asked; the build with codecs gives the same bits', async () => {
    const options = { motions: 1, method: 'paper', seed: 3 };
    const result = await fitMotions(points(60, 1.5, -0.5), options);
    assert.equal(Object.getPrototypeOf(result.labels), Uint8Array.prototype);
    const { software, ...settings } = result.settings;
    assert.deepEqual(settings, options);
    assert.deepEqual(timeless(await codecsApi.fitMotions(points(60, 1.5, -0.5), options)), timeless(result));
  });

  const whole = points(60, 1, 1);
  const { positions, derivatives } = whole;
  const withEntry = (array, value) => array.with(7, value);
  const cases = [
    ['nothing', 'invalid-input', [undefined]],
    ['lists instead of Float64Array', 'invalid-input', [{ positions: [1, 2], derivatives: [1, 2, 3] }]],
    ['Float32Array', 'invalid-input', [{ positions: new Float32Array(2), derivatives: new Float32Array(3) }]],
    ['half a position', 'invalid-input', [{ positions: positions.subarray(1), derivatives }]],
    ['two thirds of a derivative', 'invalid-input', [{ positions, derivatives: derivatives.subarray(1) }]],
    ['fewer derivatives than positions', 'measurement-count-mismatch', [{ positions, derivatives: derivatives.subarray(3) }]],
    ['a NaN position', 'not-finite', [{ positions: withEntry(positions, NaN), derivatives }]],
    ['an infinite derivative', 'not-finite', [{ positions, derivatives: withEntry(derivatives, -Infinity) }]],
    ['a misspelt option', 'invalid-option', [whole, { methods: 'paper' }]],
    ['an option of segmentPair', 'invalid-option', [whole, { quality: 'best' }]],
    ['an unknown method', 'invalid-option', [whole, { method: 'ours' }]],
    ['eleven motions', 'invalid-option', [whole, { motions: 11 }]],
    ['no measurements', 'too-few-measurements', [{ positions: new Float64Array(0), derivatives: new Float64Array(0) }]],
    ['fewer measurements than motions need', 'too-few-measurements', [points(20, 1, 1), { motions: 10 }]],
  ];
  for (const [title, code, args] of cases) test(`refuses ${title}`, () => refuses(fitMotions, code, args));
});

describe('progress and signal', () => {
  test('every stage is reported and timed', async () => {
    const seen = [];
    const result = await segmentPair(...pair(), { onProgress: (progress) => seen.push(progress) });
    assert.ok(seen.length > 0);
    for (const { stage, index, of } of seen) {
      assert.ok(Number.isInteger(index) && index >= 0 && index < of);
      assert.ok(stage in result.milliseconds, stage);
    }
    assert.deepEqual(Object.keys(result.milliseconds).sort(), ['total', ...new Set(seen.map(({ stage }) => stage))].sort());
    const { total, ...stages } = result.milliseconds;
    assert.ok(Object.values(stages).reduce((sum, value) => sum + value, 0) <= total + 1e-6);
  });

  test('what a listener throws is thrown on, and the next call is not harmed', async () => {
    const expected = timeless(await segmentPair(...pair()));
    const mine = new TypeError('mine');
    const throwing = { onProgress: () => { throw mine; } };
    assert.equal(await failure(segmentPair(...pair(), throwing)), mine);
    assert.deepEqual(timeless(await segmentPair(...pair())), expected);
    // Calls that were already waiting for the instance when it was let go of.
    const [failed, ...rest] = await Promise.allSettled([
      segmentPair(...pair(), throwing), segmentPair(...pair()), segmentPair(...pair()),
    ]);
    assert.equal(failed.reason, mine);
    for (const { value } of rest) assert.deepEqual(timeless(value), expected);
  });

  test('an aborted signal cancels before the work, and in a listener during it', async () => {
    const reason = new Error('changed my mind');
    const before = await failure(segmentPair(...pair(), { signal: AbortSignal.abort(reason) }));
    assert.ok(before instanceof VeroneseError);
    assert.equal(before.code, 'cancelled');
    assert.equal(before.cause, reason);
    const controller = new AbortController();
    const during = segmentPair(...pair(), { signal: controller.signal, onProgress: () => controller.abort() });
    assert.equal((await failure(during)).code, 'cancelled');
    checkPair(await segmentPair(...pair()), 64, 48);
  });
});

test('groupLabels merges the labels of a group and keeps 255', () => {
  const motions = [{ label: 0, group: 0 }, { label: 1, group: 1 }, { label: 2, group: 0 }];
  const labels = Uint8Array.of(0, 1, 2, 255, 2, 1);
  assert.deepEqual(groupLabels({ labels, motions }), Uint8Array.of(0, 1, 0, 255, 0, 1));
  assert.deepEqual(labels, Uint8Array.of(0, 1, 2, 255, 2, 1), 'the labels themselves stay');
});

test('the codes in the types are those of the Rust side and of the sources', () => {
  const read = (path) => readFileSync(new URL(path, import.meta.url), 'utf8');
  const declared = read('../types/index.d.ts').match(/ErrorCode =[^;]+;/)[0];
  const sources = readdirSync(new URL('../src/', import.meta.url), { recursive: true }).filter((name) => name.endsWith('.ts'));
  const thrown = sources.flatMap((name) => Array.from(read(`../src/${name}`).matchAll(/new VeroneseError\('([a-z-]+)'/g), ([, code]) => code));
  const rust = Array.from(read('../../src/error.rs').matchAll(/=> "([a-z-]+)"/g), ([, code]) => code);
  assert.ok(rust.length >= 8 && thrown.length > 0);
  for (const code of [...rust, ...thrown]) assert.ok(declared.includes(`'${code}'`), `${code} is missing in types/index.d.ts`);
});
