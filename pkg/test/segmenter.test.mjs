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
function segmenter(t, source) {
  const made = new Segmenter(source);
  t.after(() => made.close());
  return made;
}

describe('Segmenter', () => {
  test('gives the same bits as the direct calls', async (t) => {
    const worker = segmenter(t);
    const options = { motions: 'auto', markUnknown: true, confidence: true };
    assert.deepEqual(timeless(await worker.segmentPair(...pair(), options)), timeless(await segmentPair(...pair(), options)));
    const measurements = points(80, 1, 2);
    assert.deepEqual(timeless(await worker.fitMotions(measurements)), timeless(await fitMotions(measurements)));
  });

  test('reports progress', async (t) => {
    const [direct, there] = [[], []];
    await segmentPair(...pair(), { onProgress: (progress) => direct.push(progress) });
    await segmenter(t).segmentPair(...pair(), { onProgress: (progress) => there.push(progress) });
    assert.deepEqual(there, direct);
  });

  test('warms up, changes nothing by it, and is ended in the middle of it by close()', async (t) => {
    const worker = segmenter(t);
    assert.equal(await worker.warmUp(), undefined);
    assert.deepEqual(timeless(await worker.segmentPair(...pair())), timeless(await segmentPair(...pair())));
    const again = failure(worker.warmUp());
    worker.close();
    assert.equal((await again).code, 'cancelled');
  });

  test('does many calls in their order', async (t) => {
    const worker = segmenter(t);
    const order = [];
    const calls = [1, 2, 3, 4, 5].map((motions) =>
      worker.segmentPair(...pair(), { motions }).then(({ settings }) => order.push(settings.motions)),
    );
    await Promise.all(calls);
    assert.deepEqual(order, [1, 2, 3, 4, 5]);
  });

  test('a call is cancelled at once, the next one gets a fresh worker', { timeout: 120_000 }, async (t) => {
    const expected = timeless(await segmentPair(...pair()));
    // The first call would never end.
    const workers = [stuckWorker(), new Worker(new URL('../dist/worker-node.js', import.meta.url))];
    const ended = once(workers[0], 'exit');
    const worker = () => workers.shift();
    const made = new Segmenter(undefined, { worker });
    t.after(() => made.close());
    const controller = new AbortController();
    const cancelled = made.segmentPair(...pair(), { signal: controller.signal, onProgress: () => controller.abort('enough') });
    const waiting = made.segmentPair(...pair());
    const error = await failure(cancelled);
    assert.equal(error.code, 'cancelled');
    assert.equal(error.cause, 'enough');
    assert.deepEqual(timeless(await waiting), expected);
    await ended;
  });

  test('a waiting call is cancelled without disturbing the one under way', async (t) => {
    const worker = segmenter(t);
    const running = worker.segmentPair(...pair());
    const controller = new AbortController();
    const waiting = worker.segmentPair(...pair(), { signal: controller.signal });
    controller.abort();
    assert.equal((await failure(waiting)).code, 'cancelled');
    assert.equal((await running).width, 64);
    controller.abort();
  });

  test('an aborted signal cancels before anything starts', async (t) => {
    assert.equal((await failure(segmenter(t).segmentPair(...pair(), { signal: AbortSignal.abort() }))).code, 'cancelled');
  });

  test('a signal that is aborted after the answer does nothing', async (t) => {
    const worker = segmenter(t);
    const controller = new AbortController();
    await worker.segmentPair(...pair(), { signal: controller.signal });
    const next = worker.segmentPair(...pair());
    controller.abort();
    assert.equal((await next).width, 64);
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
    const folder = temporaryFolder(t);
    const url = (path) => JSON.stringify(String(new URL(path, import.meta.url)));
    const script = folder.file(
      'idle.mjs',
      `import { Segmenter } from ${url('../dist/node.js')}; import { pair } from ${url('./support/frames.mjs')};
       console.log((await new Segmenter().segmentPair(...pair())).width);`,
    );
    const { stdout, status, stderr } = spawnSync(process.execPath, [script], { encoding: 'utf8', timeout: 120_000 });
    assert.equal(stdout.trim(), '64', stderr);
    assert.equal(status, 0);
  });
});
