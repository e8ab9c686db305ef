// Masks as people have them: what each kind of file is taken for, by `convert --to corrections` and by `clip --masks`, and what is said of it.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { decode, encode } from 'fast-png';
import { davisPalette } from 'veronese';
import { readAnnotations } from 'veronese/formats';
import { pngOf } from './support/chunks.mjs';
import { clip as framesOf, labelsOf, lines, tracksOf } from './support/folders.mjs';
import { frame } from './support/frames.mjs';
import { temporaryFolder, veronese } from './support/program.mjs';

const SIZE = { width: 48, height: 36 };
const PIXELS = SIZE.width * SIZE.height;
const picture = (of) => Array.from({ length: PIXELS }, (_, p) => of(p % SIZE.width, Math.floor(p / SIZE.width)));
const square = (x, y) => x >= 8 && x < 20 && y >= 6 && y < 18;
const other = (x, y) => x >= 26 && x < 40 && y >= 10 && y < 30;
const ONE = picture((x, y) => Number(square(x, y)));
const TWO = picture((x, y) => (square(x, y) ? 1 : other(x, y) ? 2 : 0));
/** A PNG of lists of samples, or of numbers, for each pixel. */
const file = (pixels, { depth = 8 } = {}) => {
  const samples = pixels.flat();
  const data = depth === 16 ? Uint16Array.from(samples) : Uint8Array.from(samples);
  return encode({ ...SIZE, channels: samples.length / PIXELS, depth, data });
};
const [BLACK, RED, BLUE, WHITE] = [[0, 0, 0], [200, 30, 10], [10, 20, 220], [255, 255, 255]];
const coloured = (...colours) => file(TWO.map((number) => colours[number]));
const indexed = (labels, colours) => pngOf([SIZE.width, SIZE.height, 8, 3], ['PLTE', Buffer.from(colours.flat())], ['IDAT', deflateSync(rowsOf(labels))]);
const rowsOf = (labels) => Buffer.from(Array.from({ length: SIZE.height }, (_, y) => [0, ...labels.slice(y * SIZE.width, (y + 1) * SIZE.width)]).flat());

/** How much of each pixel, from 0 to 1, is in a disc, with an edge of some pixels. */
const disc = (centre, radius, edge) => picture((x, y) => Math.min(1, Math.max(0, (radius - Math.hypot(x - centre[0], y - centre[1])) / edge + 0.5)));
const mixed = (share, from, to) => share.map((part) => from.map((value, channel) => Math.round(value + part * (to[channel] - value))));

/** A picture in seven passes. */
function interlaced(rows) {
  const passes = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];
  const bytes = [];
  for (const [left, top, across, down] of passes) {
    for (let y = top; y < SIZE.height; y += down) {
      bytes.push(0);
      for (let x = left; x < SIZE.width; x += across) bytes.push(...rows[y * SIZE.width + x]);
    }
  }
  const header = pngOf([SIZE.width, SIZE.height, 8, 2], ['IDAT', deflateSync(Buffer.from(bytes))]);
  header[28] = 1;
  return header;
}

const KINDS = {
  'white on black': [file(ONE.map((is) => is * 255)), ONE, /255 is the object, number 1/],
  'a number on black': [file(ONE.map((is) => is * 7)), ONE.map((is) => is * 7)],
  'white on black, indexed': [indexed(ONE.map((is) => is * 255), davisPalette()), ONE, /255 is the object/],
  'white on black, 16 bits': [file(ONE.map((is) => is * 65_535), { depth: 16 }), ONE, /65535 is the object/],
  'numbers of 16 bits': [file(TWO, { depth: 16 }), TWO],
  'white on black, in colours': [file(ONE.map((is) => (is ? WHITE : BLACK))), ONE, /255 is the object/],
  'numbers, and 255 of which nothing is said': [file(TWO.map((number, p) => (p < 48 ? 255 : number))), TWO.map((number, p) => (p < 48 ? 255 : number))],
  'a colour for each object': [coloured(BLACK, RED, BLUE), TWO, /black is the background, each of 2 colours is an object/],
  'colours on white': [coloured(WHITE, RED, BLUE), TWO, /white is the background/],
  'colours of 16 bits': [file(TWO.map((number) => [BLACK, RED, BLUE][number].map((value) => value * 257)), { depth: 16 }), TWO, /each of 2 colours/],
  'colours of the DAVIS palette': [file(TWO.map((number) => davisPalette()[number && number + 3])), TWO.map((number) => number && number + 3), /each of 2 colours/],
  'interlaced colours': [interlaced(TWO.map((number) => [BLACK, RED, BLUE][number])), TWO, /each of 2 colours/],
  'indices with black at the end': [indexed(TWO.map((number) => (number + 2) % 3), [RED, BLUE, BLACK]), TWO, /black is the background/],
  'what is not transparent': [file(ONE.map((is) => [90, 90, 90, is * 255])), ONE, /what is not transparent is the object/],
  'black that is not transparent': [file(ONE.map((is) => [0, is * 255])), ONE, /what is not transparent/],
  'a thing cut out of a picture': [file(ONE.map((is, p) => [(p * 7) % 251, (p * 11) % 241, (p * 13) % 239, is * 255])), ONE, /what is not transparent/],
  'colours on nothing': [file(TWO.map((number) => [...[BLACK, RED, BLUE][number], number > 0 ? 255 : 0])), TWO, /each of 2 colours/],
  'no object': [file(ONE.map(() => 0)), ONE.map(() => 0)],
};

