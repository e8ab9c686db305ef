import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { fitMotions, Segmenter, segmentPair } from 'veronese';
import { pair, points } from './support/frames.mjs';
import { temporaryFolder } from './support/program.mjs';
import { failure, timeless } from './support/shapes.mjs';
import { stuckWorker } from './support/stopping.mjs';

/** A segmenter that ends with the test. */
function segmenter(t, source, options) {
  const made = new Segmenter(source, options);
  t.after(() => made.close());
  return made;
}

describe('Segmenter', () => {
  test('gives the same bits and the same progress as the direct calls', async (t) => {
    const worker = segmenter(t);
    const [direct, there] = [[], []];
    const options = (progress) => ({ motions: 'auto', markUnknown: true, confidence: true, onProgress: (one) => progress.push(one) });
    assert.deepEqual(timeless(await worker.segmentPair(...pair(), options(there))), timeless(await segmentPair(...pair(), options(direct))));
    assert.deepEqual(there, direct);
    const measurements = points(80, 1, 2);
    assert.deepEqual(timeless(await worker.fitMotions(measurements)), timeless(await fitMotions(measurements)));
  });

  test('does many calls in their order', async (t) => {
    const worker = segmenter(t);
    const order = [];
    await Promise.all([1, 2, 3, 4, 5].map((motions) => worker.segmentPair(...pair(), { motions }).then(({ settings }) => order.push(settings.motions))));
    assert.deepEqual(order, [1, 2, 3, 4, 5]);
  });

  test('a call is cancelled at once, the next one gets a fresh worker', { timeout: 120_000 }, async (t) => {
    // The first call would never end.
    const workers = [stuckWorker(), new Worker(new URL('../dist/worker-node.js', import.meta.url))];
    const ended = once(workers[0], 'exit');
    const made = segmenter(t, undefined, { worker: () => workers.shift() });
    const controller = new AbortController();
    const cancelled = made.segmentPair(...pair(), { signal: controller.signal, onProgress: () => controller.abort('enough') });
    const waiting = made.segmentPair(...pair());
    const { code, cause } = await failure(cancelled);
    assert.deepEqual([code, cause], ['cancelled', 'enough']);
    assert.deepEqual(timeless(await waiting), timeless(await segmentPair(...pair())));
    await ended;
  });

  test('a waiting call is cancelled without disturbing the one under way; a signal that is aborted after the answer does nothing', async (t) => {
    const worker = segmenter(t);
    const [answered, controller] = [new AbortController(), new AbortController()];
    await worker.segmentPair(...pair(), { signal: answered.signal });
    const running = worker.segmentPair(...pair());
    answered.abort();
    const waiting = worker.segmentPair(...pair(), { signal: controller.signal });
    controller.abort();
    assert.equal((await failure(waiting)).code, 'cancelled');
    assert.equal((await running).width, 64);
  });

  test('what a listener throws ends its call only', async (t) => {
    const worker = segmenter(t);
    const mine = new Error('mine');
    assert.equal(await failure(worker.segmentPair(...pair(), { onProgress: () => { throw mine; } })), mine);
    assert.equal((await worker.segmentPair(...pair())).width, 64);
  });

  test('close rejects what is under way and waiting; a later call starts again', async (t) => {
    const worker = segmenter(t);
    const calls = [worker.segmentPair(...pair()), worker.fitMotions(points(60, 1, 1))];
    worker.close();
    for (const call of calls) assert.equal((await failure(call)).code, 'cancelled');
    assert.equal((await worker.segmentPair(...pair())).width, 64);
  });

  test('a source that is no module rejects, a later call tries again', async (t) => {
    const worker = segmenter(t, Buffer.from('<!doctype html>'));
    for (let i = 0; i < 2; i++) assert.equal((await failure(worker.segmentPair(...pair()))).code, 'wasm-load-failed');
    const bytes = readFileSync(new URL('../wasm/veronese_bg.wasm', import.meta.url));
    assert.equal((await segmenter(t, bytes).segmentPair(...pair())).width, 64);
  });

  test('an idle worker lets the process end', (t) => {
    const url = (path) => JSON.stringify(String(new URL(path, import.meta.url)));
    const script = temporaryFolder(t).file('idle.mjs', `import { Segmenter } from ${url('../dist/node.js')}; import { pair } from ${url('./support/frames.mjs')};
       console.log((await new Segmenter().segmentPair(...pair())).width);`);
    const { stdout, status, stderr } = spawnSync(process.execPath, [script], { encoding: 'utf8', timeout: 120_000 });
    assert.deepEqual([stdout, status], ['64\n', 0], stderr);
  });
});
