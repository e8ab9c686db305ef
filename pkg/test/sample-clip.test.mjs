// The clip that opens the page: `veronese clip` finds its two cars, each whole and under one number, while they are in the picture.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { decode } from 'fast-png';
import { temporaryFolder, veronese } from './support/program.mjs';

const FRAMES = fileURLToPath(new URL('../../www/public/samples/passing-cars/frames/', import.meta.url));
const SIZE = { width: 512, height: 288 };

/** Outlines of the cars in some frames, drawn by hand without their shadows and mirrors: x and y of each corner. */
const OUTLINES = {
  22: {
    white: [101, 0, 173, 0, 172, 26, 169, 66, 166, 94, 164, 123, 150, 134, 126, 137, 97, 134, 86, 126, 83, 100, 84, 80, 90, 51, 94, 34],
    red: [221, 197, 221, 189, 237, 181, 266, 176, 297, 181, 313, 190, 317, 211, 321, 243, 329, 274, 329, 288, 219, 288, 219, 229],
  },
  32: {
    white: [
      91, 57, 101, 50, 123, 48, 149, 50, 160, 56, 163, 80, 166, 106, 161, 137, 161, 160, 158, 200, 157, 237, 146, 249, 134, 254, 83, 254, 66, 243,
      61, 226, 61, 197, 67, 171, 71, 131, 80, 91, 86, 71,
    ],
    red: [
      216, 104, 217, 99, 226, 94, 251, 89, 283, 91, 299, 100, 302, 120, 310, 151, 316, 183, 319, 211, 320, 251, 317, 271, 306, 281, 237, 281,
      226, 269, 221, 237, 217, 186, 217, 137,
    ],
  },
  44: {
    white: [66, 183, 71, 175, 86, 169, 106, 168, 131, 170, 146, 176, 151, 189, 156, 217, 157, 243, 154, 274, 154, 288, 43, 288, 50, 251, 57, 217],
    red: [
      211, 17, 213, 11, 237, 4, 263, 6, 280, 11, 284, 26, 291, 54, 299, 83, 301, 109, 301, 134, 291, 144, 257, 149, 234, 147, 221, 140, 216, 120,
      214, 86, 211, 43,
    ],
  },
};
/** Pixels of its outline that carry a car's number: nearly all. */
const WHOLE = 0.97;

/** The indices of the pixels whose centres are inside. */
function inside(outline) {
  const corners = Array.from({ length: outline.length / 2 }, (_, k) => [outline[2 * k], outline[2 * k + 1]]);
  const pixels = [];
  for (let p = 0; p < SIZE.width * SIZE.height; p++) {
    const [x, y] = [(p % SIZE.width) + 0.5, Math.floor(p / SIZE.width) + 0.5];
    const crossed = corners.filter(([ax, ay], k) => {
      const [bx, by] = corners.at(k - 1);
      return ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay);
    });
    if (crossed.length % 2 === 1) pixels.push(p);
  }
  return pixels;
}

for (const quality of ['fast', 'best']) {
  test(`both cars are found whole, with one number each, in quality ${quality}`, async (t) => {
    const out = temporaryFolder(t).path('out');
    const { code, stderr } = await veronese(['clip', FRAMES, '--quality', quality, '--out', out], { timeout: 300_000 });
    assert.equal(code, 0, stderr);
    const { frames, objects } = JSON.parse(readFileSync(`${out}/tracks.json`, 'utf8'));
    assert.equal(frames.length, 51);
    assert.equal(objects.length, 2);
    // The white car comes first; both are there until the end, without a gap.
    for (const [object, latest] of [[objects[0], 6], [objects[1], 14]]) {
      assert.ok(object.first <= latest, `object ${object.id} is found from frame ${object.first} on`);
      assert.equal(object.last, 50);
      assert.equal(object.frames.length, 51 - object.first);
    }
    for (const [index, cars] of Object.entries(OUTLINES)) {
      const { data: labels, width, height } = decode(readFileSync(`${out}/labels/${index}.png`));
      assert.deepEqual({ width, height }, SIZE);
      for (const [car, { id }] of [['white', objects[0]], ['red', objects[1]]]) {
        const pixels = inside(cars[car]);
        const share = pixels.filter((p) => labels[p] === id).length / pixels.length;
        assert.ok(share >= WHOLE, `${car} car, frame ${index}: ${share.toFixed(4)} of it has number ${id}`);
      }
    }
  });
}
