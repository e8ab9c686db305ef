import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { fitMotions, segmentPair } from 'veronese';
import * as inline from 'veronese/inline';
import * as slim from 'veronese/slim';
import { pair, points } from './support/frames.mjs';
import { failure, timeless } from './support/shapes.mjs';

const bytes = readFileSync(new URL('../wasm/veronese_bg.wasm', import.meta.url));
const bytesOfPoints = readFileSync(new URL('../wasm/points/veronese_points_bg.wasm', import.meta.url));
const measurements = points(60, 1.5, -0.5);
const worker = () => new Worker(new URL(import.meta.resolve('veronese/worker')));

describe('veronese/inline', () => {
  test('needs no file, and gives the same bits', async () => {
    assert.deepEqual(timeless(await inline.segmentPair(...pair())), timeless(await segmentPair(...pair())));
    assert.deepEqual(timeless(await inline.fitMotions(measurements)), timeless(await fitMotions(measurements)));
  });

  test('runs in workers that the caller makes', async (t) => {
    const segmenter = new inline.Segmenter(undefined, { worker });
    t.after(() => segmenter.close());
    assert.equal((await segmenter.segmentPair(...pair())).width, 64);
    assert.equal((await segmenter.fitMotions(measurements)).count, 1);
    const error = await failure(new inline.Segmenter().segmentPair(...pair()));
    assert.equal(error.code, 'invalid-option');
    assert.match(error.message, /'worker'/);
  });
});

describe('veronese/slim', () => {
  test('waits to be given its module', async (t) => {
    const error = await failure(slim.segmentPair(...pair()));
    assert.equal(error.code, 'wasm-load-failed');
    await slim.init(await WebAssembly.compile(bytes));
    assert.equal((await slim.segmentPair(...pair())).width, 64);
    const segmenter = new slim.Segmenter(bytes, { worker });
    t.after(() => segmenter.close());
    assert.equal((await segmenter.segmentPair(...pair())).width, 64);
    for await (const { segmentation } of slim.segmentPairs([{ first: pair()[0], second: pair()[1] }], { source: bytes, worker, jobs: 1 })) {
      assert.equal(segmentation.width, 64);
    }
  });
});

test('measurements have a module of their own, which veronese/slim waits for and workers are given when they need it', async (t) => {
  assert.equal((await failure(slim.fitMotions(measurements))).code, 'wasm-load-failed');
  const wrong = await failure(slim.initPoints(bytes));
  assert.equal(wrong.code, 'wasm-load-failed');
  assert.match(wrong.message, /no fitMotions/);
  await slim.initPoints(bytesOfPoints);
  assert.equal((await slim.fitMotions(measurements)).count, 1);

  const segmenter = new slim.Segmenter(bytes, { points: bytesOfPoints, worker });
  t.after(() => segmenter.close());
  for (let k = 0; k < 2; k++) {
    assert.equal((await segmenter.fitMotions(measurements)).count, 1);
    assert.equal((await segmenter.segmentPair(...pair())).width, 64);
  }
  let made = 0;
  const counted = () => {
    made += 1;
    return worker();
  };
  const without = new slim.Segmenter(bytes, { worker: counted });
  t.after(() => without.close());
  assert.equal((await without.segmentPair(...pair())).width, 64);
  for (let k = 0; k < 2; k++) assert.equal((await failure(without.fitMotions(measurements))).code, 'wasm-load-failed');
  assert.equal((await without.segmentPair(...pair())).width, 64);
  assert.equal(made, 1, 'the worker lives on');

  // A module that a worker could not start is given again, and refused again in the same words.
  const mistaken = new slim.Segmenter(bytes, { points: bytes, worker });
  t.after(() => mistaken.close());
  for (let k = 0; k < 2; k++) assert.match((await failure(mistaken.fitMotions(measurements))).message, /no fitMotions/);
  assert.equal((await mistaken.segmentPair(...pair())).width, 64);
});

test('importing any entry, also the one for browsers, changes nothing and starts nothing', () => {
  const entries = ['node', 'web', 'slim', 'inline', 'codecs'].map((name) => String(new URL(`../dist/${name}.js`, import.meta.url)));
  const script = `
    const names = () => Reflect.ownKeys(globalThis).map(String).sort().join();
    const before = names();
    globalThis.fetch = WebAssembly.compile = WebAssembly.instantiate = () => { throw new Error('too early'); };
    for (const entry of ${JSON.stringify(entries)}) await import(entry);
    if (names() !== before) throw new Error('a global was added');
    setImmediate(() => console.log(process.getActiveResourcesInfo().filter((name) => !/Pipe|TTY|Immediate/.test(name)).join()));`;
  const { stdout, stderr, status } = spawnSync(process.execPath, ['--input-type=module', '--eval', script], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  assert.equal(stdout, '\n');
});

test('an entry that lets go of its instance takes it from no other entry', async () => {
  const expected = timeless(await segmentPair(...pair()));
  const mine = new Error('mine');
  for (const [one, other] of [[segmentPair, inline.segmentPair], [inline.segmentPair, segmentPair]]) {
    const calls = await Promise.allSettled([one(...pair(), { onProgress: () => { throw mine; } }), other(...pair()), one(...pair())]);
    assert.equal(calls[0].reason, mine);
    for (const { value } of calls.slice(1)) assert.deepEqual(timeless(value), expected);
    assert.deepEqual(timeless(await other(...pair())), expected);
  }
});
