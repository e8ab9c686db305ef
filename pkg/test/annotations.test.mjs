// Annotations read back: what `encode` writes gives the same labels again, files of other programs are understood, and whatever else comes
// ends with a sentence.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { deflateSync, gzipSync } from 'node:zlib';
import { zipSync } from 'fflate';
import { readAnnotations } from 'veronese/formats';
import { davisPng } from '../build/formats/pictures.js';
import { random } from '../../scripts/lib/random.mjs';
import { chunk, pngOf } from './support/chunks.mjs';
import { drawnClip } from './support/clip.mjs';
import { document, files } from './support/encoded.mjs';
import { drawn, intersectionOverUnion, labelImages, maskOf } from './support/masks.mjs';
import { stopwatch } from './support/processor.mjs';
import { soaking } from './support/soak.mjs';

const encoder = new TextEncoder();
const bytesOf = (content) => {
  if (content instanceof Uint8Array) return content;
  return encoder.encode(typeof content === 'string' ? content : JSON.stringify(content));
};
const file = (name, content) => ({ name, bytes: bytesOf(content) });
const read = (...contents) => readAnnotations(contents.map((content, k) => file(`file-${k}`, content)));

/** Those that are read back with the numbers of objects, and those that only name them. */
const NUMBERED = ['coco', 'coco-polygon', 'youtube-vis', 'cvat', 'cvat-polygon', 'cvat-video', 'mots', 'davis', 'masks'];
const NAMED = ['label-studio', 'label-studio-polygon', 'yolo'];
/** Without names. */
const PICTURES = ['davis', 'masks'];

const ground = (labels) => labels.map((label) => (label === 255 ? 0 : label));

/** Things of some size that wander, leave and come back: 160 × 120. */
function wandering(seed) {
  const next = random(seed);
  const [width, height] = [160, 120];
  const things = Array.from({ length: 5 }, (_, k) => ({
    label: 3 * k + 1,
    at: [20 + next() * 120, 20 + next() * 80],
    by: [next() * 16 - 8, next() * 16 - 8],
    size: [10 + next() * 22, 10 + next() * 22],
    turn: next() * 3,
    gone: Math.floor(next() * 6),
  }));
  return Array.from({ length: 6 }, (_, frame) => {
    const labels = new Uint8Array(width * height);
    for (const { label, at, by, size, turn, gone } of things) {
      if (frame === gone) continue;
      labels.forEach((_, pixel) => {
        const [x, y] = [(pixel % width) - at[0] - frame * by[0], Math.floor(pixel / width) - at[1] - frame * by[1]];
        const [u, v] = [(x * Math.cos(turn) + y * Math.sin(turn)) / size[0], (y * Math.cos(turn) - x * Math.sin(turn)) / size[1]];
        if (u * u + v * v < 1) labels[pixel] = label;
      });
    }
    return { labels, width, height, image: `${String(frame).padStart(5, '0')}.png` };
  });
}

describe('what is written is read back', () => {
  const small = drawnClip().map((labels, k) => ({ labels, width: 37, height: 23, image: `${String(k).padStart(5, '0')}.jpg` }));
  const images = labelImages(soaking ? 80 : 15).map((image) => [{ ...image, image: 'first.png' }]);
  for (const format of [...NUMBERED, ...NAMED]) {
    test(`${format}: every pixel, and what it knows of numbers and names`, async () => {
      for (const frames of [small, wandering(1), wandering(2), ...images]) {
        const numbers = [...new Set(frames.flatMap(({ labels }) => [...labels]))].filter((label) => label > 0 && label < 255).sort((a, b) => a - b);
        if (numbers.length === 0 && format !== 'davis') continue; // Nothing is annotated.
        for (const background of [false, true]) {
          const nameOf = (number, k) => (NUMBERED.includes(format) && k % 2 === 0 ? 'car' : `<thing> "${number}" & Boot 🚗`);
          const called = Object.fromEntries(numbers.map((number, k) => [number, nameOf(number, k)]));
          const metadata = { names: { 0: 'background', ...called }, labels: [...(background ? [0] : []), ...numbers] };
          const { width, height } = frames[0];
          const found = readAnnotations(await files(format, frames, metadata), { size: { width, height } });
          assert.deepEqual([...found.frames.keys()], frames.map(({ image }, k) => (['cvat-video', 'mots'].includes(format) ? `0000${k}` : image.slice(0, 5))));
          frames.forEach(({ labels }, k) => {
            const one = [...found.frames.values()][k];
            assert.deepEqual([one.width, one.height], [width, height]);
            if (NUMBERED.includes(format)) assert.deepEqual(one.read(), format === 'davis' ? labels : ground(labels));
            else assert.deepEqual(Array.from(one.read(), (number) => found.names[number]), Array.from(labels, (label) => called[label]));
          });
          if (NUMBERED.includes(format) && !PICTURES.includes(format)) assert.deepEqual(found.names, called);
        }
      }
    });
  }

  for (const format of ['coco-polygon', 'cvat-polygon', 'cvat-video']) {
    test(`${format}: thinned as convert does it, IoU of each object above .97`, async () => {
      for (const seed of [3, 4]) {
        const frames = wandering(seed);
        const found = [...readAnnotations(await files(format, frames, { tolerance: 0.5 })).frames.values()];
        frames.forEach(({ labels }, k) => {
          const drawn = found[k].read();
          for (const label of new Set(labels)) {
            const overlap = intersectionOverUnion(maskOf(labels, label), maskOf(drawn, label));
            const pixels = labels.filter((one) => one === label).length;
            // Of what is nearly covered there is little to compare.
            if (pixels >= 100) assert.ok(overlap >= 0.97, `${format}, frame ${k}, object ${label} of ${pixels} pixels: ${overlap}`);
          }
        });
      }
    });
  }

  test('frames without an object are left out where a document lists all frames, and there where each has a file', async () => {
    const frames = [drawn('00', '00'), drawn('01', '00')].map((one, k) => ({ ...one, image: `f${k}.png` }));
    for (const format of [...NUMBERED, ...NAMED]) {
      const { frames: found } = readAnnotations(await files(format, frames), { frames: ['f0', 'f1'], size: { width: 2, height: 2 } });
      assert.deepEqual([...found.keys()].sort(), ['davis', 'yolo'].includes(format) ? ['f0', 'f1'] : ['f1'], format);
    }
  });

  test('names of frames, for formats that count them', async () => {
    const [video] = await files('cvat-video', [drawn('11'), drawn('01')]);
    assert.deepEqual([...readAnnotations([video]).frames.keys()], ['00000', '00001']);
    assert.deepEqual([...readAnnotations([video], { frames: ['a.1', 'a.2', 'c'] }).frames.keys()], ['a.1', 'a.2']);
    const message = "'cvat-video.xml': it has a frame 1, and the clip has 1";
    assert.throws(() => readAnnotations([video], { frames: ['a'] }), { code: 'invalid-input', message });
    assert.throws(() => readAnnotations([video], { frames: 3 }), { code: 'invalid-option' });
    assert.throws(() => readAnnotations([video], { names: [] }), { code: 'invalid-option' });
  });
});

