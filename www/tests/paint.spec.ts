//! Fill and outlines compared with their definitions, without a browser.

import { expect, test } from '@playwright/test';

import { type Painting, fillOf, outlinesOf } from '../src/drawing/paint.js';
import type { Labels } from '../src/result/masks.js';

const [width, height] = [23, 17];
const EVERYTHING: Painting = { hidden: new Set(), solo: null, colours: {} };

/** Blobs of labels 0 to 3 and a few pixels without a label. */
const SCENE: Labels = {
  width,
  height,
  labels: Uint8Array.from({ length: width * height }, (_, i) => {
    const [x, y] = [i % width, Math.floor(i / width)];
    if (x === 11 && y < 4) return 255;
    if ((x - 6) ** 2 + (y - 6) ** 2 < 20) return 1;
    if ((x - 11) ** 2 + (y - 8) ** 2 < 16) return 2;
    return x > 18 || y > 14 ? 3 : 0;
  }),
};

for (const thickness of [1, 2, 5]) {
  test(`outlines have a dark edge and a light line, each ${thickness} thick`, () => {
    const outlines = outlinesOf(SCENE, EVERYTHING, thickness);
    const labelAt = (x: number, y: number): number => SCENE.labels[y * width + x]!;
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const own = labelAt(x, y);
        let nearest = Infinity; // other mask along the row or column
        for (let d = -2 * thickness; d <= 2 * thickness; d++) {
          const other = (x + d >= 0 && x + d < width && labelAt(x + d, y) !== own) || (y + d >= 0 && y + d < height && labelAt(x, y + d) !== own);
          if (other) nearest = Math.min(nearest, Math.abs(d));
        }
        const word = outlines[y * width + x]!;
        const brightness = word === 0 ? 'none' : (word & 255) + ((word >>> 8) & 255) + ((word >>> 16) & 255) < 100 ? 'dark' : 'light';
        const expected = own === 0 || nearest > 2 * thickness ? 'none' : nearest <= thickness ? 'dark' : 'light';
        expect(brightness, `(${x}, ${y})`).toBe(expected);
      }
    }
  });
}

test('painting row by row gives the same picture', () => {
  const rows = Array.from({ length: height }, (_, y) => y);
  expect(rows.flatMap((y) => [...fillOf(SCENE, EVERYTHING, y, y + 1)])).toEqual([...fillOf(SCENE, EVERYTHING)]);
  expect(rows.flatMap((y) => [...outlinesOf(SCENE, EVERYTHING, 2, y, y + 1)])).toEqual([...outlinesOf(SCENE, EVERYTHING, 2)]);
});
