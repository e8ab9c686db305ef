// `veronese clip`, run as a user does.
// cspell:ignore tkhd

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode, encode } from 'fast-png';
import { davisPalette, segmentStream, version } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { clipFrames } from '../build/cli/clip-frames.js';
import { notesOnVideo, timesOf, videoFrames } from '../build/cli/video.js';
import { segmented } from './support/direct.mjs';
import { clip as framesOf, labelsOf, lines, results, tracksOf, tree } from './support/folders.mjs';
import { frame, png, ramp } from './support/frames.mjs';
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
    const { frames: expected, tracks: known } = await segmented(COUNT, clipFrame, { quality: 'fast', motions: 3 });
    assert.ok(expected[0].objects.length > 0, 'something moves');
    assert.deepEqual(lines, [
      ...expected.map(({ index, objects }) => ({ frame: index, name: `f${index}`, objects: objects.map(({ id }) => id) })),
      { done: true, objects: known.objects.length },
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
    // Of a folder of frames no rate is known.
    assert.deepEqual(tracks, JSON.parse(JSON.stringify({ version: 1, ...SIZE, frames: NAMES, files, ...known })));
    assert.deepEqual(settings, { motions: 3, quality: 'fast', lookAhead: 'all', markUnknown: false, subject: false, every: 1, overlay: true, software: `veronese ${version}` });
  });

  test('writes the same files with any number of jobs, also where it was killed with others', async (t) => {
    const { frames, path } = clip(t, 8);
    const alone = await run([frames, '--out', path('1'), '--jobs', '1']);
    const expected = [alone.stdout, results(path('1'))];
    for (const name of ['tracks.json', '.clip/log']) rmSync(path('1', name));
    for (const folder of ['3', '1']) assert.deepEqual([(await run([frames, '--out', path(folder), '--jobs', '3'])).stdout, results(path(folder))], expected);
  });

  test('--look-ahead, --motions and --every reach the call; patterns, lists and single files keep their order', async (t) => {
    const { frames, path, one, out, file } = clip(t);
    await run([frames, '--out', out, '--look-ahead', '0', '--motions', '2', '--every', '2']);
    const direct = segmentStream([0, 2, 4].map(clipFrame), { quality: 'fast', lookAhead: 0, motions: 2 });
    for await (const { index, labels } of direct) assert.deepEqual(labelsOf(out, 2 * index), labels);
    assert.deepEqual(tracksOf(out).frames, ['f0', 'f2', 'f4']);
    await run([path('frames', 'f[0-2].png'), '--out', out]);
    assert.deepEqual(tracksOf(out).frames, ['f0', 'f1', 'f2']);
    await run(['--list', file('list', `${one(4)}\n${one(3)}\n`), '--out', out]);
    assert.deepEqual(tracksOf(out).files, ['f4.png', 'f3.png']);
    await run([one(2), one(1), '--out', out]);
    assert.deepEqual(tracksOf(out).frames, ['f2', 'f1']);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['f1.png', 'f2.png'], 'other inputs start anew');
  });

  test('does nothing again that is finished, and starts anew with other options or inputs', async (t) => {
    const { frames, one, out, path } = clip(t);
    const first = await run([frames, '--out', out]);
    const before = tree(out);
    cpSync(out, path('before'), { recursive: true });
    const times = () => NAMES.map((name) => statSync(join(out, 'labels', `${name}.png`), { bigint: true }).mtimeNs);
    const written = times();
    const second = await run([frames, '--out', out]);
    assert.deepEqual([second.stdout, times(), tree(out)], [first.stdout, written, before]);

    rmSync(join(out, 'labels', 'f2.png'));
    const third = await run([frames, '--out', out]);
    const isAgain = (time, k) => k === 2 || time === written[k];
    assert.deepEqual([third.stdout, results(out), times().every(isAgain)], [first.stdout, results(path('before')), true], 'what is missing is written again');

    const anew = async (change, args = []) => {
      change();
      const at = times();
      await run([frames, '--out', out, ...args]);
      assert.ok(times().every((time, k) => time > at[k]), change.name);
    };
    await anew(function loss() { rmSync(join(out, 'tracks.json')); });
    assert.deepEqual(results(out), results(path('before')));
    await anew(function option() {}, ['--motions', '2', '--overlay']);
    assert.ok(existsSync(join(out, 'overlay', 'f0.png')));
    await anew(function content() { writeFileSync(one(5), png(frame(7, SIZE))); });
    assert.equal(existsSync(join(out, 'overlay')), false, 'overlays of other options do not stay');
    writeFileSync(one(5), png(clipFrame(5)));
    renameSync(one(5), join(frames, 'g.png'));
    await run([frames, '--out', out]);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['f0.png', 'f1.png', 'f2.png', 'f3.png', 'f4.png', 'g.png']);
  });

  test('frames that are all alike have a note, unless that was asked for', async (t) => {
    const { frames, out, path } = framesOf(t, 3, () => clipFrame(0));
    const { code, stderr } = await veronese(['clip', frames, '--out', out]);
    assert.deepEqual([code, tracksOf(out).notes.map((note) => note.code)], [0, ['no-motion']]);
    assert.match(stderr, /^veronese: note: nothing moves[^\n]+\n$/);
    mkdirSync(path('painted'));
    writeFileSync(path('painted', 'edits.json'), '{"accepted": ["f1"]}');
    for (const more of [['--motions', '1'], ['--corrections', path('painted')]]) {
      await run([frames, '--out', out, ...more]);
      assert.equal(tracksOf(out).notes, undefined);
    }
  });

  test('frames with one stem, too few frames and missing ones are refused before anything is written', async (t) => {
    const { frames, one, out, path } = clip(t);
    mkdirSync(path('other'));
    writeFileSync(path('other', 'F1.PNG'), png(clipFrame(1)));
    const { stderr } = await fails([one(0), one(1), path('other', 'F1.PNG'), '--out', out], 'invalid-input');
    assert.match(stderr, /f1\.png.*F1\.PNG/);
    await fails([frames, '--every', '6', '--out', out], 'too-few-frames');
    await fails([path('nothing*.png'), '--out', out], 'file-not-found');
    await fails([path('nothing.mp4'), '--out', out], /file-not-found|ffmpeg-missing/.source);
    assert.equal(existsSync(out), false);
    await fails([frames, '--out', one(0)], 'write-failed');
  });

  test('a frame that does not fit is named; the labels before it stay, tracks.json does not come', async (t) => {
    const { frames, one, out } = clip(t);
    const spoiled = {
      'frame-size-mismatch': () => writeFileSync(one(3), png(frame(0, { width: 70, height: 48 }))),
      'unreadable-image': () => writeFileSync(one(3), 'no picture'),
      'unreadable-file': () => (rmSync(one(3)), mkdirSync(one(3))),
    };
    for (const [error, spoil] of Object.entries(spoiled)) {
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
  });
});

