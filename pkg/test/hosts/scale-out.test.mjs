// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { segmentPair } from 'veronese';
import { SCALE_OUT } from '../../../scripts/lib/npm-packages.mjs';
import { root, which } from '../../../scripts/lib/project.mjs';
import { frame, png } from '../support/frames.mjs';
import { temporaryFolder } from '../support/program.mjs';

const program = which('redis-server') ?? which('valkey-server');
const skip = !program && 'there is no redis-server and no valkey-server';
const PAIRS = 24;
/** Pairs in a block of the clip. */
const BLOCK = 4;
/** Lifetime of a worker's lock, milliseconds: how long the jobs of a killed worker wait. */
const LOCK = '3000';

/** What starts programs of the example beside a server of its own; the test ends those that still run. */
async function example(t, folder) {
  const port = await freePort();
  const start = (command, args) => {
    const child = spawn(command, args, { cwd: join(root, SCALE_OUT), env: { ...process.env, REDIS_URL: `redis://127.0.0.1:${port}` } });
    t.after(() => child.kill('SIGKILL'));
    const state = { child, text: '', errors: '' };
    child.stdout.on('data', (piece) => (state.text += piece));
    child.stderr.on('data', (piece) => (state.errors += piece));
    state.ended = new Promise((resolve) => child.once('close', (code, signal) => resolve({ code, signal })));
    return state;
  };
  start(program, ['--port', String(port), '--bind', '127.0.0.1', '--dir', folder, '--save', '']);
  return {
    worker: () => start(process.execPath, ['work.mjs', '--jobs', '1', '--lock', LOCK]),
    /** What a program printed at its end. */
    run: async (...args) => {
      const state = start(process.execPath, args);
      assert.deepEqual(await state.ended, { code: 0, signal: null }, state.errors);
      return state.text;
    },
  };
}

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

/** The jobs that a worker has reported as finished. */
function doneBy({ text }) {
  return text.split('\n').slice(0, -1).map((line) => JSON.parse(line));
}

async function eventually(holds, workers) {
  while (!holds()) {
    assert.ok(workers.some(({ child }) => child.exitCode === null && child.signalCode === null), workers.map(({ errors }) => errors).join('\n'));
    await sleep(5);
  }
}

test('pairs and a clip in blocks are to the bit what direct calls give, though a worker is killed', { skip, timeout: 300_000 }, async (t) => {
  const folder = temporaryFolder(t);
  const [place, out, straight] = ['frames', 'out', 'straight'].map((name) => folder.path(name));
  // Each another, or they would be the same job.
  const frames = Array.from({ length: PAIRS + 1 }, (_, k) => frame(k / 4, { width: 64, height: 48, background: [1, 0.5] }));
  mkdirSync(place);
  frames.forEach((picture, k) => writeFileSync(join(place, `f${String(k).padStart(4, '0')}.png`), png(picture)));
  const { run, worker } = await example(t, folder.path('.'));
  const producePairs = async () => JSON.parse(await run('produce.mjs', place, '--out', out, '--quality', 'fast'));
  const produceClip = async () => JSON.parse(await run('produce-clips.mjs', place, '--out', out, '--quality', 'fast', '--block', String(BLOCK)));
  assert.deepEqual(await producePairs(), { pairs: PAIRS, added: PAIRS, done: 0 });
  assert.deepEqual(await produceClip(), { clips: 1, done: 0, queued: 0, added: 1, blocks: PAIRS / BLOCK });

  const workers = [worker(), worker()];
  await eventually(() => doneBy(workers[0]).length >= PAIRS / 4, workers);
  workers[0].child.kill('SIGKILL');
  workers.push(worker());
  const clipJobs = () => workers.flatMap(doneBy).filter(({ clip, block }) => clip === 0 && block === undefined);
  const isWhole = () => readdirSync(out, { recursive: true }).filter((name) => name.endsWith('.json')).length === PAIRS + 1;
  await eventually(() => clipJobs().length > 0 && isWhole(), workers);
  assert.equal(clipJobs()[0].solved, 0, 'blocks have solved all pairs');

  assert.deepEqual(JSON.parse(await run('status.mjs', '--out', out, '--collect')), { pairs: PAIRS, done: PAIRS, failed: 0, missing: 0 });
  const lines = readFileSync(join(out, 'results.jsonl'), 'utf8').trimEnd().split('\n').map((line) => JSON.parse(line));
  assert.deepEqual(lines.map(({ index }) => index), Array.from({ length: PAIRS }, (_, index) => index), 'every pair once, in order');
  for (const index of [0, PAIRS - 1]) {
    const { motions } = await segmentPair(frames[index], frames[index + 1], { quality: 'fast' });
    assert.deepEqual(lines[index].motions, JSON.parse(JSON.stringify(motions)), `pair ${index}`);
  }

  await run(join(root, 'pkg/bin/veronese.js'), 'clip', place, '--out', straight, '--quality', 'fast');
  const { job } = JSON.parse(readFileSync(join(out, 'clips.jsonl'), 'utf8'));
  const labels = readdirSync(join(straight, 'labels')).filter((name) => name.endsWith('.png'));
  assert.equal(labels.length, PAIRS + 1);
  for (const name of labels) assert.deepEqual(readFileSync(join(out, job.slice(5, 7), job, `${name}.png`)), readFileSync(join(straight, 'labels', name)), name);

  // A second run changes nothing.
  assert.deepEqual(await producePairs(), { pairs: PAIRS, added: 0, done: PAIRS });
  assert.deepEqual(await produceClip(), { clips: 1, done: 1, queued: 0, added: 0, blocks: 0 });
  // As a person would end them.
  for (const { child } of workers.slice(1)) child.kill('SIGTERM');
  for (const { ended } of workers.slice(1)) assert.deepEqual(await ended, { code: 0, signal: null });
});
