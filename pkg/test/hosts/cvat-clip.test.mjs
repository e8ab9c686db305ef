// examples/hosts/cvat-clip.py with CVAT's real SDK and the real `veronese`, against a server that answers as CVAT does.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { decode } from 'fast-png';
import { png } from '../support/frames.mjs';
import { temporaryFolder } from '../support/program.mjs';
import { python, skip } from '../support/python.mjs';
import { clip, listen } from './asking.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const LENGTH = 8;
const CREDENTIALS = { CVAT_ACCESS_TOKEN: 'personal-token' };

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
    const headers = { Authorization: 'Bearer personal-token', 'Content-Type': 'application/json' };
    const response = await fetch(origin + path, { method, headers, ...(body && { body: JSON.stringify(body) }) });
    assert.equal(response.status, 200, await response.clone().text());
    return response.json();
  };
  const out = folder.path('work');
  return {
    out,
    origin,
    ask,
    tracks: async () => (await ask('GET', '/api/tasks/42/annotations')).tracks,
    save: (action, tracks) => ask('PATCH', `/api/tasks/42/annotations?action=${action}`, { tracks }),
    run: (args, env) => run(['--server-host', origin, '--out', out, ...args], env),
    labels: () => labelsIn(`${out}/clip/labels`),
  };
}

/** Runs the program to its end. */
function run(args, env = CREDENTIALS) {
  const program = [process.execPath, here('../../bin/veronese.js')].map((word) => `'${word}'`).join(' ');
  const child = spawn(python, ['-B', here('../../../examples/hosts/cvat-clip.py'), ...args, '--quality', 'fast'], {
    env: { PATH: process.env.PATH, HOME: process.env.HOME, VERONESE: program, ...env },
  });
  return new Promise((resolve) => {
    const text = { stdout: '', stderr: '' };
    for (const name of ['stdout', 'stderr']) child[name].setEncoding('utf8').on('data', (piece) => (text[name] += piece));
    child.once('close', (code) => resolve({ code, ...text }));
  });
}

async function done(running) {
  const { code, stdout, stderr } = await running;
  assert.equal(code, 0, stderr);
  return JSON.parse(stdout);
}

async function refused(running, code) {
  const ended = await running;
  assert.equal(ended.code, 1, ended.stderr);
  assert.match(ended.stderr, new RegExp(`^cvat-clip: error: ${code}: .+\n$`));
  assert.equal(ended.stdout, '');
}

function labelsIn(folder) {
  return readdirSync(folder).sort().map((name) => decode(readFileSync(`${folder}/${name}`)).data);
}

/** The pixels of each object in each frame, as the server gives those of tracks. */
function masksOf(labels) {
  const masks = {};
  for (const [frame, data] of labels.entries()) {
    for (const id of new Set(data)) {
      const mask = Uint8Array.from(data, (label) => Number(label === id));
      const pixels = mask.reduce((sum, value) => sum + value, 0);
      if (id > 0 && id < 255) (masks[id] ??= {})[frame] = [pixels, createHash('sha256').update(mask).digest('hex')];
    }
  }
  return masks;
}

/** CVAT gives others each time. */
const withoutIds = (track) => ({ ...track, id: undefined, shapes: track.shapes.map((shape) => ({ ...shape, id: undefined })) });
const shapeIn = (track, frame) => track.shapes.find((shape) => shape.frame === frame);
const groupOf = (tracks, group) => tracks.find((track) => track.group === group);
/** The squares are these objects. */
const [RIGHT, LEFT] = [1, 2];
const square = (left, top, side) => [left, top, left + side, top, left + side, top + side, left, top + side];
/** Within the left one in frame 3. */
const PART = square(30, 24, 18);