const read = (bytes, name = 'f1.png') => readAnnotations([{ name, bytes }]);

describe('what a mask is taken for', () => {
  for (const [name, [bytes, labels, note]] of Object.entries(KINDS)) {
    test(name, () => {
      const { frames, notes } = read(bytes);
      assert.deepEqual([...frames.get('f1').read()], labels);
      assert.equal(notes.length, note ? 1 : 0, JSON.stringify(notes));
      if (!note) return;
      assert.match(notes[0].message, note);
      assert.match(notes[0].message, /^'f1\.png': /);
    });
  }

  for (const edge of [1.5, 9]) {
    test(`an edge of ${edge} pixels is an error, until somebody says what it is`, () => {
      const share = disc([22, 17], 12, edge);
      const greys = Array.from({ length: 256 }, (_, level) => [level, level, level]);
      const kinds = {
        grey: [mixed(share, [0], [255]), 128],
        'grey indices': [mixed(share, [0], [255]), 128, (pixels) => indexed(pixels.flat(), greys)],
        colours: [mixed(share, BLACK, RED), 100],
        'white background': [mixed(share, WHITE, RED), 0],
        alpha: [share.map((part) => [90, 90, 90, Math.round(255 * part)]), 128],
      };
      for (const [kind, [pixels, half, encoded = file]] of Object.entries(kinds)) {
        const bytes = encoded(pixels);
        assert.throws(() => read(bytes), { code: 'invalid-input', message: /^'f1\.png': it has \d+ (levels|colours) only between others, .* --levels 128 .* --levels exact/ }, kind);
        if (half === 0) continue;
        const { frames, notes, names } = readAnnotations([{ name: 'f1.png', bytes }], { levels: half });
        const wanted = pixels.map((pixel) => Number((kind === 'alpha' ? pixel[3] : Math.max(...pixel)) >= half));
        assert.deepEqual([[...frames.get('f1').read()], notes, names], [wanted, [], {}], kind);
      }
    });
  }

  test('levels between others that are numbers', () => {
    // A sliver of another object along the edges of one, which is white.
    const lined = TWO.map((number, p) => (number === 2 && (p % 48 === 26 || p % 48 === 39) ? 100 : number === 2 ? 255 : 0));
    assert.throws(() => read(file(lined)), /1 level only between others/);
    const { frames } = readAnnotations([{ name: 'f1.png', bytes: file(lined) }], { levels: 'exact' });
    assert.deepEqual([...frames.get('f1').read()], lined);
    for (const levels of [0, 'some', 65_536, 1.5]) assert.throws(() => readAnnotations([], { levels }), { code: 'invalid-option' });
  });

  /** Cells of 5 × 5 pixels, one for each number, in rows, beside each other or with ground between. */
  const cells = (numbers, gap) => picture((x, y) => (x % 6 < 6 - gap && y % 6 < 6 - gap ? (numbers[Math.floor(y / 6) * 8 + Math.floor(x / 6)] ?? 0) : 0));
  test('levels are numbers, whichever there are, beside each other or apart; small and thin objects are no edges', () => {
    const sets = [[3, 8, 15, 21, 34, 47, 59, 66, 78, 90, 103, 118, 127, 142, 155, 169, 203, 245, 250], Array.from({ length: 48 }, (_, k) => (k < 24 ? k + 1 : 207 + k))];
    const thin = TWO.map((number, p) => (p % 48 === 44 && p > 480 && p < 1200 ? 9 : p === 100 || p === 6 * 48 + 7 ? 5 : number));
    for (const labels of [thin, ...sets.flatMap((numbers) => [0, 1].map((gap) => cells(numbers, gap)))]) {
      for (const bytes of [file(labels), file(labels, { depth: 16 }), file(labels.map((level) => [level, level, level])), indexed(labels, davisPalette())]) {
        const { frames, notes } = read(bytes);
        assert.deepEqual([[...frames.get('f1').read()], notes], [labels, []]);
      }
    }
  });

  test('colours of 16 bits that 8 do not hold are refused, unless their brightness counts alone', () => {
    const colours = TWO.map((number) => [[0, 0, 0], [40_000, 0, 0], [40_001, 0, 0]][number]);
    const deep = (some, options) => readAnnotations([file(some, { depth: 16 })].map((bytes) => ({ name: 'f1.png', bytes })), options);
    for (const options of [{}, { levels: 'exact' }]) assert.throws(() => deep(colours, options), { code: 'invalid-input', message: /^'f1\.png': it has colours of 16 bits that 8 do not hold: save it with 8, or as grey levels/ });
    assert.deepEqual([...deep(colours, { levels: 100 }).frames.get('f1').read()], TWO.map((number) => Number(number > 0)));
  });

  test('numbers above 254, and in 16 bits 255, get others, and both are said', () => {
    const { frames, names, notes } = read(file(TWO.map((number, p) => [0, 300, 255][number] || (p < 48 ? 7 : 0)), { depth: 16 }));
    assert.deepEqual([...frames.get('f1').read()], TWO.map((number, p) => number || (p < 48 ? 7 : 0)));
    assert.deepEqual(names, { 1: '300', 2: '255' });
    assert.deepEqual(notes, [{ code: 'numbers-changed', message: "'f1.png': objects have other numbers here, each its own from 1 to 254: 300 is 1, 255 is 2" }]);
  });

  test('masks of frames that are scaled down are as large as these were', () => {
    const large = { width: 5000, height: 3 };
    const { size, frames } = read(encode({ ...large, channels: 1, depth: 8, data: new Uint8Array(15_000).fill(7, 0, 5000) }));
    assert.deepEqual([size, frames.get('f1').read()[4999], frames.get('f1').read()[5000]], [large, 7, 0]);
  });

  test('more objects than numbers, in one file and in all', () => {
    const many = { width: 144, height: 72 };
    const grid = (first) => Uint16Array.from({ length: many.width * many.height }, (_, p) => (p % 6 < 4 && Math.floor(p / 144) % 6 < 4 ? first + Math.floor(p / 864) * 24 + Math.floor((p % 144) / 6) : 0));
    const bytes = (first) => encode({ ...many, channels: 1, depth: 16, data: grid(first) });
    assert.throws(() => read(bytes(1)), { code: 'invalid-input', message: "'f1.png': it has more than 254 objects" });
  });

  test('folders of objects, with zeros, from 0, and full; numbers that are too large', () => {
    const masks = (folders) => readAnnotations(folders.map((folder, k) => ({ name: `masks/${folder}/f1.png`, bytes: file(TWO.map((number) => (number === k + 1 ? 255 : 0))) })));
    for (const folders of [['1', '2'], ['001', '002'], ['00001', '2']]) assert.deepEqual([...masks(folders).frames.get('f1').read()], TWO, folders.join());
    const zero = masks(['000', '001']);
    assert.deepEqual([...zero.frames.get('f1').read()], TWO.map((number) => [0, 2, 1][number]));
    assert.deepEqual([zero.names, zero.notes[0].code], [{ 2: '0' }, 'numbers-changed']);
    assert.deepEqual(masks(['1', '300']).names, { 2: '300' });
    const ground = masks(['0', '1']);
    assert.deepEqual([...ground.frames.get('f1').read()], TWO.map((number) => [0, 0, 1][number]));
    assert.match(ground.notes[0].message, /^'masks\/0\/f1\.png': folder 0 is the background/);
    const full = readAnnotations([{ name: 'masks/7/f1.png', bytes: file(ONE.map(() => 255)) }]);
    assert.deepEqual([...full.frames.get('f1').read()], ONE.map(() => 7));
  });

  test('255 alone is what the other files say', () => {
    for (const encoded of [file, (labels) => indexed(labels, davisPalette())]) {
      const sources = [TWO, ONE.map((is) => is * 255)].map((labels, k) => ({ name: `f${k}.png`, bytes: encoded(labels) }));
      const { frames, notes } = readAnnotations(sources);
      assert.deepEqual([...frames.get('f1').read()], ONE.map((is) => is * 255));
      assert.deepEqual(notes, [{ code: 'mask-white', message: "'f1.png': 255 says nothing: there are numbers of objects in other files" }]);
    }
  });

  test('a colour is one object in all files; what was assumed is said once', () => {
    const sources = [coloured(BLACK, RED, BLUE), coloured(BLACK, BLUE, RED)].map((bytes, k) => ({ name: `f${k}.png`, bytes }));
    const { frames, notes } = readAnnotations(sources);
    assert.deepEqual([...frames.get('f1').read()], TWO.map((number) => [0, 2, 1][number]));
    assert.deepEqual(notes.map(({ message }) => message), ["'f0.png' and 1 more: black is the background, each of 2 colours is an object"]);
  });

  const UNCLEAR = {
    'a picture': [file(picture((x, y) => [x * 5, y * 7, (x * y) % 251])), /it has 1\d+ colours only between others/],
    'colours without a background': [coloured([9, 9, 90], RED, BLUE), /neither black nor white/],
    'two objects that touch, smoothed': [file(mixed(picture((x) => Math.min(1, Math.max(0, (x - 22) / 4))), RED, BLUE).map((pixel, p) => (p < 6 * 48 ? BLACK : pixel))), /colours only between others/],
    'one level between black and white': [file(picture((x, y) => (x === y ? 128 : x > y ? 255 : 0))), /1 level only between others/],
  };
  for (const [name, [bytes, message]] of Object.entries(UNCLEAR)) {
    test(`${name}: nobody knows`, () => {
      assert.throws(() => read(bytes), (error) => error.code === 'invalid-input' && error.message.startsWith("'f1.png': it has ") && message.test(error.message));
    });
  }
});