describe('frames as cameras write them', () => {
  /** The frames with 16 bits of which a camera uses 12, the first 8 of them nearly all dark. */
  const deep = (k) => {
    const { data, width, height } = clipFrame(k);
    const samples = Uint16Array.from({ length: width * height }, (_, p) => 300 + 4 * data[4 * p + 1]);
    return encode({ width, height, channels: 1, depth: 16, data: samples });
  };

  test('samples of 16 bits in a small part of their range are stretched alike in all frames, with a note', async (t) => {
    const { frames, one, out, path } = clip(t);
    for (let k = 0; k < COUNT; k++) writeFileSync(one(k), deep(k));
    const { code, stderr, stdout } = await veronese(['clip', '--quality', 'fast', frames, '--out', out]);
    assert.equal(code, 0, stderr);
    assert.match(stderr, /^veronese: note: the samples of 16 bits go from \d+ to \d+ only: [^\n]+\n$/);
    assert.deepEqual(lines(stdout).at(-1), { done: true, objects: 1 });
    assert.equal(tracksOf(out).notes[0].code, 'range-stretched');
    const pair = await veronese(['pair', one(0), one(4), '--out', path('pair')]);
    assert.match(pair.stderr, /note: the samples of 16 bits/);
    assert.equal(JSON.parse(pair.stdout).count, 2);
    assert.equal(JSON.parse(readFileSync(path('pair', 'result.json'), 'utf8')).notes[0].code, 'range-stretched');
  });

  test('a JPEG of which a part is missing is an error that names it, unless that is allowed', async (t) => {
    const { path, file } = framesOf(t, 0);
    const scan = ramp.jpeg.findLastIndex((byte, at) => byte === 0xda && ramp.jpeg[at - 1] === 0xff);
    const cut = Uint8Array.from([...ramp.jpeg.subarray(0, scan + 60), 0xff, 0xd9]);
    const names = [ramp.jpeg, ramp.jpeg, cut, ramp.jpeg].map((bytes, k) => file(`f${k}.jpg`, bytes));
    const { lines } = await fails([...names, '--out', path('out')], 'unreadable-image');
    assert.deepEqual(lines.map(({ name }) => name), ['f0', 'f1']);
    const clip = await veronese(['clip', ...names, '--allow-damaged', '--out', path('all')]);
    assert.deepEqual([clip.code, clip.stderr.match(/note: .*f2\.jpg: .*; what is missing is grey\n/g)?.length], [0, 1], clip.stderr);
    assert.equal(tracksOf(path('all')).notes[0].code, 'damaged-image');
    const refused = await veronese(['pair', names[0], names[2]]);
    assert.match(refused.stderr, /^veronese: error: unreadable-image: .*f2\.jpg: .*; '--allow-damaged' takes it as it is\n$/);
    const pair = await veronese(['pair', names[0], names[2], '--allow-damaged']);
    assert.deepEqual([pair.code, JSON.parse(pair.stdout).notes[0].code], [0, 'damaged-image']);
  });
});