describe('numbers', () => {
  const image = (id, name = `f${id}.jpg`) => ({ id, file_name: name, width: 4, height: 1 });
  const rle = (at) => ({ size: [1, 4], counts: at < 3 ? [at, 1, 3 - at] : [3, 1] });
  const coco = (images, annotations, categories = [{ id: 1, name: 'cow' }, { id: 2, name: 'dog' }]) => ({ images, annotations, categories });

  test('without numbers the second cow of one frame is the second cow of the next', () => {
    const annotations = [[1, 1, 0], [1, 2, 1], [1, 1, 2], [2, 2, 0], [2, 1, 1], [2, 1, 2]];
    const all = annotations.map(([of, category, at]) => ({ image_id: of, category_id: category, segmentation: rle(at) }));
    const { frames, names } = read(coco([image(1), image(2)], all));
    assert.deepEqual([...frames.get('f1').read()], [1, 2, 3, 0]);
    assert.deepEqual([...frames.get('f2').read()], [2, 1, 3, 0]);
    assert.deepEqual(names, { 1: 'cow', 2: 'dog', 3: 'cow' });
  });

  test('tracks keep theirs; those that cannot be kept, and 0, give way', () => {
    const tracks = [7, 1000, 0, 'x'];
    const annotations = tracks.map((track, at) => ({ image_id: 1, category_id: 1, segmentation: rle(at), attributes: { track_id: track } }));
    const { frames, names } = read(coco([image(1)], annotations));
    assert.deepEqual([...frames.get('f1').read()], [7, 1, 2, 3]);
    assert.deepEqual(Object.keys(names), ['1', '2', '3', '7']);
  });

  test('more objects than numbers', () => {
    const annotations = Array.from({ length: 255 }, () => ({ image_id: 1, category_id: 1, segmentation: rle(0) }));
    assert.throws(() => read(coco([image(1)], annotations)), { code: 'invalid-input', message: "'file-0' has more than 254 objects" });
    assert.equal(read(coco([image(1)], annotations.slice(1))).frames.get('f1').read()[0], 254);
  });

  test('instances of MOTS that have one number in two classes', () => {
    const { frames, names, notes } = read('1 1001 1 1 4 013\n1 2001 2 1 4 112\n1 10000 10 1 4 31\n2 1001 1 1 4 31\n');
    assert.deepEqual([...frames.get('00000').read()], [1, 2, 0, 255]);
    assert.deepEqual([...frames.get('00001').read()], [0, 0, 0, 1]);
    // Nobody has said what the classes are called.
    assert.deepEqual(names, { 1: '1001', 2: '2001' });
    assert.deepEqual(notes.slice(1).map(({ message }) => message), ["'file-0': objects have other numbers here, each its own from 1 to 254: 2001 is 2"]);
  });

  const deep = (...levels) => pngOf([4, 1, 16, 0], ['IDAT', deflateSync(Buffer.from([0, ...levels.flatMap((level) => [level >> 8, level & 255])]))]);
  const MOTS = {
    text: ['1 1000 1 1 4 013\n1 2000 2 1 4 112\n1 10000 10 1 4 31\n1 26000 26 1 4 211\n', 'mots', [1, 2, 3, 255], { 1: '1000', 2: '2000', 3: '26000' }],
    pictures: [deep(1000, 2000, 26_000, 10_000), 'mots-png', [1, 2, 3, 255], { 1: '1000', 2: '2000', 3: '26000' }],
    'pictures that keep their numbers': [deep(0, 1001, 2003, 10_000), 'mots-png', [0, 1, 3, 255], { 1: '1001', 3: '2003' }],
    'what is ignored alone, which is a mask': [deep(0, 10_000, 10_000, 0), 'png', [0, 1, 1, 0], { 1: '10000' }],
  };
  for (const [what, [content, wanted, labels, called]] of Object.entries(MOTS)) {
    test(`instances of MOTS: ${what}; 10000 is ignored, and that is said`, () => {
      const { format, frames, names, notes } = read(content);
      assert.deepEqual([format, [...frames.values()].map((frame) => [...frame.read()]), names], [wanted, [labels], called]);
      assert.equal(notes.filter(({ code }) => code === 'mots-ignored').length, Number(wanted === 'mots-png'));
    });
  }

  test('frames of MOTS count from 0 where one is 0, or where that is said; what nothing tells is said', () => {
    const read = (text, options) => readAnnotations([file('a.txt', text)], options);
    const frames = (text, options) => [...read(text, options).frames.keys()];
    const line = (frame) => `${frame} 1001 1 1 4 013\n`;
    assert.deepEqual(frames(line(1) + line(0)), ['00000', '00001']);
    assert.deepEqual(frames(line(1) + line(2)), ['00000', '00001']);
    assert.deepEqual(frames(line(1) + line(2), { firstFrame: 0 }), ['00001', '00002']);
    assert.throws(() => frames(line(1), { firstFrame: 2 }), { code: 'invalid-option' });
    const message = "'a.txt': nothing tells whether its first frame is 0 or 1, taken is 1: say with --first-frame";
    const clip = ['a', 'b', 'c'];
    const notes = (text, options) => read(text, options).notes;
    for (const options of [{}, { frames: clip }]) assert.deepEqual(notes(line(1) + line(2), options), [{ code: 'first-frame-assumed', message }]);
    for (const [text, options] of [[line(0) + line(2), { frames: clip }], [line(1) + line(3), { frames: clip }], [line(2), { firstFrame: 0 }], [line(2), { firstFrame: 1 }]]) assert.deepEqual(notes(text, options), []);
  });
});