describe('a clip in CVAT', { skip, timeout: 300_000 }, () => {
  test('becomes tracks; a polygon that a person redraws goes on, and the rest stays as it is', async (t) => {
    const { run, ask, save, tracks, labels } = await cvat(t);
    const printed = await done(run(['annotate', '42', '--label', 'thing', '--tolerance', '0']));
    const found = masksOf(labels());
    assert.deepEqual(Object.keys(found), ['1', '2'], 'both squares move');
    assert.deepEqual(printed, { task: 42, frames: LENGTH, objects: 2 });
    assert.deepEqual(await ask('GET', '/test/masks'), found, 'filled, the polygons are the labels, pixel by pixel');
    for (const { label_id: label, source } of await tracks()) assert.deepEqual([label, source], [7, 'auto']);
    const nothing = { task: 42, changed: 0, deleted: 0, tracks: 0 };
    assert.deepEqual(await done(run(['correct', '42', '--tolerance', '0'])), nothing);

    const before = await tracks();
    const left = groupOf(before, LEFT);
    const asked = (await ask('GET', '/test/log')).length;

    // A part of the object in frame 3 is what the person wants.
    shapeIn(left, 3).points = PART;
    shapeIn(left, 3).occluded = true;
    await save('update', [left]);
    assert.equal((await done(run(['correct', '42', '--tolerance', '0']))).changed, 1);

    const after = await tracks();
    const changed = groupOf(after, LEFT);
    assert.deepEqual([shapeIn(changed, 3).points, shapeIn(changed, 3).occluded, changed.source], [PART, true, 'semi-auto']);
    assert.deepEqual(groupOf(after, RIGHT), groupOf(before, RIGHT), 'nobody touched it, and its track is the same one');
    const saved = { action: 'update', groups: [LEFT] };
    assert.deepEqual((await ask('GET', '/test/log')).slice(asked), [saved, saved], 'once by the person, once by the program');
    const masks = await ask('GET', '/test/masks');
    assert.deepEqual(masks, masksOf(labels()));
    const sizes = [2, 3, 4].map((frame) => masks[LEFT][frame][0]);
    assert.ok(sizes.every((pixels) => pixels < 30 * 30), `${sizes} pixels: the neighbouring frames follow`);
    assert.deepEqual(await done(run(['correct', '42', '--tolerance', '0'])), nothing);
  });

  test('does not spread where it should not', async (t) => {
    const { run, ask, save, tracks } = await cvat(t);
    await done(run(['annotate', '42', '--label', 'thing']));
    const before = await ask('GET', '/test/masks');
    const left = groupOf(await tracks(), LEFT);
    shapeIn(left, 3).points = PART;
    await save('update', [left]);
    await done(run(['correct', '42', '--propagate', 'none']));
    const after = await ask('GET', '/test/masks');
    assert.deepEqual(shapeIn(groupOf(await tracks(), LEFT), 3).points, PART);
    for (const masks of [before, after]) delete masks[LEFT][3];
    assert.deepEqual(after, before, 'frames that nobody touched are as they were');
  });

  test('takes new tracks, deleted ones and frames that an object is not in, one after another', async (t) => {
    const { run, ask, save, tracks, labels } = await cvat(t);
    await done(run(['annotate', '42', '--label', 'thing', '--tolerance', '0']));
    const held = await tracks();
    await save('delete', [groupOf(held, RIGHT)]);
    const left = groupOf(held, LEFT);
    shapeIn(left, 5).outside = true;
    await save('update', [left]);
    assert.deepEqual(await done(run(['correct', '42', '--tolerance', '0'])), { task: 42, changed: 1, deleted: 1, tracks: 0 }, 'CVAT has it already');
    let masks = await ask('GET', '/test/masks');
    assert.equal(masks[RIGHT], undefined);
    assert.deepEqual([masks[LEFT][5], masks[LEFT][4] !== undefined, masks[LEFT][6] !== undefined], [undefined, true, true]);

    // Drawn in one frame, in the way of CVAT's page: without a group, and on to the end.
    const shape = { type: 'polygon', frame: 2, outside: false, occluded: false, z_order: 0, rotation: 0, points: square(116, 22, 36), attributes: [] };
    const other = { type: 'rectangle', frame: 0, outside: false, occluded: false, z_order: 0, rotation: 0, points: [1, 1, 20, 20], attributes: [] };
    await save('create', [
      { frame: 2, label_id: 9, group: 0, source: 'manual', shapes: [shape], attributes: [] },
      { frame: 0, label_id: 8, group: 0, source: 'manual', shapes: [other], attributes: [] },
    ]);
    assert.deepEqual(await done(run(['correct', '42', '--tolerance', '0'])), { task: 42, changed: 1, deleted: 0, tracks: 1 });
    const after = await tracks();
    const added = after.find(({ label_id: label }) => label === 9);
    assert.ok(added.group > 2, `object ${added.group} has a number that none had`);
    assert.deepEqual(shapeIn(added, 2).points, shape.points);
    assert.ok(added.shapes.filter(({ outside }) => !outside).length > 3, 'it is followed through the clip');
    assert.equal(after.filter(({ label_id: label }) => label === 8).length, 1, 'other shapes are not ours');
    masks = await ask('GET', '/test/masks');
    assert.deepEqual([masks[RIGHT], masks[LEFT][5]], [undefined, undefined], 'what was said before still holds');
    assert.deepEqual(masks, masksOf(labels()));
  });

  test('an upload that breaks off is ended by another run, and nothing is said twice', async (t) => {
    const { run, ask, save, tracks, out } = await cvat(t);
    const annotate = ['annotate', '42', '--label', 'thing', '--tolerance', '0'];
    const breaks = (...which) => ask('POST', '/test/settings', { breaks: which.length > 0 ? which : null });
    const brokenOff = async (args, ...which) => {
      await breaks(...which);
      await refused(run(args), 'cvat-unreachable');
      await breaks();
    };
    await brokenOff(annotate, 1, false);
    assert.deepEqual(await tracks(), []);
    await brokenOff(annotate, 1, true);
    assert.equal((await tracks()).length, 2, 'CVAT has them, and nobody was told');
    assert.deepEqual(await done(run(annotate)), { task: 42, frames: LENGTH, objects: 2 });
    assert.deepEqual((await ask('GET', '/test/log')).length, 1);

    // A part of the left square, and another one of it in a track of its own; the right square is not in frame 5.
    const held = await tracks();
    const [left, right] = [groupOf(held, LEFT), groupOf(held, RIGHT)];
    shapeIn(left, 3).points = PART;
    shapeIn(right, 5).outside = true;
    await save('update', [left, right]);
    const shape = { type: 'polygon', frame: 6, outside: false, occluded: false, z_order: 0, rotation: 0, points: square(8, 8, 12), attributes: [] };
    await save('create', [{ frame: 6, label_id: 7, group: LEFT, source: 'manual', shapes: [shape], attributes: [] }]);
    const [given, asked] = [await tracks(), (await ask('GET', '/test/log')).length];
    const correct = (folder) => ['correct', '42', '--tolerance', '0', '--out', folder];
    const begin = async (name) => {
      await ask('POST', '/test/tracks', given);
      cpSync(out, `${out}-${name}`, { recursive: true });
      return correct(`${out}-${name}`);
    };
    const outcome = async () => ({
      tracks: (await tracks()).sort((one, other) => one.group - other.group).map(withoutIds),
      masks: await ask('GET', '/test/masks'),
    });
    await done(run(await begin('straight')));
    const straight = await outcome();
    assert.deepEqual((await ask('GET', '/test/log')).slice(asked).map(({ action }) => action), ['update', 'delete'], 'there is a moment between two');
    const interrupted = await begin('interrupted');
    await brokenOff(interrupted, 2, false);
    const { changed, deleted } = await done(run(interrupted));
    assert.deepEqual([changed, deleted], [0, 0], 'nobody has changed anything since');
    assert.deepEqual(await outcome(), straight);
    assert.deepEqual(masksOf(labelsIn(`${out}-interrupted/clip/labels`)), masksOf(labelsIn(`${out}-straight/clip/labels`)));

    // A person's changes before the other run are not undone by it.
    const args = await begin('person');
    await brokenOff(args, 1, true);
    const mine = groupOf(await tracks(), RIGHT);
    shapeIn(mine, 1).points = square(116, 22, 36);
    await save('update', [mine]);
    assert.equal((await done(run(args))).changed, 1);
    assert.deepEqual(shapeIn(groupOf(await tracks(), RIGHT), 1).points, square(116, 22, 36));
    assert.deepEqual(await done(run(args)), { task: 42, changed: 0, deleted: 0, tracks: 0 });
  });

  test('with a password, and without the frames that were deleted', async (t) => {
    const { run, ask, tracks } = await cvat(t);
    await ask('POST', '/test/settings', { deleted_frames: [1, 7] });
    const { frames } = await done(run(['annotate', '42', '--label', 'thing', '--auth', 'annotator'], { PASS: 'only-for-tests' }));
    assert.equal(frames, LENGTH - 2);
    for (const { shapes } of await tracks()) assert.ok(shapes.every(({ frame }) => frame !== 1 && frame !== 7));
  });

  test('is refused with a sentence, before anything is written to CVAT', async (t) => {
    const { run, ask, out } = await cvat(t);
    const annotate = ['annotate', '42', '--label', 'thing'];
    await Promise.all([
      refused(run(annotate, { CVAT_ACCESS_TOKEN: 'another' }), 'cvat-answered'),
      refused(run(['annotate', '41', '--label', 'thing']), 'cvat-answered'),
      refused(run(['annotate', '42']), 'no-label'),
      refused(run(['annotate', '42', '--label', 'frame']), 'no-label'),
      refused(run(['correct', '42']), 'not-annotated'),
      refused(run([...annotate, '--frames', '7']), 'too-many-frames'),
      refused(run([...annotate, '--pixels', '1000']), 'frame-size-unsupported'),
      refused(run([...annotate, '--veronese', 'no-such-program']), 'no-program'),
    ]);
    await ask('POST', '/test/settings', { segment_size: 4 });
    await refused(run(annotate), 'several-jobs');
    await ask('POST', '/test/settings', { segment_size: LENGTH });
    assert.deepEqual(await ask('GET', '/test/log'), []);
    await done(run(annotate));
    await Promise.all([
      refused(run(annotate), 'annotated-already'),
      refused(run([...annotate, '--out', `${out}-2`]), 'task-not-empty'),
      refused(run(['correct', '41']), 'wrong-folder'),
    ]);
  });

  test('sends its credentials to one server', async (t) => {
    const asked = [];
    const other = await listen(t, (incoming, response) => {
      asked.push(incoming.headers.authorization);
      response.writeHead(404).end();
    });
    const first = await listen(t, (incoming, response) => response.writeHead(302, { Location: other + incoming.url }).end());
    const args = ['annotate', '42', '--out', temporaryFolder(t).path('work'), '--server-host'];
    await refused(run([...args, first]), 'cvat-answered');
    assert.deepEqual(asked, [undefined]);
    await refused(run([...args, 'http://127.0.0.1:9']), 'cvat-unreachable');
  });
});

test('the SDK is the one that the tests of formats use', { skip }, () => {
  const of = (path) => /^cvat[-_]sdk==(\S+)$/m.exec(readFileSync(here(path), 'utf8'))?.[1];
  assert.ok(of('../../../examples/hosts/requirements.txt'));
  assert.equal(of('../../../examples/hosts/requirements.txt'), of('../support/requirements.txt'));
});
