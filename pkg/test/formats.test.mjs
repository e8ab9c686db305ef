// The encoders by themselves: polygons filled again, documents read back, bytes that stay, wrong input.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { unzipSync } from 'fflate';
import { davisPalette, VeroneseError } from 'veronese';
import * as formats from 'veronese/formats';
import { random } from '../../scripts/lib/random.mjs';
import { drawn, labelImages, present } from './support/masks.mjs';
import { stopwatch } from './support/processor.mjs';
import { cases, soaking } from './support/soak.mjs';

/** The encoders of many frames. */
const MANY = ['encodeCocoImages', 'encodeCocoVideo', 'encodeCvatImages', 'encodeCvatVideo', 'encodeCvatMots', 'encodeMots', 'encodeMotChallenge', 'encodeLabelStudioVideo'];
const IMAGES = labelImages(soaking ? 300 : 100);
const each = (check) => IMAGES.forEach(({ labels, width, height }, index) => check(labels, width, height, index));
const mask = (labels, label) => labels.map((value) => Number(value === label));

/** Even-odd filling at pixel centres: a ring's edges toggle everything to their right. */
function filled(rings, width, height) {
  const pixels = new Uint8Array(width * height);
  for (const ring of rings) {
    for (let at = 0; at < ring.length; at += 2) {
      const [x0, y0] = [ring[at], ring[at + 1]];
      const [x1, y1] = [ring[(at + 2) % ring.length], ring[(at + 3) % ring.length]];
      for (let y = Math.ceil(Math.min(y0, y1) - 0.5); y < Math.max(y0, y1) - 0.5; y++) {
        const crossing = x0 + ((y + 0.5 - y0) / (y1 - y0)) * (x1 - x0);
        for (let x = Math.max(0, Math.ceil(crossing - 0.5)); x < width; x++) pixels[y * width + x] ^= 1;
      }
    }
  }
  return pixels;
}

describe('polygons without tolerance fill the same pixels', () => {
  test('COCO: every ring by itself and united', () => {
    each((labels, width, height) => {
      for (const { category_id, segmentation } of formats.encodeCoco(labels, width, height, {}, { shape: 'polygon' }).annotations) {
        const sum = new Uint8Array(labels.length);
        for (const ring of segmentation) filled([ring], width, height).forEach((set, at) => (sum[at] += set));
        assert.deepEqual(sum, mask(labels, category_id - 1));
      }
    });
  });

  test('SVG: all rings together', () => {
    each((labels, width, height) => {
      const annotations = formats.encodeWebAnnotation(labels, width, height);
      assert.equal(annotations.length, present(labels).length);
      for (const { id, target } of annotations) {
        const path = / d="([^"]*)"/.exec(target.selector.value)[1];
        const rings = path.split('Z').slice(0, -1).map((ring) => ring.slice(1).split(' ').map(Number));
        assert.deepEqual(filled(rings, width, height), mask(labels, Number(id.slice('#motion-'.length))));
      }
    });
  });

  test('only corners are written', () => {
    const [{ segmentation }] = formats.encodeCoco(...Object.values(drawn('1111', '1111')), {}, { shape: 'polygon' }).annotations;
    assert.deepEqual(segmentation, [[0, 0, 4, 0, 4, 2, 0, 2]]);
  });
});

