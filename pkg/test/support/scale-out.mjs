// Tests examples/scale-out under failures: two workers, one killed in the middle of a job, and a restart of the Redis server; a clip whose
// blocks two workers solve, one of them killed inside a block.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, truncateSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

import { SCALE_OUT } from '../../../scripts/lib/npm-packages.mjs';
import { root, which } from '../../../scripts/lib/project.mjs';
import { frame, png } from './frames.mjs';

/** Lifetime of a worker's lock, milliseconds: how long the jobs of a killed worker wait. */
const LOCK = '3000';
const PATIENCE = 300_000;

/** The program of a Redis or Valkey server, where there is one. */
export const redisServer = () => which('redis-server') ?? which('valkey-server');

/** Runs everything for pairs. Throws if a pair is missing, duplicated or different from a direct call. */
export function prove(program, { pairs, size }) {
  return withServer(program, async ({ folder, redis, node, finished, worker }) => {
    const frames = makeFrames(join(folder, 'frames'), pairs + 1, size);
    const out = join(folder, 'out');
    let server = redis();
    const produced = await finished(node('produce.mjs', join(folder, 'frames'), '--out', out, '--quality', 'fast'));
    assert.deepEqual(produced, { pairs, added: pairs, done: 0 });

    const workers = [worker(), worker()];
    const until = async (share, what) => {
      await eventually(() => results(out).length >= share * pairs, what, workers);
    };
    await until(0.25, 'a worker to kill');
    workers[0].child.kill('SIGKILL');
    await workers[0].ended;
    workers.push(worker());
    await until(0.5, 'a server to restart');
    server.child.kill('SIGTERM');
    await server.ended;
    await sleep(500);
    server = redis();
    await until(1, 'the end');

    const collected = await finished(node('status.mjs', '--out', out, '--collect'));
    assert.deepEqual(collected, { pairs, done: pairs, failed: 0, missing: 0 });
    const lines = readFileSync(join(out, 'results.jsonl'), 'utf8').trimEnd().split('\n').map((line) => JSON.parse(line));
    assert.deepEqual(lines.map(({ index }) => index), Array.from({ length: pairs }, (_, index) => index), 'every pair once, in order');
    assert.equal(new Set(results(out)).size, pairs, 'one result for each');
    await compare(lines, frames);

    // A second run changes nothing.
    assert.deepEqual(await finished(node('produce.mjs', join(folder, 'frames'), '--out', out, '--quality', 'fast')), { pairs, added: 0, done: pairs });
    await ended(workers.slice(1));
  });
}

/** Pairs in a block of the clip. */
const BLOCK = 4;

/**
 * The same for one clip of a number of blocks. A worker is stopped inside its first block, while another one solves the next, and killed.
 * Throws if a file is not to the bit what `veronese clip` writes. Returns what was done, by finished jobs.
 */