describe('files of other programs', () => {
  test("CVAT: tracks from 0 that leave, shapes by their order, tags, tasks of a project", () => {
    const text = `<?xml version="1.0" encoding="utf-8"?>
      <annotations><version>1.1</version><meta><project><tasks><task>
        <original_size><width>6</width><height>2</height></original_size>
      </task></tasks></project></meta>
      <track id="0" label="cow" source="manual">
        <polygon frame="3" keyframe="1" outside="0" occluded="0" points="0.00,0.00;4.00,0.00;4.00,1.00;0.00,1.00" z_order="1">
          <attribute name="age">3</attribute>
        </polygon>
        <polygon frame="4" keyframe="1" outside="1" occluded="0" points="0.00,0.00;4.00,0.00;4.00,1.00;0.00,1.00" z_order="1"></polygon>
      </track>
      <track id="1" label="dog"><mask frame="3" outside="0" rle="0, 3, 1, 2" left="2" top="0" width="3" height="2" z_order="0"/></track></annotations>`;
    const { frames, names, format } = read(text);
    assert.equal(format, 'cvat');
    assert.deepEqual([...frames.keys()], ['00003']);
    assert.deepEqual([...frames.get('00003').read()], [2, 2, 2, 2, 1, 0, 0, 0, 0, 1, 1, 0]);
    assert.deepEqual(names, { 1: 'dog', 2: 'cow' });
    const images = `<annotations><image id="9" name="task/cam 1/f.0001.png" width="3" height="1"><tag label="night"/>
      <polygon label="cow" points="0,0;2,0;2,1;0,1" z_order="2"/><polygon label="cow" points="1,0;3,0;3,1;1,1" z_order="1" group_id="0"/></image>
      <image id="10" name="g.png" width="3" height="1"/></annotations>`;
    const found = read(images);
    assert.deepEqual([...found.frames.keys()], ['f.0001']);
    assert.deepEqual([...found.frames.get('f.0001').read()], [2, 2, 1]);
  });

  test('COCO: plain counts of a crowd, polygons in parts and beyond the image, no categories', () => {
    const images = [{ id: 'a', file_name: 'data\\train\\x.jpeg', width: 3, height: 2 }];
    const annotations = [
      { image_id: 'a', iscrowd: 1, segmentation: { size: [2, 3], counts: [0, 1, 5] } },
      { image_id: 'a', segmentation: [[1, -5, 9, -5, 9, 1, 1, 1], [2, 1, 3, 1, 3, 2, 2, 2]] },
    ];
    const { frames, names } = read({ images, annotations });
    assert.deepEqual([...frames.get('x').read()], [1, 2, 2, 0, 0, 2]);
    assert.deepEqual(names, {});
  });

  test('archives, with the frames beside the annotation', async () => {
    const coco = await document('coco', { ...drawn('01'), image: 'a.png' });
    const others = { 'images/a.png': Uint8Array.of(137, 80, 78, 71), '__MACOSX/a.json': bytesOf('{'), 'info.txt': bytesOf('1 2') };
    const archive = { 'annotations/instances.json': bytesOf(coco), ...others };
    assert.deepEqual([...read(zipSync(archive)).frames.get('a').read()], [0, 1]);
    const bom = Uint8Array.of(0xef, 0xbb, 0xbf, ...bytesOf(coco));
    assert.deepEqual([...read(bom).frames.get('a').read()], [0, 1]);
    const mots = read(zipSync({ 'default/instances/labels.txt': bytesOf('car\nbus\n'), 'default/instances/f0.png': pngOf([2, 1, 16, 0], ['IDAT', deflateSync(Buffer.from([0, 1001, 2002].flatMap((level) => (level ? [level >> 8, level & 255] : [0]))))]) }));
    assert.deepEqual([mots.format, [...mots.frames.get('f0').read()], mots.names], ['mots-png', [1, 2], { 1: 'car', 2: 'bus' }]);
  });
});

