// Decoding and encoding of pictures as the package calls them. What a file may be is tested in src/codecs.rs.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { decode, encode } from 'fast-png';
import { davisPalette } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';
import { glue } from '../build/entries/glue-codecs.js';
import { chunk, pngOf } from './support/chunks.mjs';
import { bmp, frame, png, ppm, ramp, turnedJpeg } from './support/frames.mjs';
import { stopwatch } from './support/processor.mjs';
import { failure } from './support/shapes.mjs';

/** The pixels of `ramp` as a function of (x, y). */
function rampPixels(width, height, colour) {
  const data = [];
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) data.push(...colour(x, y), 255);
  return data;
}

describe('decodeImage', () => {
  test('reads PNG, BMP and PNM to the pixels that were written', async () => {
    const { data, width, height } = frame(0, { width: 37, height: 21 });
    for (const file of [png, bmp, ppm]) {
      const picture = await decodeImage(file({ data, width, height }));
      assert.deepEqual([picture.width, picture.height], [37, 21]);
      assert.deepEqual([...picture.data], [...data], file.name);
    }
  });

  test('reads WebP exactly and JPEG closely', async () => {
    const expected = rampPixels(ramp.width, ramp.height, ramp.colour);
    const webp = await decodeImage(ramp.webp);
    assert.deepEqual([webp.width, webp.height], [24, 20]);
    assert.deepEqual([...webp.data], expected);
    const jpeg = await decodeImage(ramp.jpeg);
    assert.deepEqual([jpeg.width, jpeg.height], [24, 20]);
    const error = expected.reduce((sum, value, i) => sum + Math.abs(value - jpeg.data[i]), 0) / expected.length;
    assert.ok(error < 5, `mean difference ${error}`);
  });

  test('reads a JPEG to its own end, and of a damaged one what is allowed', async () => {
    const plain = await decodeImage(ramp.jpeg);
    for (const tail of [[0xff, 0xd9, 0xff, 0xda], [0xff, 0xd8, 0xff, 0xda, 0xff, 0xd9], [0xff], [...ramp.jpeg]]) {
      assert.deepEqual(await decodeImage(Uint8Array.from([...ramp.jpeg, ...tail])), plain);
    }
    // The scan lost its second half, and the file has its end.
    const scan = ramp.jpeg.findLastIndex((byte, at) => byte === 0xda && ramp.jpeg[at - 1] === 0xff);
    const cut = Uint8Array.from([...ramp.jpeg.subarray(0, scan + Math.floor((ramp.jpeg.length - scan) / 2)), 0xff, 0xd9]);
    assert.match((await failure(decodeImage(cut))).message, /JPEG file of which a part is missing or damaged/);
    const { width, height } = await decodeImage(cut, { allowDamaged: true });
    assert.deepEqual([width, height], [24, 20]);
    for (const options of [3, { allowDamaged: 1 }, { range: [1] }, { range: [0, 65_536] }, { damaged: true }]) {
      assert.equal((await failure(decodeImage(cut, options))).code, 'invalid-option');
    }
  });

  test('takes samples of 16 bits in the range that is asked for', async () => {
    const file = encode({ width: 3, height: 1, channels: 1, depth: 16, data: Uint16Array.of(1000, 1510, 1255) });
    const dark = await decodeImage(file);
    assert.deepEqual(dark.range, [1000, 1510]);
    const { data } = await decodeImage(file, { range: dark.range });
    assert.deepEqual([data[0], data[4], data[8], data[3]], [0, 255, 128, 255]);
    assert.equal((await decodeImage(png(frame(0)))).range, undefined);
  });

  test('applies an Exif orientation', async () => {
    const plain = await decodeImage(ramp.jpeg);
    const turned = await decodeImage(turnedJpeg());
    assert.deepEqual([turned.width, turned.height], [20, 24]);
    // A quarter turn clockwise: what was at (x, y) is at (height − 1 − y, x).
    for (const [x, y] of [[0, 0], [23, 0], [5, 11], [23, 19]]) {
      const from = 4 * (y * 24 + x);
      const to = 4 * (x * 20 + (19 - y));
      assert.deepEqual([...turned.data.subarray(to, to + 4)], [...plain.data.subarray(from, from + 4)]);
    }
  });

  test('reads grey, grey with alpha, palette and 16-bit PNG', async () => {
    const grey = await decodeImage(encode({ width: 2, height: 1, channels: 1, data: Uint8Array.of(7, 200) }));
    assert.deepEqual([...grey.data], [7, 7, 7, 255, 200, 200, 200, 255]);
    const alpha = await decodeImage(encode({ width: 1, height: 1, channels: 2, data: Uint8Array.of(9, 128) }));
    assert.deepEqual([...alpha.data], [9, 9, 9, 128]);
    const deep = await decodeImage(encode({ width: 1, height: 1, channels: 3, depth: 16, data: Uint16Array.of(0, 65535, 32896) }));
    assert.deepEqual([...deep.data], [0, 255, 128, 255]);
    const indexed = await decodeImage(await encodePng(2, 1, Uint8Array.of(1, 2), { palette: davisPalette() }));
    assert.deepEqual([...indexed.data], [128, 0, 0, 255, 0, 128, 0, 255]);
  });

  test('damaged files end in a picture or in one of two errors, soon', async () => {
    const small = frame(0, { width: 24, height: 20 });
    const files = [png(small), bmp(small), ppm(small), ramp.jpeg, ramp.webp];
    let state = 1;
    const random = (n) => (state = (state * 48271) % 2147483647) % n;
    const seconds = stopwatch();
    for (let i = 0; i < 1000; i++) {
      const file = Uint8Array.from(files[i % files.length]);
      for (let k = 0; k <= random(4); k++) file[random(Math.min(file.length, k % 2 ? file.length : 64))] = random(256);
      const outcome = await decodeImage(file).catch((error) => error);
      if ('code' in outcome) assert.match(outcome.code, /^(unreadable-image|frame-size-unsupported)$/, outcome.message);
      else assert.equal(outcome.data.length, outcome.width * outcome.height * 4);
    }
    assert.ok(seconds() < 60, `${seconds()} s`);
  });
});

