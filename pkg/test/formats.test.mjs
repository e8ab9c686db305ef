// What `encode` writes: polygons filled again, bytes that stay, metadata, frames one after another, wrong input.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { davisPalette, VeroneseError } from 'veronese';
import { encode } from 'veronese/formats';
import { FORMATS } from '../build/formats/encode.js';
import { random } from '../../scripts/lib/random.mjs';
import { document, encoded } from './support/encoded.mjs';
import { drawn, filled, intersectionOverUnion, labelImages, maskOf } from './support/masks.mjs';
import { stopwatch } from './support/processor.mjs';
import { cases, soaking } from './support/soak.mjs';

const ALL = Array.from({ length: 255 }, (_, label) => label);
const IMAGES = labelImages(soaking ? 300 : 100);

/** The rings of each label. */
async function polygons(frame, tolerance, labels = ALL) {
  const { annotations } = await document('coco-polygon', frame, { tolerance, labels });
  return annotations.map(({ category_id, segmentation }) => ({ label: category_id - 1, rings: segmentation }));
}

describe('polygons', () => {
  const count = (all) => all.reduce((sum, { rings }) => sum + rings.flat().length, 0);
  /** Random images with smooth borders and several masks, larger than the others: there are lines to draw. */
  const smooth = Array.from({ length: soaking ? 40 : 10 }, (_, seed) => {
    const next = random(seed + 1);
    const [width, height] = [60 + Math.floor(next() * 60), 60 + Math.floor(next() * 60)];
    const seeds = Array.from({ length: 3 + Math.floor(next() * 6) }, () => ({ x: next() * width, y: next() * height, wave: 0.05 + next() / 4, label: Math.floor(next() * 5) }));
    const labels = Uint8Array.from({ length: width * height }, (_, at) => {
      const [x, y] = [at % width, Math.floor(at / width)];
      const far = seeds.map((seed) => Math.hypot(x - seed.x, y - seed.y) * (1.2 + Math.sin((x + y) * seed.wave) * 0.2));
      return seeds[far.indexOf(Math.min(...far))].label;
    });
    return { labels, width, height };
  });

  test('without a tolerance, or next to none, fill the same pixels, ring by ring and united; the second has fewer vertices', async () => {
    for (const images of [IMAGES, smooth]) {
      let [exact, thin] = [0, 0];
      for (const image of images) {
        for (const tolerance of [0, 1e-6]) {
          const found = await polygons(image, tolerance);
          assert.deepEqual(found.map(({ label }) => label), [...new Set(image.labels)].filter((label) => label !== 255).sort((a, b) => a - b));
          for (const { label, rings } of found) {
            const sum = new Uint8Array(image.labels.length);
            for (const ring of rings) filled([ring], image).forEach((set, at) => (sum[at] += set));
            assert.deepEqual(sum, maskOf(image.labels, label));
          }
          if (tolerance === 0) exact += count(found);
          else thin += count(found);
        }
      }
      if (images === smooth) assert.ok(thin < 0.5 * exact, `${thin} of ${exact}`);
    }
  });

  for (const tolerance of [0.5, 6, 300]) {
    test(`with a tolerance of ${tolerance}: no gap, no overlap, no part or hole lost`, async () => {
      for (const image of [...IMAGES, ...smooth]) {
        const there = { ...image, labels: image.labels.map((label) => (label === 255 ? 9 : label)) };
        const [exact, found] = [await polygons(there, 0), await polygons(there, tolerance)];
        assert.deepEqual(found.map(({ rings }) => rings.length), exact.map(({ rings }) => rings.length));
        const sum = new Uint8Array(there.labels.length);
        for (const { rings } of found) filled(rings, there).forEach((set, at) => (sum[at] += set));
        assert.deepEqual(sum, sum.map(() => 1));
      }
    });
  }

  test('a border of two masks has the same vertices on both sides', async () => {
    let shared = 0;
    for (const image of smooth) {
      const { width, height } = image;
      const edges = new Map();
      for (const { rings } of await polygons(image, 0.5)) {
        for (const ring of rings) {
          for (let at = 0; at < ring.length; at += 2) {
            const ends = [ring.slice(at, at + 2), at + 2 < ring.length ? ring.slice(at + 2, at + 4) : ring.slice(0, 2)].map(String).sort().join(' ');
            edges.set(ends, (edges.get(ends) ?? 0) + 1);
          }
        }
      }
      // The image is full of masks: an edge that has one side only lies on the edge of the image.
      for (const [ends, count] of edges) {
        const [x0, y0, x1, y1] = ends.split(/[ ,]/).map(Number);
        const outer = (x0 === x1 && (x0 === 0 || x0 === width)) || (y0 === y1 && (y0 === 0 || y0 === height));
        assert.ok(outer || count % 2 === 0, `${ends}: ${count}`);
        shared += Number(!outer);
      }
    }
    assert.ok(shared > 25 * smooth.length, `${shared}`);
  });

  test('a disc with a hole has few vertices and nearly the same pixels; rectangles and corners of the image stay', async () => {
    const labels = Uint8Array.from({ length: 200 * 200 }, (_, at) => {
      const distance = Math.hypot((at % 200) - 99.5, Math.floor(at / 200) - 99.5);
      return distance < 90 && distance > 30 ? 1 : 255;
    });
    const [{ rings }] = await polygons({ labels, width: 200, height: 200 }, 0.5);
    assert.ok(rings[0].length / 2 < 60, `${rings[0].length / 2} vertices`);
    const pixels = filled(rings, { width: 200, height: 200 });
    const overlap = intersectionOverUnion(pixels, maskOf(labels, 1));
    assert.ok(overlap > 0.985, `${overlap}`);
    assert.deepEqual(await polygons(drawn('1111', '1111'), 0), [{ label: 1, rings: [[0, 0, 4, 0, 4, 2, 0, 2]] }]);
    const image = drawn('111111111', '122211131', '122211111', '122211111', '111144111');
    const corners = async (tolerance) => (await polygons(image, tolerance, [2, 3, 4])).map(({ rings: [ring] }) => ring.map((value, at) => (at % 2 ? `${ring[at - 1]} ${value}` : '')).filter(Boolean).sort());
    assert.deepEqual(await corners(0.5), await corners(0));
  });
});

