// `veronese convert`: of pairs, clips (drawn here) and batches the files that `encode` gives; of annotations a folder for `clip --corrections`.

import assert from 'node:assert/strict';
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, unlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { davisPalette, groupLabels } from 'veronese';
import { encode } from 'veronese/formats';
import { openClip } from '../build/cli/clip-folder.js';
import { FORMATS } from '../build/formats/encode.js';
import { davisPng } from '../build/formats/pictures.js';
import { clipFolder, drawnClip, tracksOf } from './support/clip.mjs';
import { frame, pair, png } from './support/frames.mjs';
import { converted, entries, notConverted as refused, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';
import { signalledAt } from './support/stopping.mjs';

const EVERY = Object.keys(FORMATS);
const [TRACKS, IMAGES] = [true, false].map((tracks) => EVERY.filter((name) => (FORMATS[name].tracks ?? false) === tracks));
const OPTIONS = ['usage', 'wrong-usage', 'invalid-option'];

const read = (...path) => readFileSync(join(...path), 'utf8');
const json = (...path) => JSON.parse(read(...path));
const indices = (...path) => Uint8Array.from(decode(readFileSync(join(...path))).data);

/** Every file below, as sorted paths. */
function files(folder) {
  return readdirSync(folder, { recursive: true })
    .filter((name) => statSync(join(folder, name)).isFile())
    .sort();
}

async function run(...args) {
  const { code, stdout, stderr } = await veronese(args);
  assert.deepEqual([code, stderr], [0, '']);
  return stdout.trimEnd().split('\n').map((line) => JSON.parse(line));
}

describe('a pair', () => {
  /** A folder as `pair --out` leaves it. */
  async function segmented(t, ...options) {
    const folder = temporaryFolder(t);
    const [first, second] = pair().map((frame, k) => folder.file(`${k}.png`, png(frame)));
    const out = folder.path('out');
    await run('pair', first, second, '--out', out, ...options);
    return { folder, out, result: json(out, 'result.json'), labels: indices(out, 'labels.png') };
  }

  test('what the encoders give, beside the result; the rest is left alone', async (t) => {
    const { out, result, labels } = await segmented(t);
    const before = readdirSync(out);
    const { version, folder, files } = await converted(out, '--to', 'coco,cvat,davis', '--image', 'a.png');
    assert.deepEqual({ version, folder, files }, { version: 1, folder: out, files: ['coco.json', 'cvat.xml', 'davis.png'] });
    assert.deepEqual(readdirSync(out).sort(), [...before, ...files].sort());
    const { width, height, motions } = result;
    const objects = motions.map(({ label }) => label).filter((label) => label > 0);
    assert.ok(objects.length > 0);
    for (const [k, format] of ['coco', 'cvat', 'davis'].entries()) {
      const [{ name, content }] = await encode(format, { labels, width, height, motions, image: 'a.png' }, { labels: objects });
      assert.equal(name, files[k]);
      assert.deepEqual(readFileSync(join(out, name)), Buffer.from(content));
    }
  });

  test('every format, one that is named twice only once; the background only with --background', async (t) => {
    const { folder, out, result } = await segmented(t, '--mark-unknown');
    const { files } = await converted(out, '--to', `${EVERY},coco`, '--out', folder.path('all'));
    assert.equal(new Set(files).size, files.length);
    assert.equal(files.length, EVERY.length + 1, 'YOLO has two files');
    assert.deepEqual(entries(folder.path('all')), files.map((name) => name.replace('/', '')).sort());
    const all = result.motions.map(({ label }) => label);
    for (const [args, wanted] of [[[], all.filter((label) => label > 0)], [['--background'], all]]) {
      await converted(out, '--to', 'coco,coco-polygon,yolo', ...args);
      for (const name of ['coco.json', 'coco-polygon.json']) assert.deepEqual(json(out, name).annotations.map(({ category_id }) => category_id - 1), wanted);
      assert.equal(read(out, 'yolo.txt').trim().split('\n').length, wanted.length);
    }
  });

  test('--grouped converts groups, also where labels.png shows them already', async (t) => {
    const { folder, out, result, labels } = await segmented(t);
    const groups = groupLabels({ labels, motions: result.motions });
    const again = await segmented(t, '--grouped');
    for (const [source, name] of [[out, 'a'], [again.out, 'b']]) {
      await converted(source, '--to', 'davis,coco', '--grouped', '--background', '--out', folder.path(name));
      assert.deepEqual(indices(folder.path(name, 'davis.png')), groups);
      const { categories, annotations } = json(folder.path(name, 'coco.json'));
      assert.equal(categories[0].name, 'group-0');
      for (const { category_id, area } of annotations) assert.equal(area, groups.filter((group) => group === category_id - 1).length);
    }
  });

  test('says what is wrong and writes nothing', async (t) => {
    const { folder, out, result } = await segmented(t);
    const bad = (name, content) => {
      const path = folder.path(name.replace(/\W/g, '-'));
      mkdirSync(path);
      writeFileSync(join(path, 'labels.png'), readFileSync(join(out, 'labels.png')));
      writeFileSync(join(path, 'result.json'), typeof content === 'string' ? content : JSON.stringify(content));
      return path;
    };
    const photo = bad('photo', result);
    writeFileSync(join(photo, 'labels.png'), png(pair()[0]));
    const [first, ...rest] = result.motions;
    const damaged = [{ bbox: [0, 0, 1] }, { group: 300 }, { label: 256 }, { share: null }, { residual: 'x' }].map((change) =>
      bad(JSON.stringify(change), { ...result, motions: [{ ...first, ...change }, ...rest.map((motion) => ({ ...motion, group: 0 }))] }));
    const wrong = [
      [[out], 'usage', /needs '--to FORMATS'/],
      [['--to', 'coco'], 'usage', /takes one folder/],
      [[out, '--to', 'coco', '--overlay'], 'wrong-usage', /has no option '--overlay'/],
      [[out, '--to', 'coco,xyz'], 'invalid-option', /there is no format 'xyz'/],
      [[out, '--to', 'toString'], 'invalid-option', /toString/],
      [[folder.path(), '--to', 'coco'], 'file-not-found', /labels\.png/],
      [[out, '--to', 'coco', '--out', join(out, 'result.json')], 'write-failed', /it is a file/],
      ...['--from=1', '--until=0', '--shapes=box', '--video=a.mp4', '--frame-rate=5'].map((option) => [[out, '--to', 'coco', option], 'invalid-option', /is not for/, 1]),
      [[bad('text', 'no'), '--to', 'coco'], 'invalid-json', /is not JSON/],
      [[bad('other', '{"width": 3}'), '--to', 'coco'], 'invalid-input', /not a result/],
      [[bad('size', { ...result, width: 65 }), '--to', 'coco'], 'frame-size-mismatch', /64×48 and 65×48/],
      ...damaged.map((folder) => [[folder, '--to', 'coco', '--grouped'], 'invalid-input', /not a result/]),
      [[bad('foreign', { ...result, motions: result.motions.map((motion) => ({ ...motion, pixels: motion.pixels + 1 })) }), '--to', 'coco'], 'invalid-input', /not of the same result/],
      [[photo, '--to', 'coco'], 'invalid-input', /no labels: it is not an 8-bit indexed PNG/],
    ];
    for (const [args, code, sentence, exit = OPTIONS.includes(code) ? 2 : 1] of wrong) await refused(folder.path(), args, code, sentence, exit);
  });
});

describe('a clip', () => {
  test('every format: the files that encode gives of its frames, in the order that was asked for', async (t) => {
    const folder = temporaryFolder(t);
    const { frames, tracks } = clipFolder(folder.path('clip'), { names: { 2: 'car', 4: 'car' }, frameRate: 10 });
    const out = folder.path('out');
    const formats = [...IMAGES, ...TRACKS];
    const answer = await converted(folder.path('clip'), '--to', formats.join(','), '--shapes', 'box', '--video', 'a.mp4', '--out', out);
    assert.deepEqual([answer.version, answer.frames], [1, frames.length]);
    assert.deepEqual(answer.files.map((name) => name.replace(/\.\w+$|\/$/, '')), formats);
    const sightings = frames.map((_, frame) => tracks.objects.flatMap(({ id, frames }) => frames.filter((one) => one.frame === frame).map((one) => ({ id, ...one }))));
    const { width, height } = tracks;
    const given = frames.map((labels, k) => ({ labels, width, height, image: tracks.files[k], objects: sightings[k], background: tracks.background[k]?.matrix }));
    const expected = new Map();
    for (const format of formats) {
      const clip = format === 'cvat-video' ? 'a.mp4' : 'clip';
      const metadata = { names: { 1: 'object', 2: 'car', 4: 'car' }, labels: [1, 2, 4], frameRate: 10, tolerance: 0.5, shape: 'box', clip };
      for (const { name, content } of await encode(format, given, metadata)) expected.set(name, Buffer.from(content));
    }
    assert.deepEqual(files(out).filter((name) => name !== '.veronese'), [...expected.keys()].sort());
    for (const [name, content] of expected) assert.deepEqual(readFileSync(join(out, name)), content, name);
    assert.deepEqual(
      json(out, 'coco.json').annotations.map(({ image_id, bbox, area, attributes }) => [image_id - 1, attributes.track_id, area, bbox, attributes.matrix ?? null]),
      sightings.flat().map(({ frame, id, pixels, bbox, matrix }) => [frame, id, pixels, bbox, matrix]),
    );
    assert.equal(read(out, 'yolo', 'data.yaml'), 'train: images\nval: images\nnames:\n  0: "object"\n  1: "car"\n');
  });

  test('--background, --from and --until', async (t) => {
    const folder = temporaryFolder(t);
    const { frames, tracks } = clipFolder(folder.path('clip'));
    const out = folder.path('out');
    const { frames: count } = await converted(folder.path('clip'), '--to', 'coco,youtube-vis,mots', '--out', out, '--background', '--from', '3', '--until', '4');
    assert.equal(count, 2);
    assert.deepEqual(json(out, 'coco.json').images.map(({ file_name }) => file_name), ['f003.jpg', 'f004.jpg']);
    const video = json(out, 'youtube-vis.json');
    assert.deepEqual(video.categories, [{ id: 1, name: 'background' }, { id: 2, name: 'object' }]);
    assert.deepEqual(video.annotations.map(({ id }) => id), [255, 1, 4], 'the object that is gone there is left out, the numbers stay');
    assert.equal(video.annotations[0].areas[0], frames[3].filter((label) => label === 0).length);
    assert.equal(video.videos[0].length, 2);
    assert.match(read(out, 'mots', 'seqinfo.ini'), /seqLength=2\n/);
    assert.equal(read(out, 'mots', 'gt', 'gt.txt').split('\n').length, 7);
    await converted(folder.path('clip'), '--to', 'coco', '--out', out, '--from', '6');
    assert.equal(json(out, 'coco.json').annotations.length, tracks.objects.filter(({ last }) => last === 6).length);
  });

  test('times, where tracks.json or an option says them', async (t) => {
    const folder = temporaryFolder(t);
    const message = `the frame rate of '${folder.path('clip')}' is not known: 25 frames per second are assumed; '--frame-rate' says another`;
    const assumed = [{ code: 'frame-rate-assumed', message }];
    for (const [tracks, args, rate, notes] of [
      [{ frameRate: 12.5 }, [], 13],
      [{ frameRate: 12.5 }, ['--frame-rate', '10'], 10],
      [{ timestamps: [5, 5.5, 6, 6.25, 6.5, 7.5, 8] }, ['--from', '1'], 2],
      [{}, [], 25, assumed],
    ]) {
      clipFolder(folder.path('clip'), tracks);
      assert.deepEqual((await converted(folder.path('clip'), '--to', 'mots', ...args)).notes, notes);
      assert.match(read(folder.path('clip'), 'mots', 'seqinfo.ini'), new RegExp(`frameRate=${rate}\n`));
    }
    assert.equal((await converted(folder.path('clip'), '--to', 'coco,youtube-vis,cvat-video', '--out', folder.path('out'))).notes, undefined, 'nothing with times');
  });

  test('frames of a video, which are no files, are called what their labels are', async (t) => {
    const folder = temporaryFolder(t);
    for (const files of [undefined, [], Array(7).fill('a.mp4'), Array.from({ length: 7 }, (_, k) => `a.mp4#${k}`), ['A.jpg', ...Array.from({ length: 6 }, (_, k) => `${'a'.repeat(k + 1)}.jpg`)]]) {
      clipFolder(folder.path('clip'), { files });
      const images = [];
      for await (const { image } of await openClip(folder.path('clip'), { from: 5 }, false)) images.push(image);
      assert.deepEqual(images, ['f005.png', 'f006.png']);
    }
  });

  test('says what is wrong with the folder and writes nothing', async (t) => {
    const folder = temporaryFolder(t);
    const clip = folder.path('clip');
    const fails = (code, sentence, to = EVERY.join()) => refused(clip, [clip, '--to', to], code, sentence);
    const frames = drawnClip();
    const good = tracksOf(frames);
    const changed = (change) => writeFileSync(join(clip, 'tracks.json'), typeof change === 'string' ? change : JSON.stringify({ ...good, ...change }));

    clipFolder(clip);
    unlinkSync(join(clip, 'labels', 'f005.png'));
    for (const name of [EVERY.join(), 'label-studio', 'yolo', 'masks', 'mots']) await fails('file-not-found', /labels.f005\.png/, name);
    const grey = png({ data: new Uint8ClampedArray(37 * 23 * 4).fill(7).fill(200, 0, 1), width: 37, height: 23 });
    for (const [content, code, sentence] of [
      ['no picture', 'unreadable-image', /labels.f005\.png/],
      [davisPng(new Uint8Array(38 * 23), 38, 23), 'frame-size-mismatch', /f005\.png' differs in size.*38×23, not 37×23/],
      [davisPng(frames[5].map((label) => (label === 4 ? 3 : label)), 37, 23), 'invalid-input', /object 3 has \d+ pixels in '.*f005\.png' and 0 by 'tracks\.json'.* not of the same result/],
      [grey, 'invalid-input', /f005\.png': it has no labels: it is not an 8-bit indexed PNG/],
    ]) {
      writeFileSync(join(clip, 'labels', 'f005.png'), content);
      await fails(code, sentence);
    }

    clipFolder(clip);
    changed('{"version": 1');
    await fails('invalid-json', /tracks\.json' is not JSON/);
    const [first, ...others] = good.objects;
    const withFirst = (change) => ({ objects: [{ ...first, ...change }, ...others] });
    const sighting = (change) => withFirst({ frames: [{ ...first.frames[0], ...change }] });
    const wrong = [
      '[]', { version: 2 }, { width: 0 }, { height: '23' }, { frames: [] }, { frames: [1] }, { frames: good.frames.map(() => 'f') }, { frames: ['../a', ...good.frames.slice(1)] },
      { frames: ['F001', ...good.frames.slice(1)] }, { files: ['a'] }, { files: good.files.map(() => 'a/b') }, { objects: [null] }, { objects: [...others, ...others] },
      withFirst({ id: 255 }), withFirst({ name: 5 }), withFirst({ frames: null }), withFirst({ frames: [...first.frames, first.frames[0]] }), sighting({ frame: 7 }),
      sighting({ pixels: 0 }), sighting({ matrix: [1] }), { background: [{ frame: 9, matrix: null }] }, { background: [good.background[0], good.background[0]] },
      { frameRate: 1e308 }, { timestamps: [0] }, { timestamps: [5, 4, 6, 7, 8, 9, 10] }, { timestamps: [-1, 0, 1, 2, 3, 4, 5] }, { timestamps: [0, 1, 2, 3, 4, 5, 1e308] },
    ];
    for (const change of wrong) {
      changed(change);
      await assert.rejects(openClip(clip, { from: 0 }, false), { code: 'invalid-input', message: /tracks\.json' is not of 'veronese clip': / }, JSON.stringify(change));
    }
    await fails('invalid-input', /tracks\.json' is not of 'veronese clip': "timestamps"/);
    unlinkSync(join(clip, 'tracks.json'));
    await fails('invalid-input', /no tracks\.json: the clip is not finished/, 'coco');
  });

  test('says what is wrong with the options and writes nothing', async (t) => {
    const folder = temporaryFolder(t);
    const clip = folder.path('clip');
    clipFolder(clip);
    const wrong = [
      [['--from', '7'], /no frame 7: the frames are 0 to 6/, 1], [['--until', '7'], /no frame 7: the frames are 0 to 6/, 1], [['--from=1e3'], /'--from' must be/],
      [['--from', '4', '--until', '3'], /'--until' must be a frame from 4/], [['--shapes', 'mask'], /'--shapes' must be 'polygon' or 'box'/], [['--tolerance=-1'], /'--tolerance' must be/],
      ...['0', 'x', '1e308', `1${'0'.repeat(308)}`].map((value) => [[`--frame-rate=${value}`], /'--frame-rate' must be a number from 0\.000001 to 1000000, in digits, not/]),
      [['--grouped'], /'--grouped' is not for/, 1], [['--image', 'a.png'], /'--image' is not for/, 1],
    ];
    for (const [args, sentence, exit = 2] of wrong) await refused(clip, [clip, '--to', 'coco,yolo', ...args], 'invalid-option', sentence, exit);
    await refused(clip, [join(clip, 'tracks.json'), '--to', 'coco', '--out', clip], 'file-not-found', /labels\.png/);
    await refused(clip, [clip, '--to', 'coco', '--out', join(clip, 'tracks.json')], 'write-failed', /it is a file/);
  });

  test('stopped by a signal it leaves nothing half-written', async (t) => {
    const folder = temporaryFolder(t);
    clipFolder(folder.path('clip'));
    const before = files(folder.path('clip'));
    const { code, stdout } = await veroneseProcess(['convert', folder.path('clip'), '--to', 'davis,coco'], signalledAt(folder, 'SIGINT', { call: 'writeFile', n: 2 }));
    assert.deepEqual([code, stdout, files(folder.path('clip'))], [130, '', before]);
  });
});

describe('a batch', () => {
  async function batch(t) {
    const folder = temporaryFolder(t);
    for (let k = 0; k < 4; k++) folder.file(`a${k}.png`, png(frame(k)));
    const out = folder.path('out');
    const { code, stderr } = await veronese(['batch', folder.path('a*.png'), '--out', out, '--quality', 'fast']);
    assert.equal(code, 0, stderr);
    return { folder, out, pairs: entries(out) };
  }

  test('in every format of images, named as the frames are, without the background; --grouped', async (t) => {
    const { folder, out, pairs } = await batch(t);
    const to = folder.path('to');
    const { files: written, frames } = await converted(out, '--to', IMAGES.join(','), '--out', to);
    assert.deepEqual([frames, written.length], [3, IMAGES.length]);
    const coco = json(to, 'coco.json');
    assert.deepEqual(coco.images.map(({ file_name }) => file_name), ['a0.png', 'a1.png', 'a2.png'], 'the last frame has no pair');
    assert.deepEqual(coco.categories, [{ id: 2, name: 'object' }]);
    assert.ok(coco.annotations.length >= 3, `${coco.annotations.length} masks`);
    pairs.forEach((pair, k) => {
      assert.deepEqual(indices(to, 'davis', 'Annotations', '480p', 'out', `a${k}.png`), indices(out, pair, 'labels.png'));
      const here = coco.annotations.filter(({ image_id }) => image_id === k + 1);
      const { motions } = json(out, pair, 'result.json');
      assert.deepEqual(here.map(({ area, bbox, attributes }) => [area, bbox, attributes]), motions.slice(1).map(({ pixels, bbox, matrix }) => [pixels, bbox, { matrix }]));
    });
    await converted(out, '--to', 'coco', '--out', to, '--background', '--from', '1', '--until', '1');
    const [background, ...rest] = json(to, 'coco.json').annotations;
    assert.equal(background.area, indices(out, pairs[1], 'labels.png').filter((label) => label === 0).length);
    assert.equal(rest.length, json(out, pairs[1], 'result.json').motions.length - 1);
    assert.deepEqual(json(to, 'coco.json').images.map(({ file_name }) => file_name), ['a1.png']);
    const result = json(out, pairs[0], 'result.json');
    writeFileSync(join(out, pairs[0], 'result.json'), JSON.stringify({ ...result, motions: result.motions.map((motion) => ({ ...motion, group: 0 })) }));
    await converted(out, '--to', 'coco', '--grouped', '--until', '0');
    assert.deepEqual(json(out, 'coco.json').annotations, []);
  });

  test('says what is wrong and writes nothing', async (t) => {
    const { out, pairs } = await batch(t);
    const fails = (code, sentence, ...args) => refused(out, [out, '--to', ...args], code, sentence);
    for (const name of TRACKS) await fails('invalid-input', /holds tracks, and .* a batch does not know an object again/, `coco,${name}`);
    await fails('invalid-option', /no frame 3: the frames are 0 to 2/, 'coco', '--from', '3');
    await fails('invalid-option', /'--video' is not for/, 'coco', '--video', 'a.mp4');
    const report = join(out, pairs[1], 'result.json');
    const text = readFileSync(report, 'utf8');
    const { inputs, ...nameless } = JSON.parse(text);
    for (const [content, code, sentence] of [
      [JSON.stringify(nameless), 'invalid-input', /does not name its frames/],
      [JSON.stringify({ ...nameless, inputs: [{ name: 'A0.png' }, inputs[1]] }), 'invalid-input', /two frames have the name 'A0'/],
      [JSON.stringify({ ...nameless, inputs: [{ name: '../a.png' }, inputs[1]] }), 'invalid-input', /does not name its frames/],
      [text.slice(1), 'invalid-json', /result\.json/],
    ]) {
      writeFileSync(report, content);
      await fails(code, sentence, 'coco');
    }
    rmSync(report);
    await fails('file-not-found', /result\.json/, 'coco,yolo');
    rmSync(join(out, pairs[1]), { recursive: true });
    await fails('invalid-option', /there is no pair from 1 to 1/, 'coco', '--from', '1', '--until', '1');
    await converted(out, '--to', 'coco');
    assert.deepEqual(json(out, 'coco.json').images.map(({ file_name }) => file_name), ['a0.png', 'a2.png'], 'a pair that failed is left out');
  });
});

describe('--to corrections', () => {
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
    await refused(out, [folder.path('some'), '--to', 'corrections', '--out', out], 'file-exists', /f003\.png/);
    assert.equal(readFileSync(join(out, 'f003.png'), 'utf8'), 'mine as well');
    await refused(folder.path(), [folder.path('all'), '--to', 'corrections', '--out', folder.path('x')], 'invalid-input', /is coco and .* is yolo: give one of them/);
  });

  test('wrong usage and files that cannot be read', async (t) => {
    const folder = temporaryFolder(t);
    const file = folder.file('a.json', '{"images": [], "annotations": []}');
    const out = folder.path('out');
    const back = ['--to', 'corrections', '--out', out];
    mkdirSync(folder.path('empty'));
    const wrong = [
      [[file, '--to', 'corrections'], 'usage', /'--to corrections' needs '--out DIR'/],
      [[file, '--to', 'corrections,coco', '--out', out], 'usage', /cannot be with formats that are written/],
      [[file, ...back, '--tolerance', '1'], 'usage', /'--to corrections' has no option '--tolerance'/],
      ...[['--clip', out], ['--levels', '9']].map(([name, value]) => [[file, '--to', 'coco', name, value], 'usage', new RegExp(`'${name}' needs '--to corrections'`)]),
      [[file, ...back, '--first-frame', '2'], 'invalid-option', /'--first-frame'/],
      [[file, ...back, '--quiet'], 'invalid-input', /'.*a\.json' annotates no frame/],
      [[folder.path('none.json'), ...back], 'file-not-found', /none\.json/],
      [[folder.file('b.json', '{'), ...back], 'invalid-input', /b\.json': it is not JSON/],
      [[file, ...back, '--clip', folder.path('none')], 'file-not-found', /tracks\.json/],
      [[folder.path('empty'), ...back], 'invalid-input', /no file is an annotation/],
    ];
    for (const [args, code, sentence] of wrong) await refused(folder.path(), args, code, sentence, OPTIONS.includes(code) ? 2 : 1);
  });
});
