// `veronese convert … --to corrections`: annotations, read back into a folder for `clip --corrections`.

import assert from 'node:assert/strict';
import { cpSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { decode } from 'fast-png';
import { davisPalette } from 'veronese';
import { clipFolder } from './support/clip.mjs';
import { frame, png } from './support/frames.mjs';
import { entries, notConverted, temporaryFolder, veronese } from './support/program.mjs';

const indices = (...path) => Uint8Array.from(decode(readFileSync(join(...path))).data);
const json = (...path) => JSON.parse(readFileSync(join(...path), 'utf8'));

async function run(...args) {
  const { code, stdout, stderr } = await veronese(args);
  assert.equal(stderr, '');
  assert.equal(code, 0);
  return stdout.trimEnd().split('\n').map((line) => JSON.parse(line));
}

test('what convert writes, read back into a folder with the names of the clip and its palette', async (t) => {
  const folder = temporaryFolder(t);
  const { frames, tracks } = clipFolder(folder.path('clip'), { names: { 2: 'car', 4: 'car' } });
  const all = folder.path('all');
  // What each format keeps is in annotations.test.mjs; of these the frames are only counted, or are in folders.
  const back = { 'cvat-video': 'cvat-video.xml', mots: 'mots', davis: 'davis', yolo: 'yolo' };
  await run('convert', folder.path('clip'), '--to', Object.keys(back).join(), '--tolerance', '0', '--background', '--frame-rate', '25', '--out', all);
  for (const [name, source] of Object.entries(back)) {
    const out = folder.path(`back-${name}`);
    const [answer] = await run('convert', join(all, source), '--to', 'corrections', '--clip', folder.path('clip'), '--out', out);
    const files = [...tracks.frames.map((stem) => `${stem}.png`), 'edits.json'];
    assert.deepEqual({ ...answer, format: undefined }, { version: 1, folder: out, files, frames: 7, format: undefined });
    assert.deepEqual(entries(out), files.sort());
    const { names, ...more } = json(out, 'edits.json');
    assert.deepEqual(more, {});
    // YOLO has no numbers: objects are counted.
    const called = { davis: {}, yolo: { 1: 'object', 2: 'car', 3: 'car' } };
    assert.deepEqual(names, called[name] ?? { 1: 'object', 2: 'car', 4: 'car' });
    if (name === 'yolo') continue;
    frames.forEach((labels, k) => {
      const picture = decode(readFileSync(join(out, `${tracks.frames[k]}.png`)));
      assert.deepEqual(picture.palette.map((colour) => colour.slice(0, 3)), davisPalette());
      assert.deepEqual(Uint8Array.from(picture.data), name === 'davis' ? labels : labels.map((label) => (label === 255 ? 0 : label)), `${name}, frame ${k}`);
    });
  }
});

test('a frame that was annotated elsewhere, and the clip again with it', async (t) => {
  const folder = temporaryFolder(t);
  const size = { width: 96, height: 72 };
  mkdirSync(folder.path('frames'));
  for (let k = 0; k < 5; k++) writeFileSync(folder.path('frames', `f${k}.png`), png(frame(k / 2, size)));
  await run('clip', folder.path('frames'), '--quality', 'fast', '--out', folder.path('out'));
  await run('convert', folder.path('out'), '--to', 'coco', '--out', folder.path('coco'));
  const document = json(folder.path('coco'), 'coco.json');
  // Somebody draws another object in frame 2, and deletes the annotations of the other frames.
  document.categories.push({ id: 99, name: 'thing' });
  const square = [60, 10, 90, 10, 90, 40, 60, 40];
  document.annotations = [{ id: 1, image_id: 3, category_id: 99, segmentation: [square], attributes: { track_id: 9 } }];
  folder.file('mine.json', JSON.stringify(document));
  const [{ files }] = await run('convert', folder.path('mine.json'), '--to', 'corrections', '--out', folder.path('said'));
  assert.deepEqual(files, ['f2.png', 'edits.json']);
  await run('clip', folder.path('frames'), '--quality', 'fast', '--corrections', folder.path('said'), '--out', folder.path('out'));
  const { objects } = json(folder.path('out'), 'tracks.json');
  const thing = objects.find(({ id }) => id === 9);
  assert.equal(thing.name, 'thing');
  assert.deepEqual(thing.frames.find(({ frame }) => frame === 2).bbox, [60, 10, 30, 30]);
  assert.deepEqual(indices(folder.path('out'), 'labels', 'f2.png'), indices(folder.path('said'), 'f2.png'));
});

test('a folder with the frames beside the annotations, and another run', async (t) => {
  const folder = temporaryFolder(t);
  clipFolder(folder.path('clip'));
  await run('convert', folder.path('clip'), '--to', 'yolo,coco', '--out', folder.path('all'));
  const yolo = folder.path('all', 'yolo');
  const [picture, text] = [png(frame(0, { width: 37, height: 23 })), (k) => `f00${k}.txt`];
  mkdirSync(join(yolo, 'images'));
  for (let k = 0; k < 7; k++) writeFileSync(join(yolo, 'images', `f00${k}.png`), picture);
  writeFileSync(join(yolo, '.hidden.json'), '{');
  const out = folder.path('said');
  const [{ frames }] = await run('convert', yolo, '--to', 'corrections', '--out', out);
  assert.equal(frames, 7);
  // Frames that are not annotated any more go; files of others stay.
  writeFileSync(join(out, 'mine.png'), 'mine');
  mkdirSync(folder.path('some'));
  const only = (k) => {
    cpSync(join(yolo, 'labels', text(k)), folder.path('some', text(k)));
    writeFileSync(folder.path('some', `f00${k}.png`), picture);
  };
  only(2);
  await run('convert', folder.path('some'), '--to', 'corrections', '--out', out);
  assert.deepEqual(entries(out), ['edits.json', 'f002.png', 'mine.png']);
  writeFileSync(join(out, 'f003.png'), 'mine as well');
  only(3);
  await notConverted(out, [folder.path('some'), '--to', 'corrections', '--out', out], 'file-exists', /f003\.png/);
  assert.equal(readFileSync(join(out, 'f003.png'), 'utf8'), 'mine as well');
  await notConverted(folder.path(), [folder.path('all'), '--to', 'corrections', '--out', folder.path('x')], 'invalid-input', /is coco and .* is yolo: give one of them/);
});

test('wrong usage and files that cannot be read', async (t) => {
  const folder = temporaryFolder(t);
  const file = folder.file('a.json', '{"images": [], "annotations": []}');
  const out = folder.path('out');
  const refused = (...rest) => notConverted(folder.path(), ...rest);
  const usage = (args, sentence) => refused(args, 'usage', sentence, 2);
  await usage([file, '--to', 'corrections'], /'--to corrections' needs '--out DIR'/);
  await usage([file, '--to', 'corrections,coco', '--out', out], /cannot be with formats that are written/);
  await usage([file, '--to', 'corrections', '--out', out, '--tolerance', '1'], /'--to corrections' has no option '--tolerance'/);
  await usage([file, '--to', 'coco', '--clip', out], /'--clip' needs '--to corrections'/);
  await usage([file, '--to', 'coco', '--levels', '9'], /'--levels' needs '--to corrections'/);
  await refused([file, '--to', 'corrections', '--out', out, '--first-frame', '2'], 'invalid-option', /'--first-frame'/, 2);
  await refused([file, '--to', 'corrections', '--quiet', '--out', out], 'invalid-input', /'.*a\.json' annotates no frame/);
  await refused([folder.path('none.json'), '--to', 'corrections', '--out', out], 'file-not-found', /none\.json/);
  await refused([folder.file('b.json', '{'), '--to', 'corrections', '--out', out], 'invalid-input', /b\.json': it is not JSON/);
  await refused([file, '--to', 'corrections', '--out', out, '--clip', folder.path('none')], 'file-not-found', /tracks\.json/);
  mkdirSync(folder.path('empty'));
  await refused([folder.path('empty'), '--to', 'corrections', '--out', out], 'invalid-input', /no file is an annotation/);
});