describe('masks of noise take no long time', () => {
  const noise = (side) => {
    const next = random(3);
    return { labels: Uint8Array.from({ length: side * side }, () => Number(next() < 0.5)), width: side, height: side };
  };
  /** Width and height of most masks, and seconds: five times what is needed. */
  const side = soaking ? 1024 : 512;
  const PATIENCE = 30 * (side / 1024) ** 2;
  const soon = (title, work) => {
    test(title, async () => {
      const seconds = stopwatch();
      await work();
      assert.ok(seconds() < PATIENCE, `${seconds()} s`);
    });
  };
  const large = noise(side);
  // Of each way to write a mask one.
  for (const format of cases(['youtube-vis', 'coco-polygon', 'label-studio', 'davis'], Object.keys(FORMATS))) {
    soon(`${format}: ${side} × ${side}`, () => encode(format, large, { labels: [0, 1], tolerance: 1 }));
  }
  for (const format of cases(['coco-polygon'], ['yolo', 'cvat-polygon', 'label-studio-polygon'])) {
    soon(`${format}: 2048 × 2048 has too many vertices`, () =>
      assert.rejects(encode(format, noise(2048), { labels: [0, 1] }), { code: 'invalid-input', message: /more than 4000000 vertices/ }));
  }

  soon('thousands of holes, and teeth that a tolerance takes off one by one', async () => {
    const holes = { labels: Uint8Array.from({ length: 301 * 301 }, (_, at) => ((at % 301) % 2 && Math.floor(at / 301) % 2 ? 255 : 1)), width: 301, height: 301 };
    const [{ rings }] = await polygons(holes, 0);
    assert.equal(rings.length, 1);
    assert.deepEqual(filled(rings, holes), maskOf(holes.labels, 1));
    const at = (x, y) => y % 6 < 2 || (y % 6 === 2 && x % 2 === 0) || x === (Math.floor(y / 6) % 2 ? 0 : 2 * side - 1);
    const labels = Uint8Array.from({ length: 4 * side * side }, (_, p) => Number(at(p % (2 * side), Math.floor(p / (2 * side)))));
    assert.equal((await polygons({ labels, width: 2 * side, height: 2 * side }, 0.4, [1]))[0].rings.length, 1);
  });
});

test('pictures: indices and palette of DAVIS, and masks', async () => {
  for (const image of IMAGES) {
    const png = decode(await document('davis', image), { checkCrc: true });
    assert.deepEqual([png.width, png.height, png.depth, png.channels, png.palette], [image.width, image.height, 8, 1, davisPalette()]);
    assert.deepEqual(Uint8Array.from(png.data), image.labels);
    for (const [name, file] of Object.entries(await encoded('masks', [{ ...image, image: 'a.jpg' }]))) {
      const [, label] = /^masks\/(\d+)\/a\.png$/.exec(name);
      assert.deepEqual(Uint8Array.from(decode(file).data), image.labels.map((value) => (value === Number(label) ? 255 : 0)));
    }
  }
});

