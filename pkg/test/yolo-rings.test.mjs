// The one ring of a YOLO label, filled as Ultralytics fills it (vertices as whole pixels, the outline drawn too) and by pixel centres.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { encode } from 'veronese/formats';
import { random } from '../../scripts/lib/random.mjs';
import { filled, intersectionOverUnion, maskOf } from './support/masks.mjs';

/** Labels of rectangles [left, top, right, bottom, label], the later on top. */
function image(width, height, ...rectangles) {
  const labels = new Uint8Array(width * height);
  for (const [left, top, right, bottom, label] of rectangles) {
    for (let y = top; y < bottom; y++) labels.fill(label, y * width + left, y * width + right);
  }
  return { labels, width, height };
}

/** By label the vertices of its ring, pixels. */
async function ringsOf({ labels, width, height }, options) {
  const [{ content: text }, { content: names }] = await encode('yolo', { labels, width, height }, { labels: [1, 2], ...options });
  return text.trimEnd().split('\n').map((line) => {
    const [number, ...shares] = line.split(' ').map(Number);
    assert.ok(shares.every((share) => share >= 0 && share <= 1));
    const points = Array.from({ length: shares.length / 2 }, (_, k) => [shares[2 * k] * width, shares[2 * k + 1] * height]);
    return { label: Number(names.split('\n')[number].slice(7)), points };
  });
}

/** Pixels in a ring as Ultralytics fills it: vertices are whole pixels, and the lines of the outline are drawn too. */
function whole(points, { width, height }) {
  const own = points.map((point) => point.map((value) => Math.trunc(Math.fround(value))));
  const inside = filled([own.flat()], { width, height }, 0);
  own.forEach(([x, y], k) => {
    const [nextX, nextY] = own[(k + 1) % own.length];
    const steps = Math.max(Math.abs(nextX - x), Math.abs(nextY - y), 1);
    for (let step = 0; step <= steps; step++) inside[Math.round(y + ((nextY - y) * step) / steps) * width + Math.round(x + ((nextX - x) * step) / steps)] = 1;
  });
  return inside;
}

/** A ring with an island, a touch at a corner and a lone pixel far away; bars, lines and borders. */
const PARTS = image(120, 80, [10, 10, 50, 50, 1], [20, 20, 40, 40, 0], [28, 28, 32, 32, 1], [90, 5, 91, 6, 1], [51, 50, 53, 52, 1], [50, 50, 51, 51, 1],
  [70, 60, 110, 70, 2], [70, 72, 110, 75, 2], [60, 10, 61, 40, 2], [0, 79, 120, 80, 2], [119, 0, 120, 80, 2]);

describe('rings of YOLO', () => {
  for (const tolerance of [0, 0.5]) {
    test(`parts far apart, with tolerance ${tolerance}: IoU as Ultralytics draws them`, async () => {
      for (const { label, points } of await ringsOf(PARTS, { tolerance })) {
        const drawn = intersectionOverUnion(whole(points, PARTS), maskOf(PARTS.labels, label));
        assert.ok(drawn >= 0.95, `label ${label}: ${drawn}`);
        const exact = intersectionOverUnion(filled([points.flat()], PARTS), maskOf(PARTS.labels, label));
        assert.ok(tolerance > 0 ? exact > 0.99 : exact === 1, `label ${label}: ${exact}`);
      }
    });
  }

  test('one part is drawn as it is, whatever its corners are', async () => {
    const next = random(3);
    for (let round = 0; round < 20; round++) {
      const some = Array.from({ length: 6 }, () => [Math.floor(next() * 12), Math.floor(next() * 12)]);
      // All have the middle.
      const one = image(40, 30, ...some.map(([left, top]) => [left, top, left + 16 + (top % 5), top + 13 + (left % 4), 1]));
      const [{ points }] = await ringsOf(one);
      assert.equal(intersectionOverUnion(whole(points, one), one.labels), 1);
      assert.equal(intersectionOverUnion(filled([points.flat()], one), one.labels), 1);
    }
  });

  test('the ring begins on the largest part, and bridges are short', async () => {
    const three = image(100, 20, [2, 1, 3, 2, 1], [10, 2, 40, 18, 1], [44, 2, 60, 18, 1]);
    const [{ points: [first, ...points] }] = await ringsOf(three);
    assert.deepEqual(first.map(Math.round), [10, 2]);
    const longest = Math.max(...points.map(([x, y], k) => Math.hypot(x - (points[k - 1] ?? first)[0], y - (points[k - 1] ?? first)[1])));
    assert.ok(longest < 31, `${longest}`);
  });
});