describe('a file costs the memory of its pixels, whatever else it carries', () => {
  const MIB = 2 ** 20;
  const module = new WebAssembly.Module(readFileSync(new URL('../wasm/codecs/veronese_codecs_bg.wasm', import.meta.url)));
  const plain = png(frame(0, { width: 64, height: 64 }));
  const zeros = deflateSync(Buffer.alloc(512 * MIB), { level: 9 });
  const header = plain.subarray(0, 33);
  const decoded = (file) => glue.decodeImage(file, false, new Uint16Array());
  const decodes = (file) => assert.deepEqual(decoded(file), decoded(plain));
  const cases = {
    'a colour profile of 512 MB': [Buffer.concat([header, chunk('iCCP', Buffer.concat([Buffer.from('name\0\0'), zeros])), plain.subarray(33)]), decodes],
    'pixels after the last row': [Buffer.concat([header, chunk('IDAT', zeros), chunk('IEND', Buffer.alloc(0))]), () => {}],
    'a PNG of enormous sides': [pngOf([30_000, 30_000, 8, 6], ['IDAT', zeros]), (file) => assert.throws(() => decoded(file), { code: 'frame-size-unsupported', message: /30000.*both sides must be between 16 and 4096 pixels$/ })],
  };
  for (const [title, [file, check]] of Object.entries(cases)) {
    test(title, async () => {
      glue.forgetInstance();
      const { memory } = await glue.instantiate(module);
      check(new Uint8Array(file));
      assert.ok(memory.buffer.byteLength <= 8 * MIB, `${memory.buffer.byteLength / MIB} MiB`);
    });
  }
});

describe('encoders', () => {
  test('grey, RGB and RGBA PNG read back', async () => {
    const bytes = (n) => Uint8Array.from({ length: n }, (_, i) => (i * 37) % 256);
    for (const channels of [1, 3, 4]) {
      const image = decode(await encodePng(5, 3, bytes(15 * channels)));
      assert.deepEqual([image.width, image.height, image.channels, image.depth], [5, 3, channels, 8]);
      assert.deepEqual([...image.data], [...bytes(15 * channels)]);
    }
  });

  test('refuse what does not fit', async () => {
    const cases = [
      ['invalid-option', () => encodePng(3, 3, new Uint8Array(8))],
      ['invalid-option', () => encodePng(3, 3, new Uint8Array(18))],
      ['invalid-option', () => encodePng(3, 3, new Uint8Array(27), { palette: davisPalette() })],
      ['invalid-option', () => encodePng(3, 3, new Uint8Array(9), davisPalette())],
      ['invalid-option', () => encodePng(1, 1, Uint8Array.of(5), { palette: davisPalette().slice(0, 5) })],
      ['invalid-option', () => encodePng(1, 1, Uint8Array.of(0), { palette: [] })],
      ['invalid-input', () => encodePng(0, 3, new Uint8Array(0))],
      ['invalid-input', () => encodePng(1.5, 2, new Uint8Array(3))],
      ['invalid-input', () => encodePng(1, 1, 'grey')],
    ];
    for (const [code, call] of cases) assert.equal((await failure(call())).code, code);
  });
});

test('the DAVIS palette: VOC colours with 191 for 192, grey from 22 on', () => {
  const colours = davisPalette();
  assert.equal(colours.length, 256);
  const start = [
    [0, 0, 0], [128, 0, 0], [0, 128, 0], [128, 128, 0], [0, 0, 128], [128, 0, 128], [0, 128, 128], [128, 128, 128],
    [64, 0, 0], [191, 0, 0], [64, 128, 0], [191, 128, 0], [64, 0, 128], [191, 0, 128], [64, 128, 128], [191, 128, 128],
    [0, 64, 0], [128, 64, 0], [0, 191, 0], [128, 191, 0], [0, 64, 128], [128, 64, 128],
  ];
  assert.deepEqual(colours.slice(0, 22), start);
  for (let k = 22; k < 256; k++) assert.deepEqual(colours[k], [k, k, k]);
});
