// The iterator contract of `inOrder` and `segmentPairs`: whatever the source does and whenever the reader stops, every wait ends.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { describe, test } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { segmentPairs } from 'veronese';
import { inOrder } from '../build/calls/ordered.js';
import { random } from '../../scripts/lib/random.mjs';
import { pair } from './support/frames.mjs';
import { failure } from './support/shapes.mjs';
import { soaking } from './support/soak.mjs';

const mine = new Error('mine');
const stopped = new Error('stopped');

/** Whether waits end at all: where the event loop spins, nothing in this process could end a test. */
let spinning = false;

/**
 * Runs a script that imports the package. Where the event loop spins, no timer of this process would end the wait: the other
 * process is ended from outside.
 */
function run(script) {
  const place = (path) => JSON.stringify(String(new URL(path, import.meta.url)));
  const head = `import { segmentPairs } from ${place('../dist/node.js')}; import { random } from '../../scripts/lib/random.mjs';
import { pair } from ${place('./support/frames.mjs')};
    const [first, second] = pair(); const good = { first, second };`;
  const options = { encoding: 'utf8', timeout: 120_000, cwd: fileURLToPath(new URL('.', import.meta.url)) };
  const { stdout, stderr, status, signal } = spawnSync(process.execPath, ['--input-type=module', '-e', `${head}\n${script}`], options);
  spinning ||= signal !== null;
  assert.equal(signal, null, 'it did not end by itself');
  assert.equal(status, 0, stderr);
  return stdout.trim().split('\n');
}

describe('segmentPairs with a source that throws synchronously rejects with what was thrown', () => {
  const malformed = ['{}', '{ next: () => 5 }', '{ next: async () => null }', '7'].flatMap((iterator) => ['iterator', 'asyncIterator'].map((kind) => `({ [Symbol.${kind}]: () => (${iterator}) })`));
  const cases = [
    ['(function* () { throw new RangeError("mine"); })()', [], 'RangeError', null, 'mine'],
    ['(function* () { yield good; throw new RangeError("mine"); })()', [0], 'RangeError', null, 'mine'],
    ['({ [Symbol.asyncIterator]: () => ({ next() { throw new RangeError("mine"); } }) })', [], 'RangeError', null, 'mine'],
    ...malformed.map((source) => [source, [], 'VeroneseError', 'invalid-input']),
  ];
  test('or says what is malformed', () => {
    const lines = run(`for (const source of [${cases.map(([source]) => source)}]) {
      const seen = [];
      try { for await (const { index } of segmentPairs(source, { jobs: 1 })) seen.push(index); }
      catch (error) { console.log(JSON.stringify([seen, error.name, error.code ?? null, error.message])); }
    }`);
    for (const [at, [source, ...expected]] of cases.entries()) assert.deepEqual(JSON.parse(lines[at]).slice(0, expected.length), expected, source);
  });

  test('timers and signals are heard meanwhile', () => {
    const lines = run(`const controller = new AbortController();
      const source = (function* () { yield good; yield good; })();
      setTimeout(() => { console.log('timer'); controller.abort(); }, 1);
      const slow = { [Symbol.iterator]: () => ({ next: () => ({ done: false, value: new Promise(() => {}) }) }) };
      await segmentPairs(slow, { jobs: 1, signal: controller.signal }).next().catch(({ code }) => console.log(code));`);
    assert.deepEqual(lines, ['timer', 'cancelled']);
  });
});

/** A source by a script of steps, synchronous or not, which notes how it is used. */
function scripted({ kind, steps, next }) {
  const notes = { taken: 0, running: 0, overlapped: false, afterEnd: false, returned: 0, over: false };
  const step = () => {
    if (notes.over) notes.afterEnd = true;
    const what = steps[notes.taken];
    if (what === undefined) {
      notes.over = true;
      return { done: true, value: undefined };
    }
    if (what === 'throw') {
      notes.over = true;
      throw mine;
    }
    const value = notes.taken++;
    return { done: false, value: what === 'promise' ? Promise.resolve(value) : what === 'rejection' ? Promise.reject(mine) : value };
  };
  const close = () => {
    notes.returned += 1;
    if (next() < 0.2) throw new Error('the end is not wanted');
    return kind === 'sync' ? { done: true } : Promise.resolve({ done: true });
  };
  const slowly = async () => {
    if (notes.running > 0) notes.overlapped = true;
    notes.running += 1;
    try {
      if (next() < 0.5) await setTimeout(Math.floor(next() * 3));
      return step();
    } finally {
      notes.running -= 1;
    }
  };
  const iterator = { next: kind === 'sync' ? step : slowly, return: close };
  return { notes, source: { [kind === 'sync' ? Symbol.iterator : Symbol.asyncIterator]: () => iterator } };
}

