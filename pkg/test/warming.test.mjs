// A warm-up gives way: to what comes while it waits for its module, between two of its slices, or just when it ends.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { setImmediate } from 'node:timers/promises';
import { Segmenter, segmentPair } from 'veronese';
import { glue } from '../build/module/glue.js';
import { WorkerPool } from '../build/pool/pool.js';
import { serve } from '../build/worker/serve.js';
import { pair } from './support/frames.mjs';
import { failure, timeless } from './support/shapes.mjs';

const module = new WebAssembly.Module(readFileSync(new URL('../wasm/veronese_bg.wasm', import.meta.url)));
const WARM_UP = { call: 'warmUp' };
const PAIR = { call: 'segmentPair', frames: pair(), settings: {} };

/** A pool of one worker that only writes down its requests, and what answers in its name. */
function told({ supplied = Promise.resolve(module), size = 1 } = {}) {
  const requests = [];
  const replies = [];
  const supply = () => supplied;
  const spawn = (onReply) => {
    replies.push(onReply);
    return { post: ({ task }) => requests.push(task), hold() {}, terminate() {} };
  };
  const pool = new WorkerPool(spawn, () => supply, size);
  return { pool, requests, reply: (message, worker = 0) => replies[worker](message), started: () => replies.length };
}

describe('a warm-up in the worker', () => {
  test('runs no other slice once a task has come, and is not answered', async (t) => {
    t.mock.method(performance, 'now', () => 0); // on a busy machine it could be over after one slice
    const calls = t.mock.method(glue, 'segmentPair').mock;
    const replies = [];
    const answer = serve((reply) => replies.push(reply));
    const warmUp = answer({ task: WARM_UP, module });
    while (calls.callCount() < 2) await setImmediate();
    const slices = calls.callCount();
    await answer({ task: PAIR });
    assert.equal(calls.callCount(), slices + 1, 'the task alone');
    await warmUp;
    assert.equal(calls.callCount(), slices + 1);
    assert.deepEqual(replies.map(({ kind }) => kind).filter((kind) => kind !== 'progress'), ['done']);
    assert.deepEqual(timeless(replies.at(-1).result), timeless(await segmentPair(...pair())));
  });

  test('says that it has ended where nothing comes, or why it could not begin', async () => {
    const replies = [];
    await serve((reply) => replies.push(reply))({ task: WARM_UP, module });
    const other = new WebAssembly.Module(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0));
    await serve((reply) => replies.push(reply))({ task: WARM_UP, module: other });
    assert.deepEqual(replies.map(({ kind, error }) => [kind, error?.code]), [['rested', undefined], ['rested', 'wasm-load-failed']]);
  });
});

describe('a task that gives way in the pool', () => {
  test('is over when another comes, which its worker gets at once', async () => {
    const { pool, requests, reply } = told();
    const rest = pool.rest('rest');
    await setImmediate();
    const first = pool.run('first');
    const second = pool.run('second');
    assert.deepEqual(requests, ['rest', 'first'], 'without a message from the worker');
    await rest;
    // It may have ended just before: that is not the answer to the task.
    reply({ kind: 'rested' });
    reply({ kind: 'done', result: 1 });
    assert.equal(await first, 1);
    assert.deepEqual(requests, ['rest', 'first', 'second']);
    reply({ kind: 'done', result: 2 });
    assert.equal(await second, 2);
  });

  test('is never begun if another comes while the module loads, and waits behind all others', async () => {
    let resolve;
    const promise = new Promise((done) => (resolve = done));
    const { pool, requests, reply } = told({ supplied: promise });
    const rest = pool.rest('rest');
    const first = pool.run('first');
    await rest;
    const later = pool.rest('later');
    const second = pool.run('second');
    resolve(module);
    await setImmediate();
    for (const task of [first, second]) {
      reply({ kind: 'done', result: 0 });
      await task;
    }
    assert.deepEqual(requests, ['first', 'second', 'later']);
    reply({ kind: 'rested' });
    await later;
  });

  test('that fails says why, and its worker gets the module again', async () => {
    const { pool, reply } = told();
    const rest = failure(pool.rest('rest'));
    await setImmediate();
    reply({ kind: 'rested', error: { code: 'wasm-load-failed', message: 'no module' } });
    assert.equal((await rest).code, 'wasm-load-failed');
  });
});

test('a call ends the warm-up of its worker and gives the same bits; so does a clip', async (t) => {
  const segmenter = new Segmenter();
  t.after(() => segmenter.close());
  const warm = segmenter.warmUp();
  const found = await segmenter.segmentPair(...pair());
  await warm;
  assert.deepEqual(timeless(found), timeless(await segmentPair(...pair())));
  const again = segmenter.warmUp();
  const indices = [];
  for await (const { index } of segmenter.segmentStream(pair(), { quality: 'fast' })) indices.push(index);
  await again;
  assert.deepEqual(indices, [0, 1]);
  const closed = failure(segmenter.warmUp());
  segmenter.close();
  assert.equal((await closed).code, 'cancelled');
});