describe('masks and the program', () => {
  const png = (is) => file(is.map((one) => one * 255));

  test('clip --masks says what it takes masks for, and tracks.json too', async (t) => {
    const { frames, out, path } = framesOf(t, 3, (k) => frame(k / 2, SIZE));
    const given = (folder, name, bytes) => {
      mkdirSync(dirname(path(folder, name)), { recursive: true });
      writeFileSync(path(folder, name), bytes);
    };
    const run = async (folder) => veronese(['clip', frames, '--quality', 'fast', '--masks', path(folder), '--out', out]);
    given('white', 'f0.png', png(ONE));
    given('one', 'f0.png', file(ONE));
    given('each', join('1', 'f0.png'), png(ONE));
    const white = await run('white');
    assert.deepEqual([white.code, white.stderr.replace(path('white'), '')], [0, "veronese: note: '/f0.png': 255 is the object, number 1, and 0 the background\n"]);
    assert.equal(tracksOf(out).notes[0].code, 'mask-white');
    const labels = labelsOf(out, 2);
    assert.deepEqual([...labelsOf(out, 0)].map((label) => Number(label === 1)), ONE);
    for (const folder of ['one', 'each']) {
      const { code, stderr } = await run(folder);
      assert.deepEqual([code, stderr], [0, '']);
      assert.deepEqual(labelsOf(out, 2), labels);
    }
  });

  test('clip --masks refuses PNM files of 16 bits, which would lose 8', async (t) => {
    const { frames, out, path } = framesOf(t, 3, (k) => frame(k / 2, SIZE));
    mkdirSync(path('masks'));
    writeFileSync(path('masks', 'f0.pgm'), Buffer.concat([Buffer.from(`P5 ${SIZE.width} ${SIZE.height} 65535\n`), Buffer.from(ONE.flatMap((is) => [0, is]))]));
    const { code, stderr } = await veronese(['clip', frames, '--quality', 'fast', '--masks', path('masks'), '--out', out]);
    assert.deepEqual([code, stderr.replace(path('masks'), '')], [1, "veronese: error: invalid-input: '/f0.pgm' has samples of 16 bits, and 8 of them would be lost: save it as PNG\n"]);
  });

  test('convert says what it takes them for, and writes numbers', async (t) => {
    const folder = temporaryFolder(t);
    const source = folder.file('a.png', coloured(BLACK, RED, BLUE));
    const { stdout, stderr } = await veronese(['convert', source, '--to', 'corrections', '--out', folder.path('out')]);
    assert.match(stderr, /^veronese: note: '.*a\.png': black is the background, each of 2 colours is an object\n$/);
    assert.equal(lines(stdout)[0].notes[0].code, 'mask-colours');
    assert.deepEqual([...decode(readFileSync(folder.path('out', 'a.png'))).data], TWO);
  });
});
