// `veronese clip`, run as a user does.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { davisPalette, segmentClip, version } from 'veronese';
import { clip as framesOf, lines, tracksOf, tree } from './support/folders.mjs';
import { frame, png } from './support/frames.mjs';
import { entries, veronese } from './support/program.mjs';

const COUNT = 6;
const SIZE = { width: 64, height: 48 };
const clipFrame = (k) => frame(k / 2, SIZE);
const NAMES = Array.from({ length: COUNT }, (_, k) => `f${k}`);
const clip = (t, count = COUNT) => framesOf(t, count, clipFrame);

async function run(args, { code = 0, ...options } = {}) {
  const done = await veronese(['clip', '--quality', 'fast', ...args], options);
  assert.equal(done.code, code, done.stderr);
  if (code === 0) assert.equal(done.stderr, '', 'nothing on stderr where nobody looks');
  return { ...done, lines: lines(done.stdout) };
}

/** Fails with one line on stderr that has the code. */
async function fails(args, error, code = 1) {
  const done = await run(args, { code });
  assert.match(done.stderr, new RegExp(`^veronese: error: ${error}: [^\\n]+\\n$`));
  return done;
}

describe('veronese clip', () => {
  test('writes labels of every frame and the tracks, and prints a line for each frame', async (t) => {
    const { frames, out } = clip(t);
    const { lines } = await run([frames, '--out', out, '--overlay', '--motions', '3']);
    const direct = segmentClip({ length: COUNT, read: clipFrame }, { quality: 'fast', motions: 3 });
    const expected = [];
    for await (const one of direct) expected.push(one);
    assert.ok(expected[0].objects.length > 0, 'something moves');
    assert.deepEqual(lines, [
      ...expected.map(({ index, objects }) => ({ frame: index, name: `f${index}`, objects: objects.map(({ id }) => id) })),
      { done: true, objects: direct.tracks().objects.length },
    ]);

    const files = NAMES.map((name) => `${name}.png`);
    assert.deepEqual([entries(out), readdirSync(join(out, 'labels')), readdirSync(join(out, 'overlay'))],
      [['.clip', 'labels', 'overlay', 'tracks.json'], files, files]);
    for (const { index, labels } of expected) {
      const picture = decode(readFileSync(join(out, 'labels', `f${index}.png`)));
      assert.deepEqual([picture.width, picture.height, picture.depth, picture.channels], [64, 48, 8, 1]);
      assert.deepEqual(new Uint8Array(picture.data), labels);
      assert.deepEqual(picture.palette, davisPalette());
      const overlay = decode(readFileSync(join(out, 'overlay', `f${index}.png`)));
      const { data } = clipFrame(index);
      labels.forEach((label, p) => label === 0 && assert.equal(overlay.data[3 * p], data[4 * p]));
    }

    const { job, settings, ...tracks } = tracksOf(out);
    assert.deepEqual(tracks, JSON.parse(JSON.stringify({ version: 1, ...SIZE, frames: NAMES, files, ...direct.tracks() })));
    assert.deepEqual(settings, { motions: 3, quality: 'fast', lookAhead: 'all', markUnknown: false, every: 1, overlay: true, software: `veronese ${version}` });
  });

  test('writes the same files with any number of jobs, also where it was killed with others', async (t) => {
    const { frames, path } = clip(t, 2 * COUNT);
    const alone = await run([frames, '--out', path('1'), '--jobs', '1']);
    for (const jobs of ['2', '5']) {
      const { stdout } = await run([frames, '--out', path(jobs), '--jobs', jobs]);
      assert.deepEqual([stdout, tree(path(jobs))], [alone.stdout, tree(path('1'))], `${jobs} jobs`);
    }
    rmSync(path('1', 'tracks.json'));
    rmSync(path('1', '.clip', 'state'));
    const { stdout } = await run([frames, '--out', path('1'), '--jobs', '3']);
    assert.deepEqual([stdout, tree(path('1'))], [alone.stdout, tree(path('2'))]);
    for (const jobs of ['0', '257', 'all']) await fails([frames, '--out', path('none'), '--jobs', jobs], 'invalid-option', 2);
  });

  test('--look-ahead, --motions and --every reach the call', async (t) => {
    const { frames, out } = clip(t);
    await run([frames, '--out', out, '--look-ahead', '0', '--motions', '2', '--every', '2']);
    const direct = segmentClip([0, 2, 4].map(clipFrame), { quality: 'fast', lookAhead: 0, motions: 2 });
    for await (const { index, labels } of direct) {
      assert.deepEqual(new Uint8Array(decode(readFileSync(join(out, 'labels', `f${2 * index}.png`))).data), labels);
    }
    assert.deepEqual(tracksOf(out).frames, ['f0', 'f2', 'f4']);
  });

  test('takes patterns, lists and single files in their order', async (t) => {
    const { path, one, out, file } = clip(t);
    await run([path('frames', 'f[0-2].png'), '--out', out]);
    assert.deepEqual(tracksOf(out).frames, ['f0', 'f1', 'f2']);
    await run(['--list', file('list', `${one(4)}\n${one(3)}\n`), '--out', out]);
    assert.deepEqual(tracksOf(out).files, ['f4.png', 'f3.png']);
    await run([one(2), one(1), '--out', out]);
    assert.deepEqual(tracksOf(out).frames, ['f2', 'f1']);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['f1.png', 'f2.png'], 'other inputs start anew');
  });

  test('does nothing again that is finished, and starts anew with other options or inputs', async (t) => {
    const { frames, one, out } = clip(t);
    const first = await run([frames, '--out', out]);
    const before = tree(out);
    const times = () => NAMES.map((name) => statSync(join(out, 'labels', `${name}.png`), { bigint: true }).mtimeNs);
    const written = times();
    const second = await run([frames, '--out', out]);
    assert.deepEqual([second.stdout, times(), tree(out)], [first.stdout, written, before]);

    const anew = async (change, args = []) => {
      change();
      const at = times();
      await run([frames, '--out', out, ...args]);
      assert.ok(times().every((time, k) => time > at[k]), change.name);
    };
    await anew(function loss() { rmSync(join(out, 'tracks.json')); });
    assert.deepEqual(tree(out), before);
    await anew(function option() {}, ['--motions', '2', '--overlay']);
    assert.ok(existsSync(join(out, 'overlay', 'f0.png')));
    await anew(function content() { writeFileSync(one(5), png(frame(7, SIZE))); });
    assert.equal(existsSync(join(out, 'overlay')), false, 'overlays of other options do not stay');
    writeFileSync(one(5), png(clipFrame(5)));
    renameSync(one(5), join(frames, 'g.png'));
    writeFileSync(join(out, 'mine.txt'), 'mine');
    await run([frames, '--out', out]);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['f0.png', 'f1.png', 'f2.png', 'f3.png', 'f4.png', 'g.png']);
    assert.equal(readFileSync(join(out, 'mine.txt'), 'utf8'), 'mine');
  });

  test('frames with one stem, too few frames and missing ones are refused before anything is written', async (t) => {
    const { frames, one, out, path } = clip(t);
    mkdirSync(path('other'));
    writeFileSync(path('other', 'F1.PNG'), png(clipFrame(1)));
    const { stderr } = await fails([one(0), one(1), path('other', 'F1.PNG'), '--out', out], 'invalid-input');
    assert.match(stderr, /f1\.png.*F1\.PNG/);
    await fails([one(0), one(0), '--out', out], 'invalid-input');
    await fails([one(0), '--out', out], 'too-few-frames');
    await fails([frames, '--every', '6', '--out', out], 'too-few-frames');
    await fails([path('nothing*.png'), '--out', out], 'file-not-found');
    await fails([path('nothing.mp4'), '--out', out], /file-not-found|ffmpeg-missing/.source);
    assert.equal(existsSync(out), false);
    await fails([frames, '--out', one(0)], 'write-failed');
  });

  test('a frame that does not fit is named; the labels before it stay, tracks.json does not come', async (t) => {
    const { frames, one, out } = clip(t);
    const cases = [
      ['frame-size-mismatch', () => writeFileSync(one(3), png(frame(0, { width: 70, height: 48 })))],
      ['unreadable-image', () => writeFileSync(one(3), 'no picture')],
      ['unreadable-file', () => { rmSync(one(3)); mkdirSync(one(3)); }],
    ];
    for (const [error, spoil] of cases) {
      await run([frames, '--out', out]);
      spoil();
      const { stderr, lines } = await fails([frames, '--out', out], error);
      assert.match(stderr, /f3\.png/);
      assert.deepEqual(lines.map(({ name }) => name), ['f0', 'f1', 'f2']);
      assert.equal(existsSync(join(out, 'tracks.json')), false);
      for (const name of ['f0', 'f1', 'f2']) decode(readFileSync(join(out, 'labels', `${name}.png`)));
      rmSync(one(3), { recursive: true });
      writeFileSync(one(3), png(clipFrame(3)));
    }
    rmSync(one(3));
    await fails([one(0), one(1), one(3), '--out', out], 'file-not-found');
  });
});

describe('veronese clip VIDEO', () => {
  const skip = spawnSync('ffmpeg', ['-version']).status !== 0 && 'the program ffmpeg is not installed';

  test('names the labels by the number of the frame', { skip }, async (t) => {
    const { frames, out, path } = clip(t);
    const file = path('clip.mkv');
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', '-i', join(frames, 'f%d.png'), '-c:v', 'ffv1', '-pix_fmt', 'bgr0', file]);
    assert.equal(status, 0, String(stderr));
    const { lines } = await run([file, '--every', '2', '--out', out]);
    assert.deepEqual(lines.map(({ name }) => name), ['00000', '00002', '00004', undefined]);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['00000.png', '00002.png', '00004.png']);
    assert.deepEqual(tracksOf(out).files, ['clip.mkv#0', 'clip.mkv#2', 'clip.mkv#4']);
    await run([frames, '--every', '2', '--out', path('frames-out')]);
    assert.deepEqual(readFileSync(join(out, 'labels', '00002.png')), readFileSync(path('frames-out', 'labels', 'f2.png')));
    await fails([file, '--every', '6', '--out', path('one')], 'too-few-frames');
    assert.equal(existsSync(path('one', 'labels')), false);
  });
});