describe('frames', () => {
  const frames = [drawn('0110', '0022'), drawn('0000', '0022'), drawn('1100', '2200')];
  const known = { names: { 0: 'ground', 1: 'car', 2: 'bus' }, labels: [1, 2] };

  for (const format of Object.keys(FORMATS)) {
    test(`${format}: from any iterable, in one buffer; a source that fails is closed`, async () => {
      const whole = await encode(format, frames, known);
      const shared = drawn('0000', '0000');
      function* reusing() {
        for (const { labels } of frames) {
          shared.labels.set(labels);
          yield shared;
        }
      }
      async function* later() {
        yield* reusing();
      }
      for (const source of [reusing(), new Set(frames), later()]) assert.deepEqual(await encode(format, source, known), whole);
      const error = new VeroneseError('cancelled', 'no more');
      let closed = 0;
      async function* source(next) {
        try {
          yield frames[0];
          yield next();
        } finally {
          closed++;
        }
      }
      await assert.rejects(encode(format, source(() => { throw error; })), error);
      await assert.rejects(encode(format, source(() => ({ ...frames[0], width: 3 }))), { code: 'invalid-input' });
      await assert.rejects(encode(format, source(() => drawn('0'))), { code: 'frame-size-mismatch' });
      assert.equal(closed, 3);
      for (const none of [[], later().return() && []]) await assert.rejects(encode(format, none), { code: 'invalid-input', message: /one frame at least/ });
    });
  }

  test('those of a clip fit, with their motions; names are those of images, or the index', async () => {
    const clip = frames.map((frame, k) => ({ index: k + 4, ...frame, objects: [{ id: 1, pixels: 2, matrix: [0, 0, k, 0, 0, 0] }, { id: 2, pixels: 2, matrix: null }], background: k < 2 ? [0, 0, 9, 0, 0, 0] : null }));
    const { images, annotations } = await document('coco', clip);
    assert.deepEqual(images.map(({ file_name }) => file_name), ['00004.png', '00005.png', '00006.png']);
    assert.deepEqual(annotations.map(({ attributes }) => attributes), [{ track_id: 1, matrix: [0, 0, 0, 0, 0, 0] }, { track_id: 2 }, { track_id: 2 }, { track_id: 1, matrix: [0, 0, 2, 0, 0, 0] }, { track_id: 2 }]);
    assert.deepEqual((await document('coco', { ...frames[0], motions: [] })).images[0].file_name, 'first.png');
  });

  test('labels of one name are one class; listed classes come first, with or without a mask', async () => {
    const names = { 0: 'ground', 1: 'car', 2: 'car' };
    const coco = await document('coco', frames[0], { names, labels: [0, 1, 2] });
    assert.deepEqual(coco.categories, [{ id: 1, name: 'ground' }, { id: 2, name: 'car' }]);
    assert.deepEqual(coco.annotations.map(({ category_id }) => category_id), [1, 2, 2]);
    const listed = { ...known, classes: ['person', 'car'] };
    for (const source of [frames[0], frames]) {
      for (const format of ['coco', 'youtube-vis']) {
        const { categories, annotations } = await document(format, source, listed);
        assert.deepEqual(categories, [{ id: 1, name: 'person' }, { id: 2, name: 'car' }, { id: 5, name: 'bus' }], format);
        assert.deepEqual([...new Set(annotations.map(({ category_id }) => category_id))].sort(), [2, 5]);
      }
      for (const format of ['cvat', 'cvat-video']) assert.deepEqual((await document(format, source, listed)).match(/<label><name>\w+/g).map((text) => text.slice(13)), ['person', 'car', 'bus']);
      const [text, list] = Object.values(await encoded('yolo', source, listed));
      assert.deepEqual(text.match(/^\d+/gm), ['1', '2']);
      if (source === frames[0]) assert.equal(list, 'person\ncar\nbus\n');
    }
    // MOTS has numbers for 64: of more, those that objects have are numbered, in the order of the list.
    const numbers = async (classes) => {
      const { 'mots/gt/gt.txt': gt, 'mots/gt/labels.txt': text } = await encoded('mots', frames, { ...known, classes });
      return [text.trimEnd().split('\n'), gt.match(/^1 \d+/gm)];
    };
    const many = [...Array.from({ length: 62 }, (_, k) => `class ${k}`), 'bus', 'car'];
    assert.deepEqual(await numbers(['person', 'car']), [['person', 'car', 'bus'], ['1 2001', '1 3002']]);
    assert.deepEqual(await numbers(many), [many, ['1 64001', '1 63002']]);
    assert.deepEqual(await numbers(['person', ...many]), [['bus', 'car'], ['1 2001', '1 1002']]);
    const crowd = { labels: Uint8Array.from({ length: 66 }, (_, at) => at), width: 66, height: 1 };
    await assert.rejects(encode('mots', [crowd]), { code: 'invalid-input', message: /64 classes at most/ });
  });

  test('numbers of objects are kept where they are tracked; the background is written where it is asked for', async () => {
    const ids = async (tracked) => (await document('youtube-vis', frames, { labels: [0, 2], tracked })).annotations.map(({ id }) => id);
    assert.deepEqual([await ids(false), await ids()], [[1, 2], [255, 2]]);
    const tracks = async (source, tracked) => (await document('coco', source, { tracked })).annotations.map(({ attributes }) => attributes?.track_id);
    assert.deepEqual([await tracks(frames), await tracks(frames, false), await tracks(frames[0])], [[1, 2, 2, 1, 2], Array(5).fill(undefined), [undefined, undefined]]);
    assert.deepEqual((await document('coco', drawn('..', '..'))).annotations, []);
    assert.deepEqual(await encoded('yolo', drawn('..')), { 'yolo.txt': '', 'yolo-names.txt': '' });
  });

  test('times', async () => {
    const rate = async (more) => /frameRate=(\d+)/.exec((await encoded('mots', frames, more))['mots/seqinfo.ini'])[1];
    const rates = [{}, { frameRate: 2.4 }, { timestamps: [10, 10.5, 11] }, { timestamps: [10, 10.5, 12], frameRate: 4 }, { timestamps: [0, 0, 1e-300] }];
    assert.deepEqual(await Promise.all(rates.map(rate)), ['25', '2', '2', '4', '25']);
    await assert.rejects(rate({ timestamps: [10, 12, 11] }), { code: 'invalid-option' });
    await assert.rejects(rate({ timestamps: [10, 11] }), { code: 'invalid-input', message: /a number for each frame/ });
  });

  test('names are escaped, and lead nowhere else', async () => {
    const image = 'a "b" & <c>.png';
    const metadata = { names: { 1: 'A & "B"' } };
    const xml = await document('cvat', { ...frames[0], image }, metadata);
    assert.ok(xml.includes('name="a &quot;b&quot; &amp; &lt;c&gt;.png"') && xml.includes('<mask label="A &amp; &quot;B&quot;"'), xml);
    // Where a name is a reference to an image and no file of ours, it stays what it is.
    for (const image of ['../images/a.png', 'images\\a.png', 'https://example.org/a.png?b=c']) assert.equal((await document('coco', { ...frames[0], image })).images[0].file_name, image);
    const wrong = [
      '', '.png', 'a/.png', '/a.png', 'a//b.png', '../a.png', 'a/../b.png', '..', './a.png', 'a/./b.png', '..\\a.png', 'a\\..\\..\\b.png',
      '\\\\host\\share.png', 'C:\\a.png', 'C:a.png', 'c:/a.png', 'a\0.png', 'a\0b.png', 'a\nb.png', 'a\x7f.png', 'a\x85.png', 'NUL.png', 'a/con.png',
      'Com1.png', 'lpt9.tar.png', 'a .png', '.. /a.png', 'a./b.png', `${'a'.repeat(252)}.png`, `${'ä'.repeat(126)}.png`, `${'a/'.repeat(2001)}a.png`,
    ];
    for (const image of wrong) await assert.rejects(encode('davis', [{ ...frames[0], image }]), { code: 'invalid-input', message: /cannot be the name of a file: it / }, JSON.stringify(image));
    const right = ['a.png', 'a b/c d.png', 'clip.v2/00001.jpg', 'ä/日本.png', '.hidden.png', 'null.png', 'concert/a.png', '12:30.png', `${'a'.repeat(251)}.png`];
    for (const image of right) assert.deepEqual(Object.keys(await encoded('davis', [{ ...frames[0], image }], { clip: 'c' })), [`davis/Annotations/480p/c/${image.replace(/\.[^.]*$/, '')}.png`, 'davis/ImageSets/2017/val.txt']);
    for (const format of ['davis', 'masks', 'yolo']) {
      for (const other of ['a/F1.png', 'A/f1.bmp', 'a/f1']) {
        const two = ['a/f1.png', other].map((image) => ({ ...frames[0], image }));
        await assert.rejects(encode(format, two), { code: 'invalid-input', message: /two frames have the name/ }, `${format} ${other}`);
      }
    }
    await assert.rejects(encode('davis', frames, { clip: '../c' }), { code: 'invalid-input' });
    const { 'mots/gt/labels.txt': names } = await encoded('mots', frames, { names: { 1: 'a\0b\nc', 2: 'd' } });
    assert.equal(names, 'a b c\nd\n');
  });
});