describe('annotations as people have them', () => {
  const image = { id: 1, file_name: '0001.png', width: 8, height: 6 };
  const ring = [1, 1, 5, 1, 5, 4, 1, 4];
  const coco = (...annotations) => ({ images: [image], categories: [{ id: 0, name: 'car' }], annotations: annotations.map((one, id) => ({ id, image_id: 1, category_id: 0, ...one })) });
  const cvat = (inside) => `<annotations><image id="0" name="0001.png" width="8" height="6">${inside}</image></annotations>`;
  const polygon = { points: [[1, 1], [5, 1], [5, 4], [1, 4]] };
  const task = (...result) => [{ id: 3, data: { image: '/data/upload/1/0a1b2c3d-0001.png' }, annotations: [{ result: result.map((one) => ({ original_width: 8, original_height: 6, ...one })) }] }];
  const percent = ([x, y]) => [(100 * x) / 8, (100 * y) / 6];
  /** A mask of 4 × 3 pixels at (1, 1) beside a box of 2 × 1 at (6, 4). */
  const BOTH = {
    coco: coco({ segmentation: [ring] }, { segmentation: [], bbox: [6, 4, 2, 1] }),
    cvat: cvat('<polygon label="car" points="1,1;5,1;5,4;1,4"/><box label="car" xtl="6.2" ytl="4.0" xbr="7.9" ybr="4.9"/>'),
    'label-studio': task(
      { type: 'polygonlabels', value: { points: polygon.points.map(percent), polygonlabels: ['car'] } },
      { type: 'rectanglelabels', value: { x: 75, y: 66.7, width: 25, height: 16, rectanglelabels: ['car'] } },
    ),
  };
  const labels = [...'00000000', ...'01111000', ...'01111000', ...'01111000', ...'000000..', ...'00000000'].map((digit) => (digit === '.' ? 255 : Number(digit)));

  for (const [format, content] of Object.entries(BOTH)) {
    test(`${format}: a box beside a mask is a prompt, around which the mask says nothing`, () => {
      const found = readAnnotations([file('0001.png.json', content)]);
      assert.equal(found.format, format);
      assert.deepEqual([...found.frames.get('0001').read()], labels);
      assert.deepEqual(found.boxes, [{ frame: '0001', object: 2, box: [6, 4, 2, 1] }]);
      assert.deepEqual(found.names, { 1: 'car', 2: 'car' });
      assert.deepEqual(found.notes.map(({ code }) => code), ['boxes-taken']);
    });
  }

  test('boxes alone, on frames without any mask', async () => {
    const { frames, boxes } = read(await document('cvat-video', [drawn('01'), drawn('11')], { shape: 'box' }));
    assert.equal(frames.size, 0);
    assert.deepEqual(boxes, [{ frame: '00000', object: 1, box: [1, 0, 1, 1] }, { frame: '00001', object: 1, box: [0, 0, 2, 1] }]);
  });

  test('what has no inside is left out and counted; nothing of it refuses the file', () => {
    assert.match(read(cvat('<polygon label="car" points="1,1;5,1;5,4"/><points label="a" points="1,1"/><points label="a" points="2,1"/><polyline label="a" points="2,1"/>')).notes[0].message, /<points> elements \(2\), <polyline> elements \(1\)/);
    assert.match(read(coco({ segmentation: [ring] }, { segmentation: null })).notes[0].message, /without a mask \(1\)/);
    assert.match(read(coco({ segmentation: [ring] }, { segmentation: [], bbox: [20, 20, 3, 3] })).notes[0].message, /boxes without a pixel of the frame \(1\)/);
  });

  const at = (found, x, y) => found.frames.get('0001')?.read()[8 * y + x];
  const circle = [...'00000000', ...'00000000', ...'00011000', ...'00111100', ...'00111100', ...'00011000'].map(Number);
  const ROUND = {
    cvat: cvat('<ellipse label="car" cx="4" cy="4" rx="2" ry="2"/>'),
    'label-studio': task({ type: 'ellipselabels', value: { x: 50, y: 100 / 1.5, radiusX: 25, radiusY: 100 / 3, rotation: 0, ellipselabels: ['car'] } }),
  };
  test('circles and ellipses are drawn, also those that are turned; rectangles that are turned are the boxes around them', () => {
    for (const [format, content] of Object.entries(ROUND)) {
      const { frames, notes } = readAnnotations([file('0001.png.json', content)]);
      assert.deepEqual([[...frames.get('0001').read()], notes], [circle, []], format);
    }
    const turned = read(cvat('<ellipse label="car" cx="4" cy="3" rx="1" ry="3" rotation="90"/>'));
    assert.deepEqual([[1, 3], [6, 3], [4, 0], [4, 5]].map(([x, y]) => at(turned, x, y)), [1, 1, 0, 0]);
    assert.throws(() => read(cvat('<ellipse label="car" cx="4" cy="3" rx="1"/>')).frames.get('0001').read(), { message: /image "0001\.png", shape 1: an ellipse must have a middle and radii/ });
    const boxes = {
      'about the middle': [cvat('<box label="car" xtl="2" ytl="2" xbr="6" ybr="4" rotation="90"/>'), [3, 1, 2, 4]],
      'about a corner': [task({ type: 'rectanglelabels', value: { x: 50, y: 0, width: 25, height: 50, rotation: 90, rectanglelabels: ['car'] } }), [1, 0, 3, 2]],
    };
    for (const [how, [content, box]] of Object.entries(boxes)) assert.deepEqual(read(content).boxes, [{ frame: '0001', object: 1, box }], how);
  });

  const UNREAD = {
    cvat: cvat('<polygon label="car" points="1,1;5,1;5,4;1,4"/><polyline label="car" points="6,4;7,5"/>'),
    coco: coco({ segmentation: [ring] }, { keypoints: [7, 5, 2] }),
    'label-studio': task({ type: 'polygonlabels', value: { points: polygon.points.map(percent), polygonlabels: ['car'] } }, { type: 'keypointlabels', value: { x: 90, y: 90 } }),
  };
  test('where a shape is not read, nothing is said of the ground, and of a frame of which none is read nothing at all', () => {
    for (const [format, content] of Object.entries(UNREAD)) {
      const found = readAnnotations([file('0001.png.json', content)]);
      assert.deepEqual([at(found, 2, 2), at(found, 7, 5), at(found, 0, 0)], [1, 255, 255], format);
      assert.deepEqual(found.notes.map(({ code }) => code), ['shapes-left-out']);
      assert.deepEqual(found.names, { 1: 'car' });
    }
    const line = '<polyline label="car" points="6,4;7,5"/>';
    assert.throws(() => read(cvat(line)), { message: /annotates no frame: .*left out <polyline> elements \(1\)/ });
    const { frames } = read(cvat(line), cvat('<polygon label="car" points="1,1;5,1;5,4"/>').replace('0001', '0002'));
    assert.deepEqual([...frames.keys()], ['0002']);
  });

  test('a polygon of one or two vertices is left out, and the rest is read; the second box of an object says nothing of the ground either', () => {
    const clicked = coco({ segmentation: [[6, 5, 7, 5], ring] }, { segmentation: [[6, 5]] });
    const found = readAnnotations([file('0001.png.json', clicked)]);
    assert.deepEqual([at(found, 6, 5), at(found, 2, 2), at(found, 0, 0)], [255, 1, 0]);
    assert.match(found.notes[0].message, /left out polygons of fewer than three vertices \(2\)/);
    const second = read(cvat('<polygon label="car" points="1,1;5,1;5,4;1,4" group_id="3"/><box label="car" xtl="6" ytl="4" xbr="8" ybr="6" group_id="3"/>'));
    assert.deepEqual([at(second, 2, 2), at(second, 7, 5), at(second, 0, 0)], [3, 255, 0]);
  });

  test("COCO: a polygon without a list around it, and numbers that Python writes", () => {
    const flat = coco({ segmentation: ring, area: 0 });
    const text = JSON.stringify(flat).replace('"area":0', '"area":NaN,"note":"NaN","score":-Infinity');
    assert.deepEqual([...read(text).frames.get('0001').read()], labels.map((label) => label % 255));
    assert.throws(() => read(JSON.stringify(coco({ id: 7, segmentation: [[1, 2, 3, 4, 5, 0]] })).replace('5,0]', '5,NaN]')).frames.get('0001').read(), {
      message: /^'file-0': image "0001\.png", annotation 7: a polygon has a vertex/,
    });
  });

  test('Label Studio: brushes, the last annotation that was not skipped, names of images', async () => {
    const frame = drawn('0110', '0121', '0000');
    const [{ predictions: [{ result: [{ value }, other] }] }] = await document('label-studio', frame, { names: { 1: 'a', 2: 'b' } });
    const result = [value, other.value].map((value) => ({ type: 'brushlabels', original_width: 4, original_height: 3, value }));
    const tasks = [
      { data: { image: '/data/local-files/?d=clips%2Fone%2F0001.jpg' }, annotations: [{ result: [] }, { result }, { was_cancelled: true, result: [] }] },
      { data: { img: 's3://bucket/0002.png' }, predictions: [{ result: [result[1], { type: 'choices', value: {} }] }] },
    ];
    const { frames, names, notes } = read(tasks);
    assert.deepEqual([...frames.keys()], ['0001', '0002']);
    assert.deepEqual([...frames.get('0001').read()], [...frame.labels]);
    assert.deepEqual([names, notes], [{ 1: 'a', 2: 'b' }, []]);
    const damaged = task({ id: 'x', type: 'brushlabels', value: { format: 'rle', rle: value.rle.slice(0, 9), brushlabels: ['a'] } });
    assert.throws(() => read(damaged).frames.get('0001').read(), { message: /^'file-0': task 3, image "0001\.png".*|result "x": the run lengths/ });
  });
});

