//! From frames to a file for CVAT, as the benchmark of annotators does it, with few actions.

import { readFileSync } from 'node:fs';

// @ts-expect-error: plain JavaScript, shared with the benchmark
import { masksOfCvat } from '../../scripts/lib/annotator/cvat.mjs';
// @ts-expect-error: plain JavaScript, shared with the benchmark
import { annotate } from '../../scripts/lib/annotator/expert.mjs';
// @ts-expect-error: plain JavaScript, shared with the benchmark
import { mean, overlap } from '../../scripts/lib/annotator/overlap.mjs';
// @ts-expect-error: plain JavaScript, shared with the benchmark
import { annotatedPage } from '../../scripts/lib/annotator/page.mjs';
import { clipFrames, expect, test } from './support.js';

const [WIDTH, HEIGHT, COUNT] = [200, 140, 6];

/** Masks of a shape in each frame, as `clipFrames` moves its disc and its square. */
function truthsOf(is: (disc: boolean, square: boolean, x: number, y: number) => boolean): Uint8Array[] {
  return Array.from({ length: COUNT }, (_, k) =>
    Uint8Array.from({ length: WIDTH * HEIGHT }, (_, p) => {
      const [x, y] = [p % WIDTH, Math.floor(p / WIDTH)];
      const disc = Math.hypot(x - 0.2 * WIDTH - 4 * k, y - 0.36 * HEIGHT - k) < 0.16 * HEIGHT;
      const square = Math.abs(x - 0.75 * WIDTH + 3 * k) < 0.12 * HEIGHT && Math.abs(y - 0.7 * HEIGHT) < 0.12 * HEIGHT;
      return Number(is(disc, square, x - 4 * k, y - k));
    }),
  );
}

const CASES: readonly { name: string; truths: Uint8Array[]; most: number; actions: readonly string[]; good: (found: number, j: number) => boolean }[] = [
  {
    name: 'pieces of one object are merged',
    truths: truthsOf((disc, square) => disc || square),
    most: 20,
    actions: ['open', 'segment', 'object 1', 'more', 'merge with 2', 'merge', 'accept all', 'export', 'save'],
    good: (_found, j) => j > 0.9,
  },
  {
    name: 'what is wrong is painted away, as far as there are actions',
    truths: truthsOf((disc, _square, x) => disc && x < 46),
    most: 9,
    actions: ['open', 'segment', 'key E', 'size', 'stroke', 'accept all', 'export', 'save'],
    good: (found, j) => j > found + 0.01,
  },
  {
    name: 'what was not found gets a box',
    truths: truthsOf((_disc, _square, x, y) => Math.abs(x - 120) < 12 && Math.abs(y - 40) < 12),
    most: 8,
    actions: ['open', 'segment', 'key X', 'box', 'accept all', 'export', 'save'],
    good: (found, j) => found < 0.1 && j > 0.15,
  },
];

for (const { name, truths, most, actions, good } of CASES) {
  test(name, { tag: '@soak' }, async ({ page }) => {
    const expert = await annotatedPage(page, './', 'quality=fast');
    const { path, id, found } = await annotate(expert, await clipFrames(COUNT, WIDTH, HEIGHT), truths, { width: WIDTH, most });
    expect(expert.log.filter((line: unknown) => typeof line === 'string')).toEqual(actions);
    await expect(page.locator('#reviewed')).toHaveText(`${COUNT} of ${COUNT} accepted`);
    const masks = masksOfCvat(readFileSync(path, 'utf8'), { width: WIDTH, height: HEIGHT, frames: COUNT }).get(id);
    const j = mean(truths.map((truth, k) => overlap(masks[k], truth)));
    console.log(`J ${found.toFixed(3)}, ${j.toFixed(3)} in the file`);
    expect(good(found, j)).toBe(true);
  });
}
