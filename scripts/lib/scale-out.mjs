// Tests examples/scale-out under failures: two workers, one killed in the middle of a job, and a restart of the Redis server.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

import { installDebianPackages } from './debian.mjs';
import { SCALE_OUT } from './npm-packages.mjs';
import { root, which } from './project.mjs';

/** Lifetime of a worker's lock, milliseconds: how long the jobs of a killed worker wait. */
const LOCK = '3000';
const PATIENCE = 300_000;

/** Whether there is a Redis or Valkey server; with `install` it is installed where that needs no confirmation. */
export async function redisServer({ install = false } = {}) {
  const found = () => which('redis-server') ?? which('valkey-server');
  if (!found() && install) await installDebianPackages(['redis-server'], 'Redis');
  return found();
}

/** Runs everything and returns the measurements. Throws if a pair is missing, duplicated or different from a direct call. */
export async function prove(program, { pairs, size, say = () => undefined }) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-scale-out-'));
  const running = new Set();
  const start = (command, args, env = {}) => {
    const child = spawn(command, args, { cwd: join(root, SCALE_OUT), env: { ...process.env, ...env }, stdio: ['ignore', 'pipe', 'pipe'] });
    running.add(child);
    const state = { child, text: '', errors: '' };
    child.stdout.on('data', (piece) => (state.text += piece));
    child.stderr.on('data', (piece) => (state.errors += piece));
    state.ended = new Promise((resolve) => child.once('close', (code, signal) => resolve({ code, signal })));
    return state;
  };
  try {
    const port = await freePort();
    const env = { REDIS_URL: `redis://127.0.0.1:${port}` };
    const node = (script, ...args) => start(process.execPath, [script, ...args], env);
    const finished = async (state) => {
      const { code } = await state.ended;
      assert.equal(code, 0, state.errors);
      return JSON.parse(state.text);
    };
    // Jobs must survive the server, so it appends each change to a file.
    const redis = () => start(program, ['--port', String(port), '--bind', '127.0.0.1', '--dir', folder, '--save', '', '--appendonly', 'yes', '--appendfsync', 'always']);
    const worker = () => node('work.mjs', '--jobs', '1', '--lock', LOCK);
    const doneBy = ({ text }) => text.split('\n').filter(Boolean).map((line) => JSON.parse(line));

    const frames = await makeFrames(join(folder, 'frames'), pairs + 1, size);
    const out = join(folder, 'out');
    let server = redis();
    const produced = await finished(node('produce.mjs', join(folder, 'frames'), '--out', out, '--quality', 'fast'));
    assert.deepEqual(produced, { pairs, added: pairs, done: 0 });

    const since = Date.now();
    const workers = [worker(), worker()];
    const until = async (share, what) => {
      for (;;) {
        const files = results(out).length;
        if (files >= share * pairs) return files;
        assert.ok(Date.now() - since < PATIENCE, `${what}: ${files} of ${pairs} pairs after ${PATIENCE / 1000} s\n${workers.map(({ errors }) => errors).join('\n')}`);
        await sleep(20);
      }
    };
    say(`killing a worker after ${await until(0.25, 'a worker to kill')} pairs`);
    workers[0].child.kill('SIGKILL');
    await workers[0].ended;
    workers.push(worker());
    say(`restarting the Redis server after ${await until(0.5, 'a server to restart')} pairs`);
    server.child.kill('SIGTERM');
    await server.ended;
    await sleep(500);
    server = redis();
    await until(1, 'the end');
    const seconds = (Date.now() - since) / 1000;

    const collected = await finished(node('status.mjs', '--out', out, '--collect'));
    assert.deepEqual(collected, { pairs, done: pairs, failed: 0, missing: 0 });
    const lines = readFileSync(join(out, 'results.jsonl'), 'utf8').trimEnd().split('\n').map((line) => JSON.parse(line));
    assert.deepEqual(lines.map(({ index }) => index), Array.from({ length: pairs }, (_, index) => index), 'every pair once, in order');
    assert.equal(new Set(results(out)).size, pairs, 'one result for each');
    await compare(lines, frames);

    // A second run changes nothing.
    assert.deepEqual(await finished(node('produce.mjs', join(folder, 'frames'), '--out', out, '--quality', 'fast')), { pairs, added: 0, done: pairs });
    const survivors = workers.slice(1);
    for (const { child } of survivors) child.kill('SIGTERM');
    for (const { ended } of survivors) assert.deepEqual(await ended, { code: 0, signal: null });
    const did = workers.flatMap(doneBy);
    return { pairs, seconds, jobsFinished: did.length, foundDone: did.filter(({ did }) => !did).length };
  } finally {
    for (const child of running) child.kill('SIGKILL');
    rmSync(folder, { recursive: true, force: true });
  }
}

function results(out) {
  return readdirSync(out, { recursive: true }).filter((name) => name.endsWith('.json'));
}

async function makeFrames(folder, count, size) {
  const { frame, png } = await import('../../pkg/test/support/frames.mjs');
  mkdirSync(folder);
  const frames = Array.from({ length: count }, (_, k) => frame(k / 4, { ...size, background: [1, 0.5] })); // each another, or they would be the same job
  frames.forEach((picture, k) => writeFileSync(join(folder, `f${String(k).padStart(4, '0')}.png`), png(picture)));
  return frames;
}

/** Compares some of the results with direct calls. */
async function compare(lines, frames) {
  const { segmentPair } = await import('../../pkg/dist/node.js');
  for (let index = 0; index < lines.length; index += 23) {
    const { motions } = await segmentPair(frames[index], frames[index + 1], { quality: 'fast' });
    assert.deepEqual(lines[index].motions, JSON.parse(JSON.stringify(motions)), `pair ${index}`);
  }
}

function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}