describe('what is none of that', () => {
  const image = { id: 1, file_name: 'f.jpg', width: 4, height: 4 };
  const coco = (change = {}, annotation = {}) => ({
    images: [image],
    categories: [{ id: 1, name: 'cow' }],
    annotations: [{ image_id: 1, category_id: 1, segmentation: { size: [4, 4], counts: [0, 16] }, ...annotation }],
    ...change,
  });
  const segmentation = (value) => coco({}, { segmentation: value });
  const rle = (counts, size = [4, 4]) => segmentation({ size, counts });
  const vis = (change = {}, annotation = {}) => ({
    videos: [{ id: 1, width: 4, height: 4, file_names: ['a.jpg', 'b.jpg'] }],
    annotations: [{ id: 1, video_id: 1, segmentations: [null, { size: [4, 4], counts: [0, 16] }], ...annotation }],
    ...change,
  });
  const cvat = (inside, attributes = 'name="f.jpg" width="4" height="4"') => `<annotations><image ${attributes}>${inside}</image></annotations>`;
  const mask = (attributes) => cvat(`<mask label="a" ${attributes}/>`);
  const track = (inside, size = '<width>4</width><height>4</height>') =>
    `<annotations><meta><task><original_size>${size}</original_size></task></meta><track id="1" label="a">${inside}</track></annotations>`;
  const polygon = (points) => cvat(`<polygon label="a" points="${points}"/>`);
  const png = davisPng(new Uint8Array(16), 4, 4);
  const WRONG = {
    'nothing at all': ['', /is not an annotation in a format that is read/],
    'half of a document': ['{"images": [', /is not JSON/],
    'bytes that are no text': [Uint8Array.of(0x7b, 0xff, 0xfe), /is not in UTF-8/],
    'an archive of something else': [gzipSync(Buffer.from('{}')), /is not an annotation/],
    'half of an archive': [zipSync({ 'a.json': bytesOf(coco()) }).slice(0, 40), /archive is damaged/],

    'no image': [coco({ images: {} }), /"images" must be a list of objects/],
    'an image of no size': [coco({ images: [{ ...image, width: 0 }] }), /width and height of an image must be whole numbers from 1 to 16384/],
    'an image without a name': [coco({ images: [{ id: 1, width: 4, height: 4 }] }), /image must be text/],
    'an image that leads elsewhere': [coco({ images: [{ ...image, file_name: '..' }] }), /cannot be the name of a file/],
    'an image without an id': [coco({ images: [{ ...image, id: undefined }] }), /each image must have an id/],
    'an image twice': [coco({ images: [image, image] }), /two images have the id 1/],
    'two images of one name': [coco({ images: [image, { ...image, id: 2, file_name: 'x/F.png' }], annotations: [1, 2].map((id) => ({ image_id: id, segmentation: [[0, 0, 1, 0, 1, 1]] })) }), /has two frames called 'F'/],
    'no annotation': [coco({ annotations: [] }), /annotates no frame/],
    'an annotation of no image': [coco({}, { image_id: 2 }), /of the image 2, and there is none/],
    'a category without a name': [coco({ categories: [{ id: 1, name: 3 }] }), /name of a category must be text/],
    'neither mask nor box': [segmentation([]), /annotates no frame: .*left out annotations without a mask \(1\)/],
    'too few counts': [rle([0, 15]), /must be of 16 pixels, not 15/],
    'a negative count': [rle([0, 17, -1]), /whole numbers from 0/],
    'counts of another frame': [rle([0, 16], [2, 8]), /of the frame's size, \[4, 4\], not \[2,8\]/],
    'damaged text': [rle('0é'), /run lengths is damaged/],
    'a polygon far away': [segmentation([[0, 0, 1e9, 1, 2, 2]]), /no pair of numbers up to/],

    'a video without frames': [vis({ videos: [{ id: 1, width: 4, height: 4 }] }), /"file_names" must be a list/],
    'an annotation of no video': [vis({}, { video_id: 2 }), /of the video 2, and there is none/],
    'masks of too few frames': [vis({}, { segmentations: [null] }), /an entry for each frame/],

    'XML that is not well-formed': ['<annotations><image></annotations>', /is not XML: Missing end tag for element image/],
    'another XML': ['<html></html>', /is no annotation of CVAT/],
    'entities that grow': [`<!DOCTYPE a [<!ENTITY b "bbbbbbbbbb"><!ENTITY c "&b;&b;&b;&b;&b;&b;">]>${cvat('<mask label="&c;"/>')}`, /is not XML: Named entity isn't defined/],
    'a box of CVAT without sides': [cvat('<box label="a" xtl="0" ytl="0" xbr="2"/>'), /image "f\.jpg": a box must have four numbers/],
    'points that are no numbers': [polygon('0,0;NaN,1;2,2'), /no pair of numbers/],
    'a mask outside': [mask('rle="0, 4" left="3" top="0" width="2" height="2"'), /must lie inside the frame/],
    'a mask of no runs': [mask('left="0" top="0" width="2" height="2"'), /whole numbers from 0/],
    'a track of no size': [track('<polygon frame="0" points="0,0;1,0;1,1"/>', ''), /width and height of the video, in <original_size>,/],
    'a track of no frame': [track('<polygon points="0,0;1,0;1,1"/>'), /frame of a shape must be a whole number/],

    'lines of MOTS that end early': ['1 1001 1 4 4 0<\n2 1001', /line 2 is not "frame id class height width run-lengths"/],
    'sizes of MOTS that differ': ['1 1001 1 1 4 04\n1 1002 1 1 5 05', /line 2: the frame has had another size/],

    'a picture': [pngOf([32, 32, 8, 2], ['IDAT', deflateSync(Buffer.from(Array.from({ length: 32 * 97 }, (_, at) => (at % 97 === 0 ? 0 : at * 7919))))]), /it has \d+ colours only between others/],
    'half of a PNG': [png.slice(0, png.length - 30), /it is damaged/, 'unreadable-image'],
    'a large PNG': [Uint8Array.from(png).fill(255, 18, 20), /it has 65535 × 4 pixels|it has \d+ × 4 pixels/, 'unreadable-image'],
  };
  for (const [name, [content, sentence, code = 'invalid-input']] of Object.entries(WRONG)) {
    test(name, () => {
      const all = () => [...readAnnotations([file('folder/a.file', content)]).frames.values()].map((one) => one.read());
      const seconds = stopwatch();
      assert.throws(all, (error) => {
        assert.equal(error.name, 'VeroneseError', error.stack);
        assert.equal(error.code, code, error.message);
        assert.match(error.message, /^'folder\/a\.file'/, 'the file is named');
        assert.match(error.message, sentence);
        assert.ok(error.message.length < 300, 'a sentence');
        return true;
      });
      assert.ok(seconds() < 2);
    });
  }

  test('files that contradict each other', () => {
    const [one, other] = [file('a.png', png), file('b.png', davisPng(new Uint8Array(8), 4, 2))];
    assert.throws(() => readAnnotations([one, other]), { code: 'frame-size-mismatch', message: "'b.png': frame 'b' has 4×2 pixels, others have 4×4" });
    assert.throws(() => readAnnotations([one, file('x/A.png', png)]), { message: "'x/A.png' and 'a.png' are both of the frame 'A'" });
    const both = [file('a.json', coco()), file('a.xml', polygon('0,0;1,0;1,1'))];
    assert.throws(() => readAnnotations(both), { code: 'invalid-input', message: "'a.json' is coco and 'a.xml' is cvat: give one of them" });
    assert.throws(() => readAnnotations([]), { code: 'invalid-input', message: /^no file is an annotation/ });
    for (const wrong of [undefined, 3, [3], [{ name: 3, bytes: png }], [{ name: 'a', bytes: 'text' }], { get 0() { throw new Error('boo'); } }]) {
      assert.throws(() => readAnnotations(wrong), { name: 'VeroneseError', code: 'invalid-input' });
    }
  });

  describe('work without end', () => {
    // The work is bounded by the size of the frame: the largest there may be, with npm run soak.
    const [width, height] = soaking ? [4096, 4096] : [1024, 1024];
    const large = (annotations) => ({ images: [{ id: 1, file_name: 'f', width, height }], annotations });
    const full = { size: [height, width], counts: [0, width * height] };
    const small = Array.from({ length: 10_000 }, (_, id) => ({ id, image_id: 1, track_id: 1, segmentation: [[0, 0, 9, 0, 9, id < 9999 ? 9 : undefined]] }));
    const HOSTILE = {
      'ten thousand polygons, of which the last is wrong': large(small),
      'one mask over another': large(Array.from({ length: soaking ? 100_000 : 20_000 }, () => ({ image_id: 1, track_id: 1, segmentation: full }))),
      'a polygon that goes up and down': large([{ image_id: 1, segmentation: [Array.from({ length: 2_000_000 }, (_, k) => (k % 4 === 1 ? -1 : k % 4 === 3 ? 5000 : k % 3000))] }]),
      'a tower of elements': `${'<annotations>'.repeat(100_000)}${'</annotations>'.repeat(100_000)}`,
      'a PNG that grows': Buffer.concat([png.subarray(0, 33), chunk('IDAT', deflateSync(Buffer.alloc(2 ** (soaking ? 28 : 24))))]),
    };
    for (const [name, content] of Object.entries(HOSTILE)) {
      test(name, () => {
        const source = file('a.file', content);
        const seconds = stopwatch();
        assert.throws(() => [...readAnnotations([source]).frames.values()].map((one) => one.read()), { name: 'VeroneseError' });
        assert.ok(seconds() < 20, `${seconds()} s`);
      });
    }
  });
});

describe('YOLO', () => {
  const SQUARE = '0.25 0.25 0.75 0.25 0.75 0.75 0.25 0.75';
  const size = { width: 8, height: 4 };
  /** Columns 2 to 5 of rows 1 and 2. */
  const square = (number) => Array.from({ length: 32 }, (_, p) => (p % 8 >= 2 && p % 8 < 6 && p >= 8 && p < 24 ? number : 0));
  const yolo = (text, ...more) => readAnnotations([file('set/labels/a.txt', text), ...more], { size });

  test('outlines and boxes, with the confidence of what was found or without; a text without lines is a frame without objects', () => {
    const { format, frames, names, boxes } = yolo(`1 ${SQUARE} 0.87\r\n0 0.25 0.5 0.5 1\n0 0.5 0.5 1 1 0.4\n`, file('set/labels/b.txt', '\n'), file('set/notes.txt', ''));
    assert.equal(format, 'yolo');
    assert.deepEqual([...frames.keys()], ['a', 'b']);
    assert.deepEqual([...frames.get('b').read()], Array(32).fill(0));
    assert.deepEqual(names, { 1: 'class-1', 2: 'class-0', 3: 'class-0' });
    assert.deepEqual(boxes, [{ frame: 'a', object: 2, box: [0, 0, 4, 4] }, { frame: 'a', object: 3, box: [0, 0, 8, 4] }]);
    const open = square(1).map((label, p) => label || (p >= 0 ? 255 : 0));
    assert.deepEqual([...frames.get('a').read()], open);
  });

  const LISTS = {
    'by number': ['set/data.yaml', '# classes\nnc: 2\nnames:\n  0: person\n\n  1: "a \\"b\\": c" # c\ntrain: x\n'],
    'as a list': ['data.yaml', "names:\n- person\n- 'a \"b\": c'\nnc: 2\n"],
    'in brackets': ['set/data.yml', `path: ../set\r\nnames: ['person', 'a "b": c']\r\n`],
    'over lines in brackets': ['set/data.yaml', `names: [\n  person,\n  'a "b": c',\n]\n`],
    'in braces': ['set/data.yaml', `names: {1: 'a "b": c', 0: person}`],
    'in a text': ['set/classes.txt', 'person\na "b": c\n'],
    'of Darknet': ['set/obj.names', 'person\r\na "b": c\r\n'],
    'of Roboflow': ['set/labels/_darknet.labels', 'person\na "b": c'],
  };
  for (const [how, list] of Object.entries(LISTS)) {
    test(`names of classes ${how}`, () => {
      const other = file('other/data.yaml', 'names: [x, y]');
      assert.deepEqual(yolo(`1 ${SQUARE}\n`, file(...list), other).names, { 1: 'a "b": c' });
    });
  }

  test('the size is that of the image with the name, PNG or JPEG; of several that of the folder of images', () => {
    const png = davisPng(new Uint8Array(64), 16, 4);
    const jpeg = Uint8Array.of(0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xff, 0xc2, 0, 11, 8, 0, 8, 0, 4, 1, 1, 0x11, 0);
    const sizeOf = (...more) => {
      const { width, height } = yolo(`0 ${SQUARE}`, ...more).frames.get('a');
      return [width, height];
    };
    assert.deepEqual(sizeOf(), [8, 4]);
    assert.deepEqual(sizeOf(file('set/images/a.png', png)), [16, 4]);
    assert.deepEqual(sizeOf(file('elsewhere/A.JPG', jpeg)), [4, 8]);
    assert.deepEqual(sizeOf(file('masks/a.png', png), file('set/images/a.jpg', jpeg)), [4, 8]);
    const alone = () => readAnnotations([file('set/labels/a.txt', `0 ${SQUARE}`), file('b.png', png)]);
    assert.throws(alone, { code: 'invalid-input', message: "'set/labels/a.txt': it does not say the size of its image: give that as PNG or JPEG as well, or the clip (--clip)" });
  });

  test('what is wrong is named by its line', () => {
    const wrong = { [`0 ${SQUARE}\n0 0.1 0.2 0.3`]: /line 2: it must have/, [`0 ${SQUARE}\nx`]: /line 2: it must/, '0 10 10 90 10 90 90': /line 1: its numbers are no shares/ };
    for (const [text, message] of Object.entries(wrong)) assert.throws(() => yolo(text), { code: 'invalid-input', message: new RegExp(`^'set/labels/a.txt': ${message.source}`) });
    assert.throws(() => readAnnotations([file('a.txt', `0 ${SQUARE}`)], { size: 5 }), { code: 'invalid-option' });
  });
});