describe('polygons with a tolerance', () => {
  const options = (tolerance) => ({ shape: 'polygon', tolerance });
  const polygons = (labels, width, height, tolerance) =>
    formats.encodeCoco(labels, width, height, {}, options(tolerance)).annotations.map(({ category_id, segmentation }) => ({ label: category_id - 1, rings: segmentation }));
  const ring = (side, inner, outer) => Uint8Array.from({ length: side * side }, (_, at) => {
    const distance = Math.hypot((at % side) - side / 2 + 0.5, Math.floor(at / side) - side / 2 + 0.5);
    return distance < outer && distance > inner ? 1 : 255;
  });
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

  test('have few vertices, and nearly the same pixels', () => {
    const labels = ring(200, 30, 90);
    const [{ rings }] = polygons(labels, 200, 200, 0.5);
    assert.ok(rings[0].length / 2 < 60, `${rings[0].length / 2} vertices`);
    const pixels = filled(rings, 200, 200);
    const both = pixels.reduce((sum, set, at) => sum + Number(set && labels[at] === 1), 0);
    const either = pixels.reduce((sum, set, at) => sum + Number(set || labels[at] === 1), 0);
    assert.ok(both / either > 0.985, `${both / either}`);
  });

  test('a tolerance next to nothing keeps every pixel, with fewer vertices', () => {
    const count = (all) => all.reduce((sum, { rings }) => sum + rings.flat().length, 0);
    for (const images of [IMAGES, smooth]) {
      let [exact, thin] = [0, 0];
      for (const { labels, width, height } of images) {
        const found = polygons(labels, width, height, 1e-6);
        for (const { label, rings } of found) assert.deepEqual(filled(rings, width, height), mask(labels, label));
        exact += count(polygons(labels, width, height, 0));
        thin += count(found);
      }
      if (images === smooth) assert.ok(thin < 0.5 * exact, `${thin} of ${exact}`);
    }
  });

  for (const tolerance of [0.5, 1.5, 6, 300]) {
    test(`${tolerance}: no gap, no overlap, no mask, part or hole lost`, () => {
      for (const { labels, width, height } of [...IMAGES, ...smooth]) {
        const there = labels.map((label) => (label === 255 ? 9 : label));
        const sum = new Uint8Array(there.length);
        const exact = polygons(there, width, height, 0);
        const found = polygons(there, width, height, tolerance);
        assert.deepEqual(found.map(({ rings }) => rings.length), exact.map(({ rings }) => rings.length));
        for (const { rings } of found) filled(rings, width, height).forEach((set, at) => (sum[at] += set));
        assert.deepEqual(sum, new Uint8Array(there.length).fill(1));
        const loops = (tolerance) => formats.encodeWebAnnotation(there, width, height, {}, { tolerance }).map(({ target }) => target.selector.value.split('Z'));
        for (const paths of loops(tolerance)) for (const path of paths.slice(0, -1)) assert.ok(path.split(/[ M]/).length >= 7, path);
        assert.deepEqual(loops(tolerance).map((paths) => paths.length), loops(0).map((paths) => paths.length), 'as many outlines and holes');
      }
    });
  }

  test('a border of two masks has the same vertices on both sides', () => {
    let shared = 0;
    for (const { labels, width, height } of smooth) {
      const edges = new Map();
      for (const { rings } of polygons(labels, width, height, 0.5)) {
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

  test('rectangles stay as they are, the corners of the image stay', () => {
    const image = Object.values(drawn('111111111', '122211131', '122211111', '122211111', '111144111'));
    const vertices = (tolerance) =>
      formats.encodeWebAnnotation(...image, { labels: [2, 3, 4] }, { tolerance }).map(({ target }) => / d="M(.*)Z"/.exec(target.selector.value)[1].match(/\S+ \S+/g).sort());
    assert.deepEqual(vertices(0.5), vertices(0));
  });
});

test('masks with thousands of holes are outlined', () => {
  const [width, height] = [301, 301];
  const labels = Uint8Array.from({ length: width * height }, (_, at) => ((at % width) % 2 && Math.floor(at / width) % 2 ? 255 : 1));
  const [{ segmentation }] = formats.encodeCoco(labels, width, height, {}, { shape: 'polygon' }).annotations;
  assert.equal(segmentation.length, 1);
  assert.deepEqual(filled(segmentation, width, height), mask(labels, 1));
});

describe('masks of noise', () => {
  const noise = (side) => {
    const next = random(3);
    return [Uint8Array.from({ length: side * side }, () => Number(next() < 0.5)), side, side];
  };
  /** Width and height of most masks and of the larger ones. */
  const [side, largerSide] = soaking ? [1024, 2048] : [512, 1024];
  /** Seconds: five times what is needed. */
  const PATIENCE = 30 * (side / 1024) ** 2;
  const soon = (title, encode) => {
    test(title, () => {
      const seconds = stopwatch();
      encode();
      assert.ok(seconds() < PATIENCE, `${seconds()} s`);
    });
  };
  const frame = ([labels, width, height]) => ({ labels, width, height });
  const [large, larger, largest] = [side, largerSide, 2048].map(noise);
  const polygons = { shape: 'polygon' };
  const encoders = {
    'COCO, run lengths': (all) => formats.encodeCoco(...all),
    'COCO, polygons': (all) => formats.encodeCoco(...all, {}, polygons),
    'COCO, polygons with a tolerance': (all) => formats.encodeCoco(...all, {}, { ...polygons, tolerance: 1 }),
    'YouTube-VIS': (all) => formats.encodeCocoVideo([frame(all)]),
    'CVAT, polygons': (all) => formats.encodeCvatXml(...all, {}, polygons),
    'CVAT MOTS': (all) => formats.encodeCvatMots([frame(all)]),
    'Label Studio, brush': (all) => formats.encodeLabelStudio(...all),
    'Label Studio, polygons': (all) => formats.encodeLabelStudio(...all, {}, polygons),
    'LabelMe, masks': (all) => formats.encodeLabelMe(...all),
    'LabelMe, polygons': (all) => formats.encodeLabelMe(...all, {}, polygons),
    YOLO: (all) => formats.encodeYolo(...all),
    DAVIS: (all) => formats.encodeDavis(...all),
    Supervisely: (all) => formats.encodeSupervisely(...all),
    'Web Annotation': (all) => formats.encodeWebAnnotation(...all),
  };
  // Of each way to write a mask one.
  const some = cases(['YouTube-VIS', 'COCO, polygons with a tolerance', 'Label Studio, brush', 'CVAT MOTS'], Object.keys(encoders));
  for (const title of new Set(some)) soon(`${title}: ${side} × ${side}`, () => encoders[title](large));
  for (const title of cases(['Supervisely'], ['CVAT MOTS', 'DAVIS'])) soon(`${title}: ${largerSide} × ${largerSide}`, () => encoders[title](larger));
  for (const title of cases(['COCO, polygons'], ['YOLO', 'CVAT, polygons', 'Label Studio, polygons', 'LabelMe, polygons', 'Web Annotation'])) {
    soon(`${title}: 2048 × 2048 has too many vertices`, () => {
      assert.throws(() => encoders[title](largest), { code: 'invalid-input', message: /more than 4000000 vertices/ });
    });
  }

  test('are the same pixels', () => {
    const [labels, width, height] = noise(256);
    const png = decode(formats.encodeDavis(labels, width, height), { checkCrc: true });
    assert.deepEqual(Uint8Array.from(png.data), labels);
    for (const { category_id, segmentation } of formats.encodeCoco(labels, width, height, {}, polygons).annotations) {
      assert.deepEqual(filled(segmentation, width, height), mask(labels, category_id - 1));
    }
  });

  soon('teeth that a tolerance takes off one by one', () => {
    const side = largerSide;
    const teeth = (x, y) => y % 6 < 2 || (y % 6 === 2 && x % 2 === 0) || x === (Math.floor(y / 6) % 2 ? 0 : side - 1);
    const labels = Uint8Array.from({ length: side * side }, (_, at) => Number(teeth(at % side, Math.floor(at / side))));
    const [{ segmentation }] = formats.encodeCoco(labels, side, side, { labels: [1] }, { ...polygons, tolerance: 0.4 }).annotations;
    assert.equal(segmentation.length, 1);
  });
});

test('DAVIS PNG: indices and palette', () => {
  each((labels, width, height) => {
    const png = decode(formats.encodeDavis(labels, width, height), { checkCrc: true });
    assert.deepEqual([png.width, png.height, png.depth, png.channels], [width, height, 8, 1]);
    assert.deepEqual(Uint8Array.from(png.data), labels);
    assert.deepEqual(png.palette, davisPalette());
  });
});

test('MOTS: an archive of 16-bit images, the same bytes every time', () => {
  const frames = [drawn('0012', '..12'), drawn('0001', '...1')];
  const archive = formats.encodeCvatMots(frames, { names: { 0: 'background' } });
  assert.deepEqual(formats.encodeCvatMots(frames, { names: { 0: 'background' } }), archive);
  const files = unzipSync(archive);
  assert.deepEqual(Object.keys(files), ['default/instances/labels.txt', 'default/instances/first.png', 'default/instances/frame-1.png']);
  assert.equal(new TextDecoder().decode(files['default/instances/labels.txt']), 'background\nmotion-1\nmotion-2\n');
  const png = decode(files['default/instances/first.png'], { checkCrc: true });
  assert.equal(png.depth, 16);
  assert.deepEqual([...png.data], [1001, 1001, 2002, 3003, 0, 0, 2002, 3003]);
});

describe('frames one after another', () => {
  const labels = [drawn('0110', '0022'), drawn('0000', '0022'), drawn('1100', '2200')];
  const meta = { names: { 0: 'ground', 1: 'car', 2: 'car' }, labels: [1, 2], tracked: true };

  for (const name of MANY) {
    const encode = formats[name];
    const whole = encode(labels, meta);

    test(`${name}: from any iterable, in one buffer`, async () => {
      const shared = { ...drawn('0000', '0000') };
      function* frames() {
        for (const frame of labels) {
          shared.labels.set(frame.labels);
          yield shared;
        }
      }
      async function* later() {
        yield* frames();
      }
      assert.deepEqual(encode(frames(), meta), whole);
      assert.deepEqual(encode(new Set(labels), meta), whole);
      const promise = encode(later(), meta);
      assert.ok(promise instanceof Promise);
      assert.deepEqual(await promise, whole);
    });

    test(`${name}: a source that fails, or gives what is no frame, is closed`, async () => {
      const error = new VeroneseError('cancelled', 'no more');
      let closed = 0;
      async function* source(next) {
        try {
          yield labels[0];
          yield next();
        } finally {
          closed++;
        }
      }
      await assert.rejects(encode(source(() => { throw error; })), error);
      await assert.rejects(encode(source(() => ({ ...labels[0], width: 3 }))), { code: 'invalid-input' });
      await assert.rejects(encode(source(() => drawn('0'))), { code: 'frame-size-mismatch' });
      assert.equal(closed, 3);
    });
  }

  test('labels of one name are instances of one class', () => {
    const [frame] = labels;
    const coco = formats.encodeCoco(frame.labels, 4, 2, { names: meta.names });
    assert.deepEqual(coco.categories, [{ id: 1, name: 'ground' }, { id: 2, name: 'car' }]);
    assert.deepEqual(coco.annotations.map(({ category_id }) => category_id), [1, 2, 2]);
    assert.equal(formats.encodeCvatXml(frame.labels, 4, 2, { names: meta.names }).match(/<label>/g).length, 2);
    const { text, names } = formats.encodeYolo(frame.labels, 4, 2, { names: meta.names });
    assert.deepEqual([names, text.split('\n').map(([number]) => number)], [['ground', 'car'], ['0', '1', '1', undefined]]);
    assert.throws(() => formats.encodeYolo(frame.labels, 4, 2, {}, { classes: ['motion-0'] }), { code: 'invalid-input', message: /'motion-1' is not among the classes/ });
    assert.deepEqual(formats.encodeCocoVideo(labels, meta).categories, [{ id: 2, name: 'car' }]);
  });

  test('listed classes come first, with or without a mask, and keep their numbers', () => {
    const [{ labels: image }] = labels;
    const known = { names: { 1: 'car', 2: 'bus' }, labels: [1, 2], classes: ['person', 'car'], tracked: true };
    const { tracked: _, ...one } = known;
    const listed = [{ id: 1, name: 'person' }, { id: 2, name: 'car' }, { id: 5, name: 'bus' }];
    for (const { categories, annotations } of [formats.encodeCoco(image, 4, 2, one), formats.encodeCocoImages(labels, known), formats.encodeCocoVideo(labels, known)]) {
      assert.deepEqual(categories, listed);
      assert.deepEqual([...new Set(annotations.map(({ category_id }) => category_id))].sort(), [2, 5]);
    }
    const names = (xml) => [...xml.matchAll(/<label><name>(\w+)</g)].map(([, name]) => name);
    for (const xml of [formats.encodeCvatXml(image, 4, 2, one), formats.encodeCvatImages(labels, known), formats.encodeCvatVideo(labels, known)]) {
      assert.deepEqual(names(xml), ['person', 'car', 'bus']);
    }
    const yolo = formats.encodeYolo(image, 4, 2, one);
    assert.deepEqual([yolo.names, yolo.text.match(/^\d+/gm)], [['person', 'car', 'bus'], ['1', '2']]);
    assert.deepEqual(formats.encodeYolo(image, 4, 2, one, { classes: ['bus', 'car'] }).names, ['bus', 'car']);
    const mots = formats.encodeMots(labels, known);
    assert.deepEqual([mots.names, mots.gt.match(/^1 \d+/gm)], [['person', 'car', 'bus'], ['1 2001', '1 3002']]);
    assert.deepEqual(formats.encodeMotChallenge(labels, known).names, mots.names);
    const archive = unzipSync(formats.encodeCvatMots(labels, known));
    assert.equal(new TextDecoder().decode(archive['default/instances/labels.txt']), 'person\ncar\nbus\n');
    // MOTS has numbers for 64: of more, those that objects have are numbered, in the order of the list.
    const many = [...Array.from({ length: 62 }, (_, k) => `class ${k}`), 'bus', 'car'];
    const numbers = (classes) => {
      const { names, gt } = formats.encodeMots(labels, { ...known, classes });
      const archive = unzipSync(formats.encodeCvatMots(labels, { ...known, classes }));
      assert.equal(new TextDecoder().decode(archive['default/instances/labels.txt']), names.map((name) => `${name}\n`).join(''));
      return [names, gt.match(/^1 \d+/gm)];
    };
    assert.deepEqual(numbers(many), [many, ['1 64001', '1 63002']]);
    assert.deepEqual(numbers(['person', ...many]), [['bus', 'car'], ['1 2001', '1 1002']]);
    assert.deepEqual(numbers(many.with(62, 'person')), [['car', 'bus'], ['1 1001', '1 2002']]);
    assert.throws(() => formats.encodeCoco(image, 4, 2, { classes: ['car', 'car'] }), { code: 'invalid-input' });
  });

  test('an object is in a frame once', () => {
    const twice = [1, 1].map((label) => ({ label, matrix: [0, 0, label, 0, 0, 0] }));
    for (const name of MANY) {
      assert.throws(() => formats[name]([{ ...labels[0], motions: twice }]), { code: 'invalid-input', message: 'motions has a label twice' }, name);
    }
  });

  test('numbers of objects are kept where they are tracked', () => {
    const ids = (tracked) => formats.encodeCocoVideo(labels, { labels: [0, 2], tracked }).annotations.map(({ id }) => id);
    assert.deepEqual([ids(false), ids(true)], [[1, 2], [255, 2]]);
    const tracks = (tracked) => formats.encodeCocoImages(labels, { labels: [2], tracked }).annotations.map(({ attributes }) => attributes?.track_id);
    assert.deepEqual([tracks(false), tracks(true)], [Array(3).fill(undefined), [2, 2, 2]]);
  });

  test('times of Label Studio', () => {
    const times = (more) => {
      const [{ value }] = formats.encodeLabelStudioVideo(labels, { labels: [2], ...more }).predictions[0].result;
      return [...value.sequence.map(({ time }) => time), value.duration];
    };
    assert.deepEqual(times({}), [0, 0.04, 0.08, 0.12]);
    assert.deepEqual(times({ frameRate: 2 }), [0, 0.5, 1, 1.5]);
    assert.deepEqual(times({ timestamps: [10, 10.5, 12] }), [10, 10.5, 12, 3]);
    assert.deepEqual(times({ timestamps: [10, 10.5, 12], frameRate: 4 }), [10, 10.5, 12, 2.25]);
    for (const wrong of [{ timestamps: [10, 12, 11] }, { timestamps: [10, 11] }, { timestamps: [-1e308, 0, 1e308] }, { frameRate: 1e-308 }]) {
      assert.throws(() => times(wrong), { code: 'invalid-input' }, JSON.stringify(wrong));
    }
    assert.match(formats.encodeMots(labels, { timestamps: [0, 0, 1e-300] }).seqinfo, /frameRate=25\n/);
  });
});

describe('veronese.json', () => {
  const meta = { image: 'a.png', names: { 1: 'car' }, motions: [{ label: 1, matrix: [0.1, 0, 1 / 3, 0, -0.1, 1e-300], residual: 2, group: 0 }] };

  test('comes back as it was, through text', () => {
    each((labels, width, height) => {
      const document = JSON.parse(JSON.stringify(formats.encodeVeronese(labels, width, height, meta)));
      assert.deepEqual(formats.decodeVeronese(document), { labels, width, height, image: 'a.png', meta });
    });
  });

  test('what is none is refused', () => {
    const good = formats.encodeVeronese(...Object.values(drawn('01')), meta);
    const wrong = [
      null, 5, [], {}, { ...good, format: 'other' }, { ...good, version: 2 }, { ...good, width: 0 }, { ...good, width: 1e9 },
      { ...good, runs: [0, 1] }, { ...good, runs: [0, 1, 1] }, { ...good, runs: [0, 3] }, { ...good, runs: [0, 2, 1, 0] },
      { ...good, runs: [0, 1, 256, 1] }, { ...good, runs: 'x' }, { ...good, motions: [{ label: 0, matrix: [1] }] }, { ...good, motions: {} },
      { ...good, names: [] }, { ...good, names: { 0: 1 } }, { ...good, image: 5 },
    ];
    for (const document of wrong) assert.throws(() => formats.decodeVeronese(document), { name: 'VeroneseError', code: 'invalid-input' });
  });
});

describe('what is known beside the labels', () => {
  const { labels, width, height } = drawn('0112');

  test('names, motions and a choice of labels', () => {
    const matrix = [0, 0, 1, 0, 0, 2];
    const meta = { image: 'a "b" & <c>.png', names: { 1: 'A & "B"' }, motions: [{ label: 1, matrix }], labels: [1] };
    const coco = formats.encodeCoco(labels, width, height, meta);
    assert.deepEqual(coco.annotations.map(({ category_id, attributes }) => [category_id, attributes]), [[2, { matrix }]]);
    assert.equal(coco.images[0].file_name, meta.image);
    const xml = formats.encodeCvatXml(labels, width, height, meta);
    assert.ok(xml.includes('name="a &quot;b&quot; &amp; &lt;c&gt;.png"'));
    assert.ok(xml.includes('<mask label="A &amp; &quot;B&quot;"'));
  });

  test('an empty image gives no mask', () => {
    const nothing = new Uint8Array(6).fill(255);
    assert.deepEqual(formats.encodeCoco(nothing, 3, 2).annotations, []);
    assert.deepEqual(formats.encodeYolo(nothing, 3, 2), { text: '', names: [] });
    assert.deepEqual(formats.encodeCocoRleCounts(new Uint8Array(6), 3, 2), { size: [2, 3], counts: [6] });
  });
});

describe('wrong input is refused', () => {
  test('names that lead out of an archive of frames, or that some system cannot have', () => {
    const encode = (image, names) => formats.encodeCvatMots([{ ...drawn('01'), image }], { names });
    const wrong = [
      '', '.png', 'a/.png', '/a.png', 'a//b.png', '../a.png', 'a/../b.png', '..', './a.png', 'a/./b.png', '..\\a.png', 'a\\..\\..\\b.png',
      '\\\\host\\share.png', 'C:\\a.png', 'C:a.png', 'c:/a.png', 'a\0.png', 'a\0b.png', 'a\nb.png', 'a\x7f.png', 'a\x85.png', 'NUL.png', 'a/con.png',
      'Com1.png', 'lpt9.tar.png', 'a .png', '.. /a.png', 'a./b.png', `${'a'.repeat(252)}.png`, `${'ä'.repeat(126)}.png`, `${'a/'.repeat(2001)}a.png`,
    ];
    for (const image of wrong) assert.throws(() => encode(image), { code: 'invalid-input', message: /cannot be the name of a file: it / }, JSON.stringify(image));
    const right = ['a.png', 'a b/c d.png', 'clip.v2/00001.jpg', 'ä/日本.png', '.hidden.png', 'null.png', 'concert/a.png', '12:30.png', `${'a'.repeat(251)}.png`];
    for (const image of right) {
      const [, name] = Object.keys(unzipSync(encode(image)));
      assert.equal(name, `default/instances/${image.replace(/\.[^.]*$/, '')}.png`);
    }
    for (const other of ['a/F1.png', 'A/f1.bmp', 'a/f1']) {
      const two = ['a/f1.png', other].map((image) => ({ ...drawn('01'), image }));
      assert.throws(() => formats.encodeCvatMots(two), { code: 'invalid-input', message: /two frames have the name/ }, other);
    }
    const labels = unzipSync(encode('a.png', { 0: 'a\0b\nc', 1: 'd' }))['default/instances/labels.txt'];
    assert.equal(new TextDecoder().decode(labels), 'a b c\nd\n');
    // Where a name is a reference to an image and no file of ours, it stays what it is.
    for (const image of ['../images/a.png', 'images\\a.png', 'https://example.org/a.png?b=c']) {
      assert.equal(formats.encodeCoco(...Object.values(drawn('01')), { image }).images[0].file_name, image);
      assert.equal(formats.encodeLabelMe(...Object.values(drawn('01')), { image }).imagePath, image);
    }
  });

  test('frames of two sizes, no frame, two frames of one name, too many labels for MOTS', () => {
    const frames = [drawn('01'), drawn('0', '1')];
    for (const encode of MANY.map((name) => formats[name])) {
      assert.throws(() => encode(frames), { code: 'frame-size-mismatch' });
      assert.throws(() => encode([]), { code: 'invalid-input' });
    }
    const twice = [1, 2].map(() => ({ ...drawn('01'), image: 'a.png' }));
    assert.throws(() => formats.encodeCvatMots(twice), { code: 'invalid-input' });
    assert.throws(() => formats.encodeCvatMots([{ ...drawn('01'), image: '../a.png' }]), { code: 'invalid-input' });
    const many = { labels: Uint8Array.from({ length: 65 }, (_, at) => at), width: 65, height: 1 };
    for (const encode of [formats.encodeCvatMots, formats.encodeMots]) {
      assert.throws(() => encode([many]), { code: 'invalid-input' });
      // Instances of one class are as many as there are labels.
      encode([many], { names: Object.fromEntries(Array.from(many.labels, (label) => [label, 'car'])) });
    }
  });
});