describe('veronese clip VIDEO', () => {
  const { status: installed, stdout: version } = spawnSync('ffmpeg', ['-version']);
  const skip = installed !== 0 && 'the program ffmpeg is not installed';
  const asTheyAre = /^ffmpeg version n?4/.test(version) ? ['-vsync', 'passthrough'] : ['-fps_mode', 'passthrough'];

  test('names the labels by the number of the frame', { skip }, async (t) => {
    const { frames, out, path, file } = video(t, 'clip.mkv', '-c:v', 'ffv1', '-pix_fmt', 'bgr0');
    const { lines } = await run([file, '--every', '2', '--out', out]);
    assert.deepEqual(lines.map(({ name }) => name), ['00000', '00002', '00004', undefined]);
    assert.deepEqual(readdirSync(join(out, 'labels')), ['00000.png', '00002.png', '00004.png']);
    assert.deepEqual(tracksOf(out).files, ['clip.mkv#0', 'clip.mkv#2', 'clip.mkv#4']);
    await run([frames, '--every', '2', '--out', path('frames-out')]);
    assert.deepEqual(readFileSync(join(out, 'labels', '00002.png')), readFileSync(path('frames-out', 'labels', 'f2.png')));
    await fails([file, '--every', '6', '--out', path('one')], 'too-few-frames');
    assert.equal(existsSync(path('one', 'labels')), false);
  });

  /** The frames as a video, written with these arguments. */
  function video(t, name, ...args) {
    const made = clip(t);
    const file = made.path(name);
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', '-framerate', '10', '-i', join(made.frames, 'f%d.png'), ...args, file]);
    assert.equal(status, 0, String(stderr));
    return { ...made, file };
  }
  /** The frames of a video as they are decoded, and what is known of it. */
  async function read(file, every = 1) {
    const about = { times: [] };
    const pictures = [];
    for await (const { bytes } of videoFrames({ file, every, allowDamaged: false }, { signal: new AbortController().signal }, about)) pictures.push(await decodeImage(bytes));
    return { pictures, notes: notesOnVideo(file, about), times: timesOf(about, pictures.length, every) };
  }

  /** The mean difference of a picture from a frame, in grey levels; `place` is where a pixel of the frame is in the picture. */
  function difference({ data, width, height }, frame, place = (x, y) => [x, y]) {
    let sum = 0;
    frame.data.forEach((value, at) => {
      const [x, y] = place((at >> 2) % frame.width, Math.floor((at >> 2) / frame.width));
      if (x < width && y < height) sum += Math.abs(value - data[4 * (y * width + x) + (at % 4)]);
    });
    return sum / data.length;
  }

  test('reads frames of any pixels', { skip }, async (t) => {
    // Of 10 and 12 bits, grey of 16 and 8, with alpha, of an odd size.
    const kinds = [['yuv420p10le', 'ffv1'], ['gbrp12le', 'ffv1'], ['gray16le', 'ffv1'], ['gray', 'ffv1'], ['rgba', 'png'], ['yuv444p', 'ffv1', '-vf', 'crop=63:47:0:0']];
    for (const [format, codec, ...more] of kinds) {
      const { pictures } = await read(video(t, 'a.mkv', ...more, '-c:v', codec, '-pix_fmt', format).file);
      assert.equal(pictures.length, COUNT, format);
      for (const [k, picture] of pictures.entries()) assert.ok(difference(picture, clipFrame(k)) < 2, `${format}, ${k}: ${difference(picture, clipFrame(k))}`);
    }
  });

  // Old versions take it from the encoder's options, new ones from the frames.
  const light = (code) => ['-vf', `format=yuv420p10le,setparams=color_primaries=bt2020:color_trc=${code}:colorspace=bt2020nc`, '-color_trc', code];
  const ODD = [
    ['video-hdr', /'.*a\.mkv' is HDR \(PQ\): /, light('smpte2084')],
    ['video-hdr', /'.*a\.mkv' is HDR \(HLG\): /, light('arib-std-b67')],
    ['video-aspect', /the pixels of '.*a\.mkv' are no squares but 16:11: /, ['-vf', 'format=yuv420p,setsar=16/11']],
  ];
  test('knows of a video that it is HDR, or has other pixels than squares, and reads it; a note says so, in tracks.json too', { skip }, async (t) => {
    for (const [noteCode, sentence, args] of ODD) {
      const { notes, pictures } = await read(video(t, 'a.mkv', ...args, '-c:v', 'ffv1').file);
      assert.deepEqual([notes.map(({ code }) => code), pictures.length], [[noteCode], COUNT]);
      assert.match(notes[0].message, sentence);
    }
    const [noteCode, sentence, args] = ODD[2];
    const { file, out } = video(t, 'a.mkv', ...args, '-c:v', 'ffv1');
    for (const name of ['clip', 'batch']) {
      const { code, stderr } = await veronese([name, '--quality', 'fast', file, '--out', `${out}-${name}`]);
      assert.equal(code, 0, stderr);
      assert.match(stderr, new RegExp(`^veronese: note: ${sentence.source}[^\\n]+\\n$`));
    }
    assert.deepEqual(tracksOf(`${out}-clip`).notes.map(({ code }) => code), [noteCode]);
  });

  test('frames stand as they are shown', { skip }, async (t) => {
    const { file } = video(t, 'a.mp4', '-c:v', 'mpeg4', '-q:v', '1');
    // A quarter counter-clockwise, in the header of the track: the options of ffmpeg for it differ from version to version.
    const content = readFileSync(file);
    const matrix = content.indexOf('tkhd') + 44;
    [0, -(2 ** 16), 0, 2 ** 16, 0, 0, 0, SIZE.width * 2 ** 16, 2 ** 30].forEach((value, k) => content.writeInt32BE(value, matrix + 4 * k));
    writeFileSync(file, content);
    const { pictures: [first] } = await read(file);
    assert.deepEqual([first.width, first.height], [48, 64]);
    const { width } = SIZE;
    assert.ok(difference(first, clipFrame(0), (x, y) => [y, width - 1 - x]) < 5);
  });

  test('the rate and the times of the frames are in tracks.json and in what is converted', { skip }, async (t) => {
    const steady = video(t, 'a.mkv', '-c:v', 'ffv1', '-pix_fmt', 'bgr0');
    assert.deepEqual((await read(steady.file)).times, { frameRate: 10, timestamps: [0, 0.1, 0.2, 0.3, 0.4, 0.5] });
    assert.deepEqual((await read(steady.file, 2)).times, { frameRate: 5, timestamps: [0, 0.2, 0.4] });
    const { file, out, path } = video(t, 'a.mkv', '-vf', "setpts='(N+2*gte(N,3)+4)*0.1/TB'", ...asTheyAre, '-c:v', 'ffv1', '-pix_fmt', 'bgr0');
    await run([file, '--out', out]);
    const { frameRate, timestamps } = tracksOf(out);
    assert.deepEqual(timestamps, [0, 0.1, 0.2, 0.5, 0.6, 0.7]);
    assert.ok(Math.abs(frameRate - 5 / 0.7) < 1e-5, String(frameRate));
    const { code, stderr } = await veronese(['convert', out, '--to', 'mots', '--out', path('to')]);
    assert.equal(code, 0, stderr);
    assert.match(readFileSync(path('to', 'mots', 'seqinfo.ini'), 'utf8'), /frameRate=7\n/);
    // Finished work is used again.
    await run([file, '--out', out]);
    assert.deepEqual(tracksOf(out).timestamps, timestamps);
  });

  /** The frames of a clip that is named on the command line. */
  async function framesIn(file) {
    const frames = await clipFrames({ frames: [file], every: 1, allowDamaged: false }, { signal: new AbortController().signal });
    await frames.close();
    return frames;
  }

  test('an animation is a clip', { skip }, async (t) => {
    for (const name of ['a.gif', 'a.apng', 'a.png']) assert.equal((await framesIn(video(t, name, ...(name === 'a.gif' ? [] : ['-f', 'apng'])).file)).length, COUNT, name);
  });

  const canWrite = !skip && /libwebp_anim/.test(spawnSync('ffmpeg', ['-hide_banner', '-encoders']).stdout);
  const canRead = !skip && /webp_anim/.test(spawnSync('ffmpeg', ['-hide_banner', '-demuxers']).stdout);
  test('an animated WebP is a clip, where ffmpeg reads it; elsewhere an error has the remedy', { skip: skip || (!canWrite && 'this ffmpeg writes no WebP') }, async (t) => {
    const { file, out } = video(t, 'a.webp', '-c:v', 'libwebp_anim', '-lossless', '1');
    if (canRead) assert.equal((await framesIn(file)).length, COUNT);
    else {
      const { stderr } = await fails([file, '--out', out], 'unreadable-video');
      assert.match(stderr, /a\.webp' cannot be read by this version of ffmpeg: take a newer one, or make it a PNG or GIF file \(.+\)$/m);
    }
  });
});
