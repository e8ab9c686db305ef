// `veronese clip` with corrections, and what it keeps for another run.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { davisPalette } from 'veronese';
import { encodePng } from 'veronese/codecs';
import { segmented } from './support/direct.mjs';
import { clip as framesOf, labelsOf, lines, results, tracksOf, tree } from './support/folders.mjs';
import { frame, png } from './support/frames.mjs';
import { signalledAt } from './support/stopping.mjs';
import * as three from './support/three.mjs';
import { veronese, veroneseProcess } from './support/program.mjs';

const COUNT = 6;
const SIZE = { width: 96, height: 72 };
const PIXELS = SIZE.width * SIZE.height;
const FAST = { quality: 'fast' };
const clipFrame = (k) => frame(k / 2, SIZE);

/** A folder of frames, one for corrections, one for masks, and places for results. */
function clip(t, count = COUNT, picture = clipFrame) {
  const folder = framesOf(t, count, picture);
  const { path } = folder;
  for (const name of ['painted', 'masks']) mkdirSync(path(name));
  const paint = (name, content) => writeFileSync(path('painted', name), content);
  const give = (name, content) => writeFileSync(path('masks', name), content);
  return { ...folder, corrections: path('painted'), paint, masks: path('masks'), give };
}

/** The square in frame 3 as an object 9; the rest is ground. */
const LABELS = Uint8Array.from({ length: PIXELS }, (_, p) => {
  const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
  return x >= 27 && x < 63 && y >= 20 && y < 56 ? 9 : 0;
});
/** A disc with a smoothed edge. */
const disc = (level) => LABELS.map((_, p) => Math.min(level, Math.max(0, 40 * (30 - Math.hypot((p % 96) - 48, Math.floor(p / 96) - 36)))));
const mask = (labels = LABELS, { width, height } = SIZE) => encodePng(width, height, labels, { palette: davisPalette() });

async function run(args, { code = 0, ...options } = {}) {
  const done = await veronese(['clip', '--quality', 'fast', ...args], options);
  assert.equal(done.code, code, done.stderr);
  if (code === 0) assert.equal(done.stderr, '');
  return { ...done, lines: lines(done.stdout) };
}

