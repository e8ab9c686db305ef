// What `clip --show` writes to look at: a sheet, an object cut out, and films where there is an ffmpeg that encodes them.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { decode } from 'fast-png';
import { clip as framesOf } from './support/folders.mjs';
import { frame } from './support/frames.mjs';
import { entries, veronese, veroneseProcess } from './support/program.mjs';

const COUNT = 5;
const SIZE = { width: 63, height: 48 };
const clipFrame = (k) => frame(k / 2, SIZE);
const made = (t) => framesOf(t, COUNT, clipFrame);
const run = (...args) => veronese(['clip', '--quality', 'fast', ...args]);

const encoders = String(spawnSync('ffmpeg', ['-hide_banner', '-encoders']).stdout ?? '');
const lacks = ['libx264', 'libvpx-vp9', 'prores_ks', 'gif'].find((name) => !encoders.includes(` ${name} `));
const skip = lacks !== undefined && `there is no ffmpeg that encodes ${lacks}`;

test('a sheet, and an object on transparent ground; what is no longer asked for goes', async (t) => {
  const { frames, out } = made(t);
  const { code, stderr } = await run(frames, '--out', out, '--overlay', '--show', 'sheet.png,cutout-1,cutout-7');
  assert.equal(code, 0, stderr);
  assert.equal(stderr, "veronese: warning: there is no object 7: 'cutout-7' is transparent\n");
  assert.deepEqual(readdirSync(join(out, 'cutout-1')), Array.from({ length: COUNT }, (_, k) => `f${k}.png`));
  const cut = decode(readFileSync(join(out, 'cutout-1/f3.png')));
  const labels = decode(readFileSync(join(out, 'labels/f3.png'))).data;
  const expected = clipFrame(3).data.map((value, at) => (labels[at >> 2] === 1 ? value : 0));
  assert.deepEqual([cut.channels, Buffer.from(cut.data)], [4, Buffer.from(expected)]);
  assert.ok(labels.includes(1) && labels.includes(0));

  // Four in a row, then the last one; between them is white.
  const sheet = decode(readFileSync(join(out, 'sheet.png')));
  assert.deepEqual([sheet.width, sheet.height], [4 * 63 + 3 * 4, 2 * 48 + 4]);
  const row = (picture, left, top) => Buffer.from(picture.data.subarray(3 * (top * picture.width + left), 3 * (top * picture.width + left + 63)));
  const overlay = (k) => decode(readFileSync(join(out, `overlay/f${k}.png`)));
  assert.deepEqual(row(sheet, 2 * 67, 20), row(overlay(2), 0, 20));
  assert.deepEqual(row(sheet, 0, 52 + 20), row(overlay(4), 0, 20));
  assert.ok(row(sheet, 3 * 67, 52 + 20).every((value) => value === 255));

  assert.equal((await run(frames, '--out', out, '--show', 'sheet.png')).code, 0);
  assert.deepEqual(entries(out), ['.clip', 'labels', 'sheet.png', 'tracks.json']);
});

test('a name that is none, and no ffmpeg, are errors before any work', async (t) => {
  const { frames, out } = made(t);
  for (const [name, sentence] of [['overlay.mp5', /did you mean 'overlay\.mp4'/], ['cutout-255', /did you mean 'cutout-N'/], ['film', /known are overlay\.mp4, /], ['cutout-1.gif', /nothing is known as/], ['cutout-01', /nothing/]]) {
    const { code, stderr } = await run(frames, '--out', out, '--show', name);
    assert.equal(code, 2);
    assert.match(stderr, /^veronese: error: invalid-option: option '--show': /);
    assert.match(stderr, sentence);
  }
  assert.match((await run(frames, '--out', out, '--frame-rate', '3')).stderr, /usage: '--frame-rate' needs '--show'/);
  const { code, stderr } = await veroneseProcess(['clip', frames, '--out', out, '--show', 'cutout-1.webm'], { env: { PATH: out } });
  assert.equal(code, 1);
  assert.match(stderr, /^veronese: error: ffmpeg-missing: 'cutout-1\.webm' is written by the program ffmpeg, [^\n]*install it[^\n]*--overlay[^\n]*\n$/);
  assert.equal(statSync(out, { throwIfNoEntry: false }), undefined);
});

test('films have all frames, their size and rate, and transparency around an object', { skip }, async (t) => {
  const { frames, out } = made(t);
  const films = ['overlay.mp4', 'overlay.webm', 'overlay.gif', 'beside.mp4', 'cutout-1.webm', 'cutout-1.mov'];
  const { code, stderr } = await run(frames, '--out', out, '--show', films.join());
  assert.equal(code, 0, stderr);
  assert.match(stderr, /^veronese: note: the frame rate of '.*' is not known: films have 25 frames per second; '--frame-rate' says another\n$/);
  assert.deepEqual(entries(out), ['.clip', ...films, 'labels', 'tracks.json'].sort());
  // Another rate alone takes no note, and films anew.
  const again = await run(frames, '--out', out, '--frame-rate', '10', '--show', films.join());
  assert.deepEqual([again.code, again.stderr], [0, '']);

  const decoded = (name, ...decoder) => spawnSync('ffmpeg', [...decoder, '-i', join(out, name), '-f', 'rawvideo', '-pix_fmt', 'rgba', '-fps_mode', 'passthrough', 'pipe:1'], { maxBuffer: 1e9 });
  const labels = decode(readFileSync(join(out, 'labels/f0.png'))).data;
  for (const name of films) {
    const { stdout, stderr: messages } = decoded(name, ...(name === 'cutout-1.webm' ? ['-c:v', 'libvpx-vp9'] : []));
    // A row or column more where colours have half the resolution.
    const width = (name.startsWith('beside') ? 2 : 1) * 63 + (/\.(gif|mov)$|^beside/.test(name) ? 0 : 1);
    assert.equal(stdout.length, 4 * width * 48 * COUNT, `${name}: ${messages}`);
    assert.match(String(messages), / 10 fps/, name);
    const at = (x, y) => [...stdout.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)];
    if (name.startsWith('cutout')) assert.deepEqual([[32, 24], [5, 5]].map(([x, y]) => at(x, y)[3] > 127), [labels[24 * 63 + 32] === 1, false], name);
    if (name.startsWith('overlay')) assert.ok(at(32, 24)[0] > at(32, 24)[2] + 30 && Math.abs(at(5, 5)[0] - at(5, 5)[2]) < 30, `${name}: the square is red, the rest as it was`);
  }
});
