// The reader of label images: every filter that an encoder may choose, and files that are damaged.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { decode } from 'fast-png';
import { davisPalette } from 'veronese';
import { encodePng } from 'veronese/codecs';
import { decodeIndices } from '../build/formats/png-reader.js';
import { davisPng } from '../build/formats/pictures.js';
import { random } from '../../scripts/lib/random.mjs';
import { pngOf } from './support/chunks.mjs';
import { png } from './support/frames.mjs';
import { labelImages } from './support/masks.mjs';

/** The prediction of a byte, by the number of the filter, as the PNG specification has it. */
const PREDICTED = [
  () => 0,
  (left) => left,
  (left, above) => above,
  (left, above) => Math.floor((left + above) / 2),
  (left, above, corner) => {
    const estimate = left + above - corner;
    return [left, above, corner].reduce((best, value) => (Math.abs(estimate - value) < Math.abs(estimate - best) ? value : best));
  },
];

/** Row y has filter `filters[y % filters.length]`; the data are in two chunks. */
function filtered({ labels, width, height }, filters) {
  const at = (x, y) => (x < 0 || y < 0 ? 0 : labels[y * width + x]);
  const rows = [];
  for (let y = 0; y < height; y++) {
    const filter = filters[y % filters.length];
    rows.push(filter);
    for (let x = 0; x < width; x++) rows.push((at(x, y) - PREDICTED[filter](at(x - 1, y), at(x, y - 1), at(x - 1, y - 1))) & 255);
  }
  const data = deflateSync(Buffer.from(rows));
  const parts = [data.subarray(0, 7), data.subarray(7)].map((part) => ['IDAT', part]);
  return pngOf([width, height, 8, 3], ['PLTE', Buffer.alloc(768)], ...parts);
}

const next = random(5);
const noise = { labels: Uint8Array.from({ length: 31 * 17 }, () => next() * 256), width: 31, height: 17 };

test('every filter', () => {
  for (const filters of [[0], [1], [2], [3], [4], [4, 3, 2, 1, 0]]) {
    for (const image of [noise, ...labelImages(20)]) {
      const { labels, width, height } = decodeIndices(filtered(image, filters));
      assert.deepEqual({ labels, width, height }, image);
    }
  }
});

test('what the encoders of the package write', async () => {
  for (const { labels, width, height } of [noise, ...labelImages(20)]) {
    const file = await encodePng(width, height, labels, { palette: davisPalette() });
    assert.deepEqual(decodeIndices(file).labels, labels);
    assert.deepEqual(decode(file).palette.map((colour) => [...colour].slice(0, 3)), davisPalette());
    assert.deepEqual(decodeIndices(davisPng(labels, width, height)).labels, labels);
  }
});

test('other pictures and damaged ones are refused', () => {
  const file = filtered(noise, [4]);
  const changed = (at, value) => Buffer.from(file).fill(value, at, at + 1);
  const refused = (bytes, code) => assert.throws(() => decodeIndices(bytes), { name: 'VeroneseError', code });
  for (let length = 0; length < file.length - 16; length += 5) refused(file.subarray(0, length), 'unreadable-image');
  // In the header: the name, the height, the depth, the colour type and the interlacing.
  refused(changed(12, 0), 'unreadable-image');
  refused(changed(23, 16), 'unreadable-image');
  refused(changed(23, 18), 'unreadable-image');
  refused(changed(20, 1), 'unreadable-image');
  for (const [at, value] of [[24, 4], [25, 2]]) refused(changed(at, value), 'invalid-input');
  for (const at of [26, 27, 28]) refused(changed(at, 1), 'unreadable-image');
  refused(filtered({ ...noise, height: 0 }, [0]), 'unreadable-image');
  refused(filtered(noise, [0]).fill(9, 41 + 768 + 20, 41 + 768 + 30), 'unreadable-image');
  refused(png({ data: new Uint8ClampedArray(16), width: 2, height: 2 }), 'invalid-input');
});