describe('veronese clip --corrections', () => {
  test('label images, masks, prompts and edits of both folders are those of the call', async (t) => {
    const { frames, corrections, paint, masks, give, out } = clip(t);
    const square = LABELS.map((label) => label && 7);
    // A corner of the ground.
    const corner = LABELS.map((_, p) => (p % SIZE.width >= 78 && p >= 58 * SIZE.width ? 1 : 255));
    give('f1.png', await mask(corner));
    give('f3.png', await mask(square));
    give('edits.json', '{"names": {"7": "square"}, "propagate": {"f1": "none"}}');
    const stroke = square.map((label, p) => (label > 0 && p % SIZE.width < 45 ? 20 : 255));
    const prompts = [{ frame: 'f2', object: 14, clicks: [[90, 60, 1], [88, 40, -1]], box: [80, 50, 15, 20] }, { frame: 'f5', object: 12, clicks: [[90, 5, 1]] }];
    paint('f3.PNG', await encodePng(SIZE.width, SIZE.height, stroke));
    paint('edits.json', JSON.stringify({ merge: [[20, 14]], names: { 20: 'part' }, locked: [1], prompts, propagate: { f5: 'none' } }));
    paint('notes.txt', 'no correction');
    const { lines } = await run([frames, '--masks', masks, '--corrections', corrections, '--out', out]);
    const annotations = [
      { frame: 1, labels: corner, propagate: 'none', own: true },
      { frame: 3, labels: square, own: true },
      { frame: 3, labels: stroke },
      { ...prompts[0], frame: 2 },
      { ...prompts[1], frame: 5, propagate: 'none' },
    ];
    const descriptions = { 7: { name: 'square' }, 20: { name: 'part' }, 14: { name: 'part' } };
    const direct = await segmented(COUNT, clipFrame, FAST, { annotations, merged: [[20, 14]], descriptions, locked: [1] });
    for (const { index, labels } of direct.frames) assert.deepEqual(labelsOf(out, index), labels);
    assert.deepEqual(labelsOf(out, 3), square.map((label, p) => (stroke[p] === 20 ? 20 : label)), 'masks keep their numbers, to the pixel');
    assert.deepEqual(lines.map(({ objects }) => objects), [...direct.frames.map(({ objects }) => objects.map(({ id }) => id)), direct.tracks.objects.length]);
    const { objects, settings } = tracksOf(out);
    assert.deepEqual(objects, JSON.parse(JSON.stringify(direct.tracks.objects)));
    for (const hash of [settings.masks, settings.corrections]) assert.match(hash, /^[0-9a-f]{64}$/);
  });

  test('polygons of edits.json are the masks of their objects in their frames, to the pixel', async (t) => {
    const { frames, corrections, paint, out } = clip(t);
    const inside = (p, [left, top, right, bottom]) => p % SIZE.width >= left && p % SIZE.width < right && p >= top * SIZE.width && p < bottom * SIZE.width;
    const rectangle = ([left, top, right, bottom]) => [[left, top], [right, top], [right, bottom], [left, bottom]];
    const [one, other] = [[20, 10, 40, 30], [50, 20, 70, 60]];
    // In two parts; a slanted side passes through no centre. Vertices may lie outside of the picture.
    const triangle = [[-4, 50], [19.5, 50], [-4, 80]];
    paint('f1.png', await mask(LABELS.map((_, p) => (p < 200 ? 4 : 255))));
    const polygons = [{ frame: 'f3', object: 1, points: rectangle(one) }, { frame: 'f3', object: 1, points: rectangle(other) }, { frame: 'f1', object: 12, points: triangle }];
    paint('edits.json', JSON.stringify({ polygons, propagate: { f1: 'none' } }));
    await run([frames, '--corrections', corrections, '--out', out]);
    const is = (object, labels) => labels.map((label) => Number(label === object));
    const outlines = [[3, 1, (p) => inside(p, one) || inside(p, other)], [1, 12, (p) => p % SIZE.width <= 19 && Math.floor(p / SIZE.width) >= 50 && (p % SIZE.width + 4) / 23.5 + (Math.floor(p / SIZE.width) - 50) / 30 < 1]];
    for (const [frame, object, isIn] of outlines) assert.deepEqual(is(object, labelsOf(out, frame)), LABELS.map((_, p) => Number(isIn(p))));
    // What was merged into the object is part of it, and is not outside the outline either.
    paint('edits.json', JSON.stringify({ polygons: polygons.slice(0, 2).map((polygon) => ({ ...polygon, object: 9 })), prompts: [{ frame: 'f3', object: 1, box: [23, 16, 44, 44] }], merge: [[9, 1]] }));
    await run([frames, '--corrections', corrections, '--out', out]);
    assert.deepEqual(is(9, labelsOf(out, 3)), LABELS.map((_, p) => Number(outlines[0][2](p))));
  });

  test('solves no pair again, whatever is annotated later, and gives the files of a straight run', async (t) => {
    const { frames, corrections, paint, out, path } = clip(t);
    await run([frames, '--out', out]);
    const log = join(out, '.clip', 'log');
    const base = results(out);
    assert.deepEqual(Object.keys(tree(out)).filter((name) => name.startsWith('.')), ['.clip', '.veronese', join('.clip', 'key'), join('.clip', 'log')]);
    const solved = readFileSync(log);
    paint('f3.png', await mask());
    await run([frames, '--corrections', corrections, '--out', out]);
    const first = tracksOf(out).settings.corrections;
    await run([frames, '--corrections', corrections, '--out', path('straight')]);
    assert.deepEqual(results(out), results(path('straight')));
    paint('edits.json', '{"delete": [9]}');
    const { lines } = await run([frames, '--corrections', corrections, '--out', out]);
    assert.deepEqual(lines.slice(0, -1).map(({ objects }) => objects), Array(COUNT).fill([1]), 'what was found is there again');
    assert.notEqual(tracksOf(out).settings.corrections, first);
    for (const name of ['f3.png', 'edits.json']) rmSync(join(corrections, name));
    await run([frames, '--corrections', corrections, '--out', out], { code: 1 });
    await run([frames, '--out', out]);
    assert.deepEqual(results(out), base, 'without corrections nothing is corrected');
    await run([frames, '--mark-unknown', '--out', out]);
    assert.ok(labelsOf(out, 0).includes(255));
    const later = readFileSync(log);
    assert.ok(later.subarray(0, solved.length).equals(solved) && later.length < 2 * solved.length, 'no pair was solved again');

    // It may be damaged or deleted.
    for (const spoil of [() => writeFileSync(log, readFileSync(log).fill(7, 60, 64)), () => writeFileSync(log, 'no log'), () => rmSync(join(out, '.clip'), { recursive: true })]) {
      spoil();
      await run([frames, '--overlay', '--out', out]);
      await run([frames, '--out', out]);
      assert.deepEqual(results(out), base);
      assert.deepEqual(readdirSync(join(out, '.clip')), ['key', 'log']);
    }
  });

  test('what is not read beside label images and beside frames is named, and is an error alone', async (t) => {
    const { frames, corrections, paint, out } = clip(t, 5);
    mkdirSync(join(corrections, 'clip-a'));
    for (const option of ['--corrections', '--masks']) {
      const { stderr } = await run([frames, option, corrections, '--out', out], { code: 1 });
      assert.match(stderr, /^veronese: error: invalid-input: nothing is read of the folder '.*painted': .*; 'clip-a' is not read: 'convert/);
    }
    paint('f3.png', await mask());
    paint('f4.tif', 'II*');
    for (const name of ['f0.tif', 'f10.TIFF', 'f9.tif']) writeFileSync(join(frames, name), 'II*');
    const messages = [`'${corrections}': not read: clip-a, f4.tif`, `'${frames}': not read: f0.tif and 2 more; frames are PNG, JPEG, WebP, BMP or PNM`];
    const { stderr, code } = await veronese(['clip', '--quality', 'fast', frames, '--corrections', corrections, '--out', out]);
    assert.deepEqual([code, stderr], [0, messages.map((message) => `veronese: note: ${message}\n`).join('')]);
    assert.deepEqual(tracksOf(out).notes, messages.map((message) => ({ code: 'file-left-out', message })));
    const batch = await veronese(['batch', '--quality', 'fast', frames, '--every', '4']);
    assert.deepEqual([batch.code, batch.stderr], [0, `veronese: note: ${messages[1]}\n`]);
  });

  test('masks, labels and prompts of the original size are scaled with the frames', async (t) => {
    const { frames, corrections, paint, give, masks, out, path } = clip(t);
    const options = [frames, '--max-size', '48', '--out'];
    const half = { width: 48, height: 36 };
    const scaled = Uint8Array.from({ length: 48 * 36 }, (_, p) => LABELS[(2 * Math.floor(p / 48) + 1) * 96 + 2 * (p % 48) + 1]);
    for (const [option, write, folder] of [['--corrections', paint, corrections], ['--masks', give, masks]]) {
      write('f3.png', await mask());
      write('edits.json', '{"size": [96, 72], "prompts": [{"frame": "f1", "object": 9, "clicks": [[41, 31, 1]], "box": [23, 17, 38, 39]}]}');
      await run([...options, out, option, folder]);
      write('f3.png', await mask(scaled, half));
      write('edits.json', '{"prompts": [{"frame": "f1", "object": 9, "clicks": [[20, 15, 1]], "box": [11, 8, 20, 20]}]}');
      await run([...options, path('small'), option, folder]);
      for (let k = 0; k < COUNT; k++) assert.deepEqual(labelsOf(out, k), labelsOf(path('small'), k));
      write('f3.png', await mask(new Uint8Array(80 * 72), { width: 80, height: 72 }));
      const { stderr } = await run([...options, out, option, folder], { code: 1 });
      assert.match(stderr, /f3\.png' has 80×72 pixels, the frames have 48×36/);
    }
  });

  test('--levels decides about smoothed levels', async (t) => {
    const { frames, give, masks, out } = clip(t);
    const soft = disc(200);
    give('f3.png', await encodePng(SIZE.width, SIZE.height, soft));
    await run([frames, '--masks', masks, '--out', out], { code: 1 });
    await run([frames, '--masks', masks, '--levels', '100', '--out', out]);
    assert.deepEqual(labelsOf(out, 3), soft.map((level) => Number(level >= 100)));
    assert.match((await run([frames, '--levels', 'some', '--masks', masks, '--out', out], { code: 2 })).stderr, /'--levels' must be 'exact' or a level from 1 to 65535, not 'some'/);
    assert.match((await run([frames, '--levels', '5', '--out', out], { code: 2 })).stderr, /'--levels' needs '--masks' or '--corrections'/);
  });

  test('names what is wrong before anything is written', async (t) => {
    const { frames, corrections, paint, out, path } = clip(t);
    const colours = await encodePng(SIZE.width, SIZE.height, Uint8Array.from({ length: 3 * PIXELS }, (_, at) => at * 7919));
    const soft = await encodePng(SIZE.width, SIZE.height, disc(255));
    const cases = [
      ['F1.png', await mask(), /F1\.png' has the name of no frame/],
      ['f1.png', await mask(new Uint8Array(64), { width: 8, height: 8 }), /f1\.png' has 8×8 pixels, the frames have 96×72/, 'frame-size-mismatch'],
      ['f1.png', (await mask()).subarray(0, -30), /f1\.png/, 'unreadable-image'],
      ['f1.png', colours, /f1\.png': it has (\d+ colours only between others|no labels: it is not an indexed or grey PNG)/],
      ['f1.png', soft, /f1\.png'(: it)? has \d+ levels only between others, .* --levels 128/],
      ['f1.tif', 'II*', /nothing is read of the folder .*'f1\.tif' is not read: save it as PNG/],
      ['notes.txt', 'none', /nothing is read of the folder .*there is no file of these/],
      ...[
        ['{"merge": [[1, 2]]', /edits\.json/, 'invalid-json'],
        ['{"boxes": {"f1": {"3": [9, 3, 9, 9]}}}', /there is no edit 'boxes'; there are merge, delete, background, names, locked, prompts, polygons, accepted, propagate, size/],
        ['{"locked": [3], "delete": [3]}', /object 3 is locked/, 'object-locked'],
        ['{"names": {}, "accepted": [], "merge": []}', /nothing is read of the folder '.*painted': (masks|labels) are NAME\.png.*; 'edits\.json' is empty/],
        ['{"size": [50, 50], "accepted": ["f1"]}', /edits\.json': it is about frames of 50×50 pixels, these have 96×72/, 'frame-size-mismatch'],
        ['{"propagate": ["f1"]}', /edits\.json': 'propagate' must be an object/],
        ['{"propagate": {"f1": "up"}}', /edits\.json': 'propagate' must have 'both', 'forward', 'backward' or 'none' for 'f1'/],
        ['{"propagate": {"f1": "none"}, "accepted": ["f2"]}', /'propagate' has 'f1', which has no annotation/],
        ['{"prompts": {"f1": 1}}', /edits\.json': 'prompts' must be a list of \{ frame, object, clicks, box \}/],
        ['{"prompts": [{"frame": "f1", "object": 3}]}', /'prompts', number 0: must have clicks, a box, or both/],
        ['{"prompts": [{"frame": "f1", "object": 3, "box": [9, 3, 9, 9], "clicks": [[1, 2, 1]]}]}', /'prompts', number 0: has a click at 1, 2 that belongs to object 3 and is not in its box/],
        ['{"prompts": [{"frame": "f1", "object": 3, "clicks": [[96, 2, 1]]}]}', /'prompts', number 0: 'clicks' must be .*, within the frame/],
        ['{"prompts": [{"frame": "f1", "object": 3, "box": [9, 3, 9, 9]}, {"frame": "f1", "object": 3, "clicks": [[1, 2, 1]]}]}', /object 3 is annotated in 'f1' twice/],
        ['{"polygons": [{"frame": "f1", "object": 3, "points": [[1, 2], [9, 2], [9]]}]}', /'polygons', number 0: must have points, three or more \[x, y\]/],
        ['{"polygons": [{"frame": "f1", "object": 3, "points": [[200, 2], [209, 2], [209, 8]]}]}', /'polygons', number 0: has no pixel of the frame/],
      ].map((one) => ['edits.json', ...one]),
    ];
    for (const [name, content, message, code = 'invalid-input'] of cases) {
      paint(name, content);
      for (const option of ['--corrections', '--masks']) {
        const { stderr, stdout } = await run([frames, option, corrections, '--out', out], { code: 1 });
        assert.match(stderr, new RegExp(`^veronese: error: ${code}: [^\\n]+\\n$`));
        assert.match(stderr, message);
        assert.deepEqual([stdout, existsSync(out)], ['', false]);
      }
      rmSync(join(corrections, name));
    }
    for (const [folder, code] of [[path('nowhere'), /file-not-found/], [join(frames, 'f0.png'), /unreadable-file/]])
      assert.match((await run([frames, '--corrections', folder, '--out', out], { code: 1 })).stderr, code);
    // Finished results stay as they are.
    await run([frames, '--out', out]);
    const before = tree(out);
    paint('g1.png', await mask());
    await run([frames, '--corrections', corrections, '--out', out], { code: 1 });
    assert.deepEqual(tree(out), before);
  });

  test('edits of objects that are not there are in a note, and those of objects that the same corrections make or delete are not', async (t) => {
    const { frames, corrections, paint, out } = clip(t);
    paint('f3.png', await mask());
    const edits = { merge: [[9, 40]], delete: [5, 20], background: [41], names: { 9: 'square', 42: 'car' }, locked: [43, 9], polygons: [{ frame: 'f2', object: 20, points: [[1, 1], [9, 1], [9, 9]] }] };
    paint('edits.json', JSON.stringify(edits));
    const args = ['clip', '--quality', 'fast', frames, '--corrections', corrections, '--out', out];
    const sentence = 'edits of objects that are not there change nothing: 5, 40, 41, 42, 43; the objects are 1, 9';
    for (const again of [false, true]) {
      const { stderr, code } = await veronese(args);
      assert.deepEqual([code, stderr], [0, `veronese: note: ${sentence}\n`], `again: ${again}`);
    }
    assert.deepEqual(tracksOf(out).notes, [{ code: 'object-missing', message: sentence }]);
  });

  test('a stream keeps nothing for another run, and takes no corrections: it has other numbers than the whole clip', async (t) => {
    const { frames, corrections, paint, masks, out } = clip(t);
    await run([frames, '--out', out]);
    await run([frames, '--look-ahead', '2', '--out', out]);
    assert.equal(existsSync(join(out, '.clip')), false);
    paint('edits.json', '{"names": {"1": "square"}}');
    for (const [option, folder] of [['--corrections', corrections], ['--masks', masks]]) {
      const { stderr } = await run([frames, '--look-ahead', '2', option, folder, '--out', out], { code: 2 });
      assert.match(stderr, /^veronese: error: usage: '--look-ahead' goes without '--masks' and '--corrections'/);
    }
  });

  test('a bad frame later in the clip: the labels before it are corrected and stay', async (t) => {
    const { frames, corrections, paint, out } = clip(t);
    for (const name of ['f3.png', 'f5.png']) paint(name, await mask());
    writeFileSync(join(frames, 'f4.png'), 'no picture');
    const args = [frames, '--corrections', corrections, '--out', out];
    for (let times = 0; times < 2; times++) {
      const { stderr, lines } = await run(args, { code: 1 });
      assert.match(stderr, /unreadable-image: [^\n]*f4\.png/);
      assert.deepEqual(lines.map(({ objects }) => objects), Array(4).fill([9]));
      assert.deepEqual([labelsOf(out, 3), existsSync(join(out, 'tracks.json'))], [LABELS, false]);
    }
    writeFileSync(join(frames, 'f4.png'), png(clipFrame(4)));
    await run(args);
    assert.deepEqual(labelsOf(out, 3), LABELS);
  });
});

describe('annotations through the command line', () => {
  const { box, labelled, middle } = three;
  const all = (out) => Array.from({ length: COUNT }, (_, k) => labelsOf(out, k));

  test('the last line has what they change, and so do tracks.json and the next run', async (t) => {
    const { frames, corrections, paint, out } = clip(t, COUNT, three.frame);
    await run([frames, '--out', out]);
    const before = all(out);
    assert.equal(tracksOf(out).changes, undefined);
    paint('edits.json', JSON.stringify({ prompts: [{ frame: 'f3', object: 9, box: box(3, 3) }], propagate: { f3: 'forward' } }));
    const args = [frames, '--corrections', corrections, '--out', out];
    const { lines, stdout } = await run(args);
    const count = (labels, of) => labels.flatMap((own, k) => [...own].filter((label, p) => of(label, before[k][p]))).length;
    const after = all(out);
    const { changed } = lines.at(-1);
    assert.deepEqual(changed.frames, [3, 4, 5]);
    for (const { id, gained, lost } of changed.objects) {
      assert.equal(gained, count(after, (now, then) => now === id && then !== id));
      assert.equal(lost, count(after, (now, then) => now !== id && then === id));
    }
    assert.deepEqual(changed.objects.map(({ id }) => id).filter((id) => id > 0), [3, 9]);
    const { changes } = tracksOf(out);
    assert.equal(changes.filter(({ object }) => object === 9).reduce((sum, { gained }) => sum + gained, 0), changed.objects.at(-1).gained);
    assert.equal((await run(args)).stdout, stdout, 'nothing is done again');
  });

  test('accepted frames stay as the run before wrote them, also when it was interrupted and its folder moved', async (t) => {
    const { frames, corrections, paint, out, path } = clip(t, COUNT, three.frame);
    const args = [frames, '--corrections', corrections, '--out'];
    const stroke = (square, k, label) => labelled(square, k, label).map((own, p) => (p % SIZE.width < middle(square, k)[0] ? own : 255));
    paint('f3.png', await mask(stroke(2, 3, 9)));
    await run([...args, out]);
    const seen = labelsOf(out, 1);
    assert.ok(seen.includes(9));
    // The corrections are other ones now.
    paint('edits.json', '{"accepted": ["f1"]}');
    paint('f3.png', await mask(stroke(1, 3, 8)));
    await run([...args, out]);
    assert.deepEqual(labelsOf(out, 1), seen);
    assert.ok(labelsOf(out, 3).includes(8) && !labelsOf(out, 3).includes(9));
    const second = results(out);
    paint('f4.png', await mask(stroke(3, 4, 7)));
    cpSync(out, path('moved'), { recursive: true });
    rmSync(join(out, 'tracks.json'));
    for (const folder of [out, path('moved')]) {
      await run([...args, folder]);
      assert.deepEqual(labelsOf(folder, 1), seen);
      assert.ok(labelsOf(folder, 4).includes(7));
    }
    rmSync(join(corrections, 'f4.png'));
    await run([...args, out]);
    assert.deepEqual(results(out), second);
    for (const name of readdirSync(corrections)) rmSync(join(corrections, name));
    await run([frames, '--out', out]);
    await run([frames, '--out', path('straight')]);
    assert.deepEqual(results(out), results(path('straight')), 'nothing is accepted any more');
  });
});

describe('an interrupted clip', { skip: process.platform === 'win32' }, () => {
  const { file, frames, out, path } = clip({ after });
  const args = [frames, '--jobs', '1', '--out'];
  /** Runs until a frame is read for the second time: it is looked at before all are read for their pairs, one after another. */
  const interrupted = (folder, signal, k) => veroneseProcess(['clip', '--quality', 'fast', ...args, folder], signalledAt({ file }, signal, { call: 'readFile', path: new RegExp(`f${k}\\.png$`), n: 2 }));
  const log = (folder) => readFileSync(join(folder, '.clip', 'log'));
  const copy = (name) => (cpSync(out, path(name), { recursive: true }), path(name));
  const same = async (one, other) => {
    for (const [folder, ...more] of [one, other]) await run([frames, ...more, '--out', folder]);
    assert.deepEqual(results(one[0]), results(other[0]));
  };

  before(async () => assert.equal((await interrupted(out, 'SIGINT', 4)).code, 130));

  test('has the pairs it has solved, and no tracks', async () => {
    await run([frames, '--out', path('straight')]);
    // One pair at least, and not all: how many depends on what ends first.
    assert.ok(log(out).length > log(path('straight')).length / 16 && log(out).length < log(path('straight')).length);
    assert.equal(existsSync(join(out, 'tracks.json')), false);
  });

  test('does not solve known pairs, however often it is interrupted: nothing is written again', async () => {
    const folder = copy('again');
    const begun = log(folder);
    await interrupted(folder, 'SIGKILL', 5);
    assert.ok(log(folder).subarray(0, begun.length).equals(begun));
    await run([frames, '--out', folder]);
    assert.ok(log(folder).subarray(0, begun.length).equals(begun));
    // Besides the commands.
    assert.ok(log(folder).length < log(path('straight')).length + 500);
  });

  test('goes on with them, and not with damaged ones, those of other options or of other frames', async () => {
    await same([copy('whole')], [path('straight')]);
    const damaged = copy('damaged');
    const content = log(out);
    const middle = Math.floor(content.length / 2);
    writeFileSync(join(damaged, '.clip', 'log'), content.fill(7, middle, middle + 9));
    await same([damaged], [path('straight')]);
    await same([copy('options'), '--motions', '2'], [path('straight-options'), '--motions', '2']);
    writeFileSync(join(frames, 'f1.png'), png(frame(7, SIZE)));
    await same([copy('content')], [path('straight-content')]);
  });
});

describe('veronese clip VIDEO', () => {
  const skip = spawnSync('ffmpeg', ['-version']).status !== 0 && 'the program ffmpeg is not installed';

  test('reads the video again for labels and, backwards too, for corrections', { skip }, async (t) => {
    const { frames, corrections, paint, out, path } = clip(t);
    const file = path('clip.mkv');
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', '-i', join(frames, 'f%d.png'), '-c:v', 'ffv1', '-pix_fmt', 'bgr0', file]);
    assert.equal(status, 0, String(stderr));
    paint('00003.png', await mask());
    const { lines } = await run([file, '--corrections', corrections, '--overlay', '--out', out]);
    assert.deepEqual(lines.slice(0, -1).map(({ objects }) => objects), Array(COUNT).fill([9]));
    rmSync(join(corrections, '00003.png'));
    paint('f3.png', await mask());
    await run([frames, '--corrections', corrections, '--overlay', '--out', path('frames-out')]);
    for (let k = 0; k < COUNT; k++) {
      for (const folder of ['labels', 'overlay']) {
        assert.deepEqual(readFileSync(join(out, folder, `0000${k}.png`)), readFileSync(path('frames-out', folder, `f${k}.png`)));
      }
    }
    const { stderr: refused } = await run([file, '--corrections', corrections, '--out', path('no')], { code: 1 });
    assert.match(refused, /f3\.png' has the name of no frame/);
  });
});