export function proveClip(program, { blocks, size }) {
  return withServer(program, async ({ folder, start, redis, node, finished, worker }) => {
    const [frames, out, straight] = ['frames', 'out', 'straight'].map((name) => join(folder, name));
    makeFrames(frames, blocks * BLOCK + 1, size);
    redis();
    const produce = () => finished(node('produce-clips.mjs', frames, '--out', out, '--block', String(BLOCK)));
    assert.deepEqual(await produce(), { clips: 1, done: 0, queued: 0, added: 1, blocks });
    assert.deepEqual(await produce(), { clips: 1, done: 0, queued: 1, added: 0, blocks: 0 });
    const { job } = JSON.parse(readFileSync(join(out, 'clips.jsonl'), 'utf8'));
    const place = join(out, job.slice(5, 7), job);
    const solved = () => (existsSync(join(place, 'pairs')) ? readdirSync(join(place, 'pairs')).filter((name) => /^\d+$/.test(name)) : []);

    const workers = [worker()];
    await eventually(() => solved().length > 0, 'the first pair', workers);
    workers[0].child.kill('SIGSTOP');
    const lost = solved();
    assert.ok(lost.length < BLOCK, 'it is inside its block');
    workers.push(worker());
    await eventually(() => doneBy(workers[1]).length > 0, 'a block of the other worker', workers);
    workers[0].child.kill('SIGKILL');
    await workers[0].ended;
    // Nobody trusts what a dying machine has written.
    truncateSync(join(place, 'pairs', lost[0]), 100);
    workers.push(worker());
    await eventually(() => workers.flatMap(doneBy).some(({ block }) => block === undefined), 'the end', workers);

    const program = join(root, 'pkg/bin/veronese.js');
    const direct = start(process.execPath, [program, 'clip', frames, '--out', straight]);
    assert.deepEqual(await direct.ended, { code: 0, signal: null }, direct.errors);
    const labels = readdirSync(join(straight, 'labels')).filter((name) => name.endsWith('.png'));
    assert.equal(labels.length, blocks * BLOCK + 1);
    for (const name of labels) assert.deepEqual(readFileSync(join(place, `${name}.png`)), readFileSync(join(straight, 'labels', name)), name);
    const objects = (path) => JSON.parse(readFileSync(path, 'utf8')).objects;
    assert.deepEqual(objects(join(place, 'clip.json')), objects(join(straight, 'tracks.json')));
    assert.deepEqual(await produce(), { clips: 1, done: 1, queued: 0, added: 0, blocks: 0 });
    const { clips, queue } = await finished(node('status.mjs', '--out', out));
    assert.deepEqual(clips, { clips: 1, done: 1, failed: 0, missing: 0 });
    assert.ok(Object.values(queue).every((count) => count === 0), JSON.stringify(queue));
    await ended(workers.slice(1));
    const did = workers.flatMap(doneBy);
    assert.deepEqual(did.filter(({ block }) => block === undefined), [{ clip: 0, did: true, known: blocks * BLOCK, solved: 0 }]);
    const taken = did.filter(({ block }) => block !== undefined);
    assert.equal(new Set(taken.map(({ block }) => block)).size, blocks, 'every block');
    assert.ok(taken.some(({ block, known }) => block === 0 && known >= lost.length), 'what the killed worker had solved was not solved again');
    return { did };
  });
}

/** Calls `work` with what starts a server and programs of the example in a temporary folder, and ends whatever still runs. */
async function withServer(program, work) {
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
    return await work({ folder, start, redis, node, finished, worker });
  } finally {
    for (const child of running) child.kill('SIGKILL');
    rmSync(folder, { recursive: true, force: true });
  }
}

async function eventually(holds, what, workers) {
  for (const since = Date.now(); !holds(); await sleep(5)) {
    assert.ok(Date.now() - since < PATIENCE, `${what}: not after ${PATIENCE / 1000} s\n${workers.map(({ errors }) => errors).join('\n')}`);
  }
}

/** The jobs that a worker has reported as finished. */
function doneBy({ text }) {
  return text.split('\n').slice(0, -1).map((line) => JSON.parse(line));
}

/** Ends workers as a person would. */
async function ended(workers) {
  for (const { child } of workers) child.kill('SIGTERM');
  for (const worker of workers) assert.deepEqual(await worker.ended, { code: 0, signal: null });
}

function results(out) {
  return readdirSync(out, { recursive: true }).filter((name) => name.endsWith('.json'));
}

function makeFrames(folder, count, size) {
  mkdirSync(folder);
  const frames = Array.from({ length: count }, (_, k) => frame(k / 4, { ...size, background: [1, 0.5] })); // each another, or they would be the same job
  frames.forEach((picture, k) => writeFileSync(join(folder, `f${String(k).padStart(4, '0')}.png`), png(picture)));
  return frames;
}

/** Compares some of the results with direct calls. */
async function compare(lines, frames) {
  const { segmentPair } = await import('veronese');
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