const ROUNDS = soaking ? 5000 : 150;

describe('inOrder, on random sources, readers and signals', () => {
  for (const kind of ['sync', 'async']) {
    test(`${kind}: answers come in order, errors at their place, and the source is closed once`, async () => {
      assert.equal(spinning, false, 'see the tests above');
      const next = random(kind.length);
      for (let round = 0; round < ROUNDS; round++) {
        const words = kind === 'sync' ? ['value', 'value', 'value', 'promise', 'throw', 'rejection'] : ['value', 'value', 'value', 'throw'];
        const steps = Array.from({ length: Math.floor(next() * 7) }, () => words[Math.floor(next() * words.length)]);
        const firstBad = steps.findIndex((step) => step === 'throw' || step === 'rejection');
        const room = 1 + Math.floor(next() * 4);
        const leaveAfter = next() < 0.4 ? Math.floor(next() * 5) : Infinity;
        const controller = new AbortController();
        const ending = next() < 0.3 ? Math.floor(next() * 8) : undefined;
        const { notes, source } = scripted({ kind, steps, next });
        let stop = false;
        let begunAfterStop = false;
        let busy = 0;
        const work = async (input, index) => {
          if (stop) begunAfterStop = true;
          busy += 1;
          assert.ok(busy <= room, `${busy} at once, where there is room for ${room}`);
          if (next() < 0.7) await setTimeout(Math.floor(next() * 3));
          busy -= 1;
          return [input, index];
        };
        if (ending === 0) controller.abort();
        else if (ending !== undefined) void setTimeout(ending).then(() => controller.abort());
        const outcomes = inOrder(source, work, { room, signal: controller.signal, stop: () => stopped });
        const seen = [];
        let thrown;
        try {
          for (let left = leaveAfter; ; left--) {
            if (left === 0) {
              await outcomes.return();
              break;
            }
            const { done, value } = await outcomes.next();
            if (done) break;
            seen.push(value);
          }
        } catch (error) {
          thrown = error;
        }
        stop = true;
        const say = JSON.stringify({ round, steps, room, leaveAfter, ending, seen, notes });
        assert.deepEqual(seen, seen.map((_, index) => [index, index]), say);
        assert.equal(notes.overlapped, false, `next() before the last one answered: ${say}`);
        assert.equal(notes.afterEnd, false, `next() after the end: ${say}`);
        assert.ok(notes.returned <= 1, say);
        if (notes.over) assert.equal(notes.returned, 0, `return() after the end: ${say}`);
        if (thrown === stopped) assert.ok(controller.signal.aborted, say);
        else if (seen.length < leaveAfter) {
          assert.equal(thrown, firstBad < 0 ? undefined : mine, say);
          assert.equal(seen.length, firstBad < 0 ? steps.length : firstBad, say);
        }
        await setTimeout(6);
        assert.equal(begunAfterStop, false, `work began after the end: ${say}`);
        const begun = leaveAfter > 0 && ending !== 0;
        if (begun && !notes.over) assert.equal(notes.returned, 1, `the source was left open: ${say}`);
      }
    });
  }
});

test('a signal ends segmentPairs in every state: before, while a worker works, while nobody reads, while the source waits', async () => {
  assert.equal(spinning, false, 'see the tests above');
  const [first, second] = pair();
  const cancelled = async (call) => assert.equal((await failure(call)).code, 'cancelled');
  const forever = { async *[Symbol.asyncIterator]() { yield { first, second }; await new Promise(() => {}); } };

  const working = new AbortController();
  await cancelled(segmentPairs([{ first, second }], { jobs: 1, signal: AbortSignal.abort() }).next());
  await cancelled(segmentPairs([{ first, second }], { jobs: 1, signal: working.signal, onProgress: () => working.abort() }).next());

  const idle = new AbortController();
  const outcomes = segmentPairs(forever, { jobs: 1, signal: idle.signal });
  await outcomes.next();
  idle.abort();
  await cancelled(outcomes.next());
  assert.deepEqual(await outcomes.next(), { done: true, value: undefined });

  const waiting = new AbortController();
  const more = segmentPairs(forever, { jobs: 1, signal: waiting.signal });
  await more.next();
  const next = cancelled(more.next());
  waiting.abort();
  await next;
});
