// `veronese convert` of many frames: folders of `clip`, drawn here, and of `batch`, made by the program.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync, rmSync, statSync, unlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { encode } from 'veronese/formats';
import { openClip } from '../build/cli/clip-folder.js';
import { FORMATS } from '../build/formats/encode.js';
import { davisPng } from '../build/formats/pictures.js';
import { clipFolder, drawnClip, tracksOf } from './support/clip.mjs';
import { frame, png } from './support/frames.mjs';
import { signalledAt } from './support/stopping.mjs';
import { converted, entries, notConverted as refused, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';

const [TRACKS, IMAGES] = [true, false].map((tracks) => Object.keys(FORMATS).filter((name) => (FORMATS[name].tracks ?? false) === tracks));

const read = (...path) => readFileSync(join(...path), 'utf8');
const json = (...path) => JSON.parse(read(...path));
const indices = (...path) => Uint8Array.from(decode(readFileSync(join(...path))).data);

/** Every file below, as sorted paths. */
function files(folder) {
  return readdirSync(folder, { recursive: true })
    .filter((name) => statSync(join(folder, name)).isFile())
    .sort();
}

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
    const coco = json(out, 'coco.json');
    assert.deepEqual(
      coco.annotations.map(({ image_id, bbox, area, attributes }) => [image_id - 1, attributes.track_id, area, bbox, attributes.matrix ?? null]),
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
    const { objects } = tracks;
    await converted(folder.path('clip'), '--to', 'coco', '--out', out, '--from', '6');
    assert.equal(json(out, 'coco.json').annotations.length, objects.filter(({ last }) => last === 6).length);
  });

  test('times, where tracks.json or an option says them', async (t) => {
    const folder = temporaryFolder(t);
    let said;
    const rate = async (...args) => {
      said = (await converted(folder.path('clip'), '--to', 'mots', ...args)).notes;
      return Number(/frameRate=(\d+)/.exec(read(folder.path('clip'), 'mots', 'seqinfo.ini'))[1]);
    };
    clipFolder(folder.path('clip'), { frameRate: 12.5 });
    assert.equal(await rate(), 13);
    assert.equal(await rate('--frame-rate', '10'), 10);
    clipFolder(folder.path('clip'), { timestamps: [5, 5.5, 6, 6.25, 6.5, 7.5, 8] });
    assert.equal(await rate('--from', '1'), 2);
    assert.equal(said, undefined);
    clipFolder(folder.path('clip'));
    assert.equal(await rate(), 25);
    const message = `the frame rate of '${folder.path('clip')}' is not known: 25 frames per second are assumed; '--frame-rate' says another`;
    assert.deepEqual(said, [{ code: 'frame-rate-assumed', message }]);
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
    const every = [...IMAGES, ...TRACKS].join(',');
    const fails = (code, sentence, to = every) => refused(clip, [clip, '--to', to], code, sentence);
    const frames = drawnClip();
    const good = tracksOf(frames);
    const changed = (change) => writeFileSync(join(clip, 'tracks.json'), typeof change === 'string' ? change : JSON.stringify({ ...good, ...change }));

    clipFolder(clip);
    unlinkSync(join(clip, 'labels', 'f005.png'));
    await fails('file-not-found', /labels.f005\.png/);
    for (const name of ['label-studio', 'yolo', 'masks', 'mots']) await fails('file-not-found', /labels.f005\.png/, name);
    writeFileSync(join(clip, 'labels', 'f005.png'), 'no picture');
    await fails('unreadable-image', /labels.f005\.png/);
    writeFileSync(join(clip, 'labels', 'f005.png'), davisPng(new Uint8Array(38 * 23), 38, 23));
    await fails('frame-size-mismatch', /f005\.png' differs in size.*38×23, not 37×23/);
    const strange = frames[5].map((label) => (label === 4 ? 3 : label));
    writeFileSync(join(clip, 'labels', 'f005.png'), davisPng(strange, 37, 23));
    await fails('invalid-input', /object 3 has \d+ pixels in '.*f005\.png' and 0 by 'tracks\.json'/);
    writeFileSync(join(clip, 'labels', 'f005.png'), davisPng(frames[4], 37, 23));
    await fails('invalid-input', /not of the same result/);
    writeFileSync(join(clip, 'labels', 'f005.png'), png({ data: new Uint8ClampedArray(37 * 23 * 4).fill(7).fill(200, 0, 1), width: 37, height: 23 }));
    await fails('invalid-input', /f005\.png': it has no labels: it is not an 8-bit indexed PNG/);

    clipFolder(clip);
    changed('{"version": 1');
    await fails('invalid-json', /tracks\.json' is not JSON/);
    const [first, ...others] = good.objects;
    const withFirst = (change) => ({ objects: [{ ...first, ...change }, ...others] });
    const sighting = (change) => withFirst({ frames: [{ ...first.frames[0], ...change }] });
    const sightedTwice = withFirst({ frames: [...first.frames, { ...first.frames[0], matrix: [0, 0, 9, 0, 0, 0] }] });
    const wrong = [
      sightedTwice, { background: [good.background[0], good.background[0]] }, { frameRate: 1e-308 }, { frameRate: 1e308 },
      '[]', 'null', { version: 2 }, { width: 0 }, { width: 37.5 }, { height: '23' }, { height: 5000 }, { frames: [] }, { frames: 'f' }, { frames: [1] },
      { frames: good.frames.map(() => 'f') }, { frames: ['../a', ...good.frames.slice(1)] }, { frames: ['F001', ...good.frames.slice(1)] },
      { files: ['a'] }, { files: good.files.map(() => 'a/b') }, { objects: {} }, { objects: [null] }, { objects: [...others, ...others] },
      withFirst({ id: 0 }), withFirst({ id: 255 }), withFirst({ id: '1' }), withFirst({ name: 5 }), withFirst({ frames: null }), sighting({ frame: 7 }),
      sighting({ frame: -1 }), sighting({ pixels: 0 }), sighting({ pixels: 1e9 }), sighting({ matrix: [1] }), sighting({ matrix: [0, 0, 0, 0, 0, null] }),
      { background: 5 }, { background: [{ frame: 9, matrix: null }] }, { frameRate: 0 }, { frameRate: '25' }, { timestamps: 5 }, { timestamps: [0] },
      { timestamps: [5, 4, 6, 7, 8, 9, 10] }, { timestamps: [-1, 0, 1, 2, 3, 4, 5] }, { timestamps: [0, 1, 2, 3, 4, 5, 1e308] },
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
    const fails = (code, sentence, exit, ...args) => refused(clip, [clip, '--to', 'coco,yolo', ...args], code, sentence, exit);
    await fails('invalid-option', /no frame 7: the frames are 0 to 6/, 1, '--from', '7');
    await fails('invalid-option', /no frame 7: the frames are 0 to 6/, 1, '--until', '7');
    await fails('invalid-option', /no frame 999999999/, 1, '--from', '999999999');
    for (const value of ['-1', '1e3']) await fails('invalid-option', /'--from' must be/, 2, `--from=${value}`);
    await fails('invalid-option', /'--until' must be a frame from 4/, 2, '--from', '4', '--until', '3');
    await fails('invalid-option', /'--shapes' must be 'polygon' or 'box'/, 2, '--shapes', 'mask');
    await fails('invalid-option', /'--tolerance' must be/, 2, '--tolerance=-1');
    for (const value of ['0', 'x', '1e308', `1${'0'.repeat(308)}`, `0.${'0'.repeat(307)}1`]) {
      await fails('invalid-option', /'--frame-rate' must be a number from 0\.000001 to 1000000, in digits, not/, 2, `--frame-rate=${value}`);
    }
    await refused(clip, [join(clip, 'tracks.json'), '--to', 'coco', '--out', clip], 'file-not-found', /labels\.png/);
    await fails('invalid-option', /'--grouped' is not for/, 1, '--grouped');
    await fails('invalid-option', /'--image' is not for/, 1, '--image', 'a.png');
    await refused(clip, [clip, '--to', 'coco', '--out', join(clip, 'tracks.json')], 'write-failed', /it is a file/);
  });

  test('stopped by a signal it leaves nothing half-written', async (t) => {
    const folder = temporaryFolder(t);
    const clip = folder.path('clip');
    clipFolder(clip);
    const before = files(clip);
    const { code, stdout } = await veroneseProcess(['convert', clip, '--to', 'davis,coco'], signalledAt(folder, 'SIGINT', { call: 'writeFile', n: 2 }));
    assert.equal(code, 130);
    assert.equal(stdout, '');
    assert.deepEqual(files(clip), before);
  });
});

describe('a batch', () => {
  async function batch(t, ...options) {
    const folder = temporaryFolder(t);
    for (let k = 0; k < 4; k++) folder.file(`a${k}.png`, png(frame(k)));
    const { code, stderr } = await veronese(['batch', folder.path('a*.png'), '--out', folder.path('out'), '--quality', 'fast', ...options]);
    assert.equal(code, 0, stderr);
    const pairs = entries(folder.path('out'));
    return { folder, out: folder.path('out'), pairs };
  }

  test('in every format of images, named as the frames are, without the background', async (t) => {
    const { folder, out, pairs } = await batch(t);
    const to = folder.path('to');
    const { files: written, frames } = await converted(out, '--to', IMAGES.join(','), '--out', to);
    assert.equal(frames, 3);
    assert.equal(written.length, IMAGES.length);
    const coco = json(to, 'coco.json');
    assert.deepEqual(coco.images.map(({ file_name }) => file_name), ['a0.png', 'a1.png', 'a2.png'], 'the last frame has no pair');
    assert.deepEqual(coco.categories, [{ id: 2, name: 'object' }]);
    assert.ok(coco.annotations.length >= 3, `${coco.annotations.length} masks`);
    pairs.forEach((pair, k) => {
      const labels = indices(out, pair, 'labels.png');
      assert.deepEqual(indices(to, 'davis', 'Annotations', '480p', 'out', `a${k}.png`), labels);
      const { motions } = json(out, pair, 'result.json');
      const here = coco.annotations.filter(({ image_id }) => image_id === k + 1);
      assert.deepEqual(here.map(({ area, bbox, attributes }) => [area, bbox, attributes]), motions.slice(1).map(({ pixels, bbox, matrix }) => [pixels, bbox, { matrix }]));
    });
    await converted(out, '--to', 'coco', '--out', to, '--background', '--from', '1', '--until', '1');
    const [background, ...rest] = json(to, 'coco.json').annotations;
    assert.equal(background.area, indices(out, pairs[1], 'labels.png').filter((label) => label === 0).length);
    assert.equal(rest.length, json(out, pairs[1], 'result.json').motions.length - 1);
    assert.deepEqual(json(to, 'coco.json').images.map(({ file_name }) => file_name), ['a1.png']);
  });

  test('--grouped', async (t) => {
    const { out, pairs } = await batch(t);
    const pair = join(out, pairs[0]);
    const result = json(pair, 'result.json');
    writeFileSync(join(pair, 'result.json'), JSON.stringify({ ...result, motions: result.motions.map((motion) => ({ ...motion, group: 0 })) }));
    await converted(out, '--to', 'coco', '--grouped', '--until', '0');
    assert.deepEqual(json(out, 'coco.json').annotations, []);
  });

  test('says what is wrong and writes nothing', async (t) => {
    const { out, pairs } = await batch(t);
    for (const name of TRACKS) await refused(out, [out, '--to', `coco,${name}`], 'invalid-input', /holds tracks, and .* a batch does not know an object again/);
    await refused(out, [out, '--to', 'coco', '--from', '3'], 'invalid-option', /no frame 3: the frames are 0 to 2/);
    await refused(out, [out, '--to', 'coco', '--video', 'a.mp4'], 'invalid-option', /'--video' is not for/);
    const report = join(out, pairs[1], 'result.json');
    const text = readFileSync(report, 'utf8');
    const { inputs, ...nameless } = JSON.parse(text);
    writeFileSync(report, JSON.stringify(nameless));
    await refused(out, [out, '--to', 'coco'], 'invalid-input', /does not name its frames/);
    writeFileSync(report, JSON.stringify({ ...nameless, inputs: [{ name: 'A0.png' }, inputs[1]] }));
    await refused(out, [out, '--to', 'coco'], 'invalid-input', /two frames have the name 'A0'/);
    writeFileSync(report, JSON.stringify({ ...nameless, inputs: [{ name: '../a.png' }, inputs[1]] }));
    await refused(out, [out, '--to', 'yolo'], 'invalid-input', /does not name its frames/);
    writeFileSync(report, text.slice(1));
    await refused(out, [out, '--to', 'coco'], 'invalid-json', /result\.json/);
    rmSync(report);
    await refused(out, [out, '--to', 'coco,yolo'], 'file-not-found', /result\.json/);
    rmSync(join(out, pairs[1]), { recursive: true });
    await refused(out, [out, '--to', 'coco', '--from', '1', '--until', '1'], 'invalid-option', /there is no pair from 1 to 1/);
    await converted(out, '--to', 'coco');
    assert.deepEqual(json(out, 'coco.json').images.map(({ file_name }) => file_name), ['a0.png', 'a2.png'], 'a pair that failed is left out');
  });
});

test('a pair takes no option of many frames', async (t) => {
  const folder = temporaryFolder(t);
  const [first, second] = [0, 1].map((k) => folder.file(`${k}.png`, png(frame(k))));
  const out = folder.path('out');
  await veronese(['pair', first, second, '--out', out]);
  for (const option of ['--from=1', '--until=0', '--shapes=box', '--video=a.mp4', '--frame-rate=5']) {
    await refused(out, [out, '--to', 'coco', option], 'invalid-option', /is not for/);
  }
});
