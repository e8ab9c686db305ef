import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { decode, encode } from 'fast-png';
import { davisPalette } from 'veronese';
import { decodeImage, encodeColourPng, encodeGreyPng, encodeIndexedPng } from 'veronese/codecs';
import { bmp, frame, png, ppm, ramp, turnedJpeg } from './support/frames.mjs';
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
    const indexed = await decodeImage(await encodeIndexedPng(2, 1, Uint8Array.of(1, 2), davisPalette()));
    assert.deepEqual([...indexed.data], [128, 0, 0, 255, 0, 128, 0, 255]);
  });

  test('refuses every file that lost its end', async () => {
    const { data, width, height } = frame(0, { width: 37, height: 21 });
    const files = { png: png({ data, width, height }), bmp: bmp({ data, width, height }), ppm: ppm({ data, width, height }), ...ramp };
    for (const name of ['png', 'bmp', 'ppm', 'jpeg', 'webp']) {
      const file = files[name];
      // The last bytes of a PNG (checksums, IEND) and of a BMP (padding) carry no pixels.
      for (let length = 0; length < file.length - 25; length += 7) {
        const error = await failure(decodeImage(file.subarray(0, length)));
        assert.equal(error.code, 'unreadable-image', `${name}, ${length} of ${file.length} bytes: ${error.message}`);
      }
    }
  });

  test('damaged files end in a picture or in one of two errors, soon', async () => {
    const small = frame(0, { width: 24, height: 20 });
    const files = [png(small), bmp(small), ppm(small), ramp.jpeg, ramp.webp];
    let state = 1;
    const random = (n) => (state = (state * 48271) % 2147483647) % n;
    const started = performance.now();
    for (let i = 0; i < 1000; i++) {
      const file = Uint8Array.from(files[i % files.length]);
      for (let k = 0; k <= random(4); k++) file[random(Math.min(file.length, k % 2 ? file.length : 64))] = random(256);
      const outcome = await decodeImage(file).catch((error) => error);
      if ('code' in outcome) assert.match(outcome.code, /^(unreadable-image|frame-size-unsupported)$/, outcome.message);
      else assert.equal(outcome.data.length, outcome.width * outcome.height * 4);
    }
    assert.ok(performance.now() - started < 60_000);
  });

  test('refuses what is no file', async () => {
    for (const file of [undefined, null, 'a.png', [1, 2], new ArrayBuffer(3)]) {
      assert.equal((await failure(decodeImage(file))).code, 'invalid-input');
    }
  });
});

describe('encoders', () => {
  test('an indexed PNG reads back as indices and palette', async () => {
    const indices = Uint8Array.from({ length: 256 * 2 }, (_, i) => i % 256);
    const file = await encodeIndexedPng(256, 2, indices, davisPalette());
    assert.deepEqual([file[24], file[25]], [8, 3]);
    const image = decode(file);
    assert.deepEqual([...image.data], [...indices]);
    assert.deepEqual(image.palette.map((colour) => [...colour].slice(0, 3)), davisPalette());
  });

  test('grey, RGB and RGBA PNG read back', async () => {
    const bytes = (n) => Uint8Array.from({ length: n }, (_, i) => (i * 37) % 256);
    const cases = [[encodeGreyPng, 1], [encodeColourPng, 3], [encodeColourPng, 4]];
    for (const [encoder, channels] of cases) {
      const image = decode(await encoder(5, 3, bytes(15 * channels)));
      assert.deepEqual([image.width, image.height, image.channels, image.depth], [5, 3, channels, 8]);
      assert.deepEqual([...image.data], [...bytes(15 * channels)]);
    }
  });

  test('refuse what does not fit', async () => {
    const cases = [
      ['invalid-option', () => encodeGreyPng(3, 3, new Uint8Array(8))],
      ['invalid-option', () => encodeColourPng(3, 3, new Uint8Array(9))],
      ['invalid-option', () => encodeIndexedPng(1, 1, Uint8Array.of(5), davisPalette().slice(0, 5))],
      ['invalid-option', () => encodeIndexedPng(1, 1, Uint8Array.of(0), [])],
      ['invalid-input', () => encodeGreyPng(0, 3, new Uint8Array(0))],
      ['invalid-input', () => encodeGreyPng(1.5, 2, new Uint8Array(3))],
      ['invalid-input', () => encodeGreyPng(1, 1, 'grey')],
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
