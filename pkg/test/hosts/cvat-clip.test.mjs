// examples/hosts/cvat-clip.py with CVAT's real SDK and the real `veronese`, against a server that answers as CVAT does.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { png } from '../support/frames.mjs';
import { temporaryFolder } from '../support/program.mjs';
import { python, skip } from '../support/python.mjs';
import { clip } from './asking.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const LENGTH = 8;
const TOKEN = 'personal-token';

/** Two squares that move apart, side by side. */
function pictures() {
  const [left, right] = [clip(LENGTH), clip(LENGTH, { square: [-1, 2] })];
  return left.map((one, k) => {
    const { width, height } = one;
    const data = new Uint8ClampedArray(2 * one.data.length);
    for (let y = 0; y < height; y++) {
      for (const [side, { data: half }] of [one, right[k]].entries()) data.set(half.subarray(4 * y * width, 4 * (y + 1) * width), 4 * (2 * y + side) * width);
    }
    return { data, width: 2 * width, height };
  });
}

/** A server with a task of these frames, a way to ask it as CVAT's page does, and one to run the program. */
async function cvat(t) {
  const folder = temporaryFolder(t);
  mkdirSync(folder.path('frames'));
  for (const [k, picture] of pictures().entries()) writeFileSync(folder.path('frames', `f${k}.png`), png(picture));
  const server = spawn(python, ['-B', here('cvat_server.py'), folder.path('frames')], { stdio: ['ignore', 'pipe', 'inherit'] });
  t.after(() => server.kill());
  const port = await new Promise((resolve, reject) => {
    server.stdout.once('data', (text) => resolve(Number(text)));
    server.once('exit', (code) => reject(new Error(`the server ended with ${code}`)));
  });
  const origin = `http://127.0.0.1:${port}`;
  const ask = async (method, path, body) => {
    const headers = { Authorization: `Bearer ${TOKEN}`, 'Content-Type': 'application/json' };
    const response = await fetch(origin + path, { method, headers, ...(body && { body: JSON.stringify(body) }) });
    assert.equal(response.status, 200, await response.clone().text());
    return response.json();
  };
  const run = (command, ...args) => runToItsEnd([command, '42', '--server-host', origin, '--out', folder.path('work'), ...args]);
  return {
    run,
    log: () => ask('GET', '/test/log'),
    breakOff: () => ask('POST', '/test/break'),
    tracks: async () => (await ask('GET', '/api/tasks/42/annotations')).tracks,
    save: (action, tracks) => ask('PATCH', `/api/tasks/42/annotations?action=${action}`, { tracks }),
    done: async (...args) => {
      const { code, stdout, stderr } = await run(...args);
      assert.equal(code, 0, stderr);
      return JSON.parse(stdout);
    },
  };
}

function runToItsEnd(args) {
  const program = [process.execPath, here('../../bin/veronese.js')].map((word) => `'${word}'`).join(' ');
  const child = spawn(python, ['-B', here('../../../examples/hosts/cvat-clip.py'), ...args, '--quality', 'fast', '--tolerance', '0'], {
    env: { PATH: process.env.PATH, HOME: process.env.HOME, VERONESE: program, CVAT_ACCESS_TOKEN: TOKEN },
  });
  return new Promise((resolve) => {
    const text = { stdout: '', stderr: '' };
    for (const name of ['stdout', 'stderr']) child[name].setEncoding('utf8').on('data', (piece) => (text[name] += piece));
    child.once('close', (code) => resolve({ code, ...text }));
  });
}

const shapeIn = (track, frame) => track.shapes.find((shape) => shape.frame === frame);
const groupOf = (tracks, group) => tracks.find((track) => track.group === group);
/** The squares are these objects. */
const [RIGHT, LEFT] = [1, 2];
const square = (left, top, side) => [left, top, left + side, top, left + side, top + side, left, top + side];
/** Within the left one in frame 3. */
const PART = square(30, 24, 18);
/** Pixels, of a polygon. */
const areaOf = ({ points }) => Math.abs(points.reduce((sum, x, k) => (k % 2 ? sum : sum + x * points[(k + 3) % points.length] - points[(k + 2) % points.length] * points[k + 1]), 0)) / 2;

test('a clip in CVAT becomes tracks; polygons that a person redraws, draws or deletes go on, and the rest stays as it is', { skip, timeout: 300_000 }, async (t) => {
  const { run, done, log, breakOff, save, tracks } = await cvat(t);
  assert.match((await run('annotate', '--label', 'frame')).stderr, /^cvat-clip: error: no-label: /);
  await breakOff();
  assert.match((await run('annotate', '--label', 'thing')).stderr, /^cvat-clip: error: cvat-unreachable: /);
  // CVAT has the tracks, and nobody was told: another run sends them no second time.
  assert.deepEqual(await done('annotate', '--label', 'thing'), { task: 42, frames: LENGTH, objects: 2 });
  const before = await tracks();
  assert.deepEqual(before.map(({ group, label_id: label, source, shapes }) => [group, label, source, shapes.length]), [RIGHT, LEFT].map((group) => [group, 7, 'auto', LENGTH]));
  const nothing = { task: 42, changed: 0, deleted: 0, tracks: 0 };
  assert.deepEqual(await done('correct'), nothing);

  // A part of the object in frame 3 is what the person wants.
  const left = groupOf(before, LEFT);
  const whole = areaOf(shapeIn(left, 4));
  Object.assign(shapeIn(left, 3), { points: PART, occluded: true });
  await save('update', [left]);
  assert.equal((await done('correct')).changed, 1);
  const after = await tracks();
  const changed = groupOf(after, LEFT);
  assert.deepEqual([shapeIn(changed, 3).points, shapeIn(changed, 3).occluded, changed.source], [PART, true, 'semi-auto']);
  assert.ok(areaOf(shapeIn(changed, 4)) < whole / 2, 'the neighbouring frames follow');
  assert.deepEqual(groupOf(after, RIGHT), groupOf(before, RIGHT), 'nobody touched it, and its track is the same one');
  const saved = { action: 'update', groups: [LEFT] };
  assert.deepEqual((await log()).slice(1), [saved, saved], 'once by the person, once by the program');

  // One object is deleted, another drawn in one frame, in the way of CVAT's page: without a group, and on to the end.
  await save('delete', [groupOf(after, RIGHT)]);
  const shape = { type: 'polygon', frame: 2, outside: false, occluded: false, z_order: 0, rotation: 0, points: square(116, 22, 36), attributes: [] };
  await save('create', [{ frame: 2, label_id: 9, group: 0, source: 'manual', shapes: [shape], attributes: [] }]);
  assert.deepEqual(await done('correct'), { task: 42, changed: 1, deleted: 1, tracks: 1 });
  const last = await tracks();
  assert.equal(groupOf(last, RIGHT), undefined);
  const added = last.find(({ label_id: label }) => label === 9);
  assert.ok(added.group > 2, `object ${added.group} has a number that none had`);
  assert.deepEqual(shapeIn(added, 2).points, shape.points);
  assert.ok(added.shapes.filter(({ outside }) => !outside).length > 3, 'it is followed through the clip');
  assert.deepEqual(await done('correct'), nothing);
});

test('the SDK is the one that the tests of formats use', { skip }, () => {
  const of = (path) => /^cvat[-_]sdk==(\S+)$/m.exec(readFileSync(here(path), 'utf8'))?.[1];
  assert.ok(of('../../../examples/hosts/requirements.txt'));
  assert.equal(of('../../../examples/hosts/requirements.txt'), of('../support/requirements.txt'));
});
