//! Fill and outlines compared with their definitions, without a browser.

import { expect, test } from '@playwright/test';
import type { Segmentation } from 'veronese';

import { type Painting, fillOf, outlinesOf } from '../src/drawing/paint.js';
import { maskOf } from '../src/result/masks.js';

const WIDTH = 23;
const HEIGHT = 17;
const EVERYTHING: Painting = { kind: 'motions', hidden: new Set(), solo: null, colours: {} };

/** Blobs of labels 0 to 3 and a few pixels without a label; motions 1 and 2 are one group. */
function blobs(): Segmentation {
  const labels = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, i) => {
    const [x, y] = [i % WIDTH, Math.floor(i / WIDTH)];
    if (x === 11 && y < 4) return 255;
    if ((x - 6) ** 2 + (y - 6) ** 2 < 20) return 1;
    if ((x - 11) ** 2 + (y - 8) ** 2 < 16) return 2;
    return x > 18 || y > 14 ? 3 : 0;
  });
  const motions = [0, 1, 2, 3].map((label) => ({
    label,
    matrix: [0, 0, 0, 0, 0, 0] as Segmentation['motions'][number]['matrix'],
    pixels: labels.filter((other) => other === label).length,
    share: 0,
    residual: 0,
    bbox: [0, 0, WIDTH, HEIGHT] as [number, number, number, number],
    group: label < 2 ? label : label - 1,
  }));
  const settings = { motions: 'auto', quality: 'best', markUnknown: true, subject: false, software: '' } as const;
  return { version: 1, width: WIDTH, height: HEIGHT, count: 4, motions, labels, junctions: [], evidence: { candidates: [] }, unlabelled: 4, milliseconds: { total: 0 }, settings };
}

for (const kind of ['motions', 'groups'] as const) {
  for (const thickness of [1, 2, 5]) {
    test(`outlines of ${kind} have a dark edge and a light line, each ${thickness} thick`, () => {
      const scene = blobs();
      const { labels } = scene;
      const outlines = outlinesOf(scene, { ...EVERYTHING, kind }, thickness);
      const classAt = (x: number, y: number): number => maskOf(labels[y * WIDTH + x]!, scene, kind);
      for (let y = 0; y < HEIGHT; y++) {
        for (let x = 0; x < WIDTH; x++) {
          const own = classAt(x, y);
          let nearest = Infinity; // other mask along the row or column
          for (let d = -2 * thickness; d <= 2 * thickness; d++) {
            const other = (x + d >= 0 && x + d < WIDTH && classAt(x + d, y) !== own) || (y + d >= 0 && y + d < HEIGHT && classAt(x, y + d) !== own);
            if (other) nearest = Math.min(nearest, Math.abs(d));
          }
          const word = outlines[y * WIDTH + x]!;
          const brightness = word === 0 ? 'none' : (word & 255) + ((word >>> 8) & 255) + ((word >>> 16) & 255) < 100 ? 'dark' : 'light';
          const expected = own === 0 || nearest > 2 * thickness ? 'none' : nearest <= thickness ? 'dark' : 'light';
          expect(brightness, `(${x}, ${y})`).toBe(expected);
        }
      }
    });
  }
}

test('painting row by row gives the same picture', () => {
  const scene = blobs();
  const rows = Array.from({ length: HEIGHT }, (_, y) => y);
  expect(rows.flatMap((y) => [...fillOf(scene, EVERYTHING, y, y + 1)])).toEqual([...fillOf(scene, EVERYTHING)]);
  expect(rows.flatMap((y) => [...outlinesOf(scene, EVERYTHING, 2, y, y + 1)])).toEqual([...outlinesOf(scene, EVERYTHING, 2)]);
});
