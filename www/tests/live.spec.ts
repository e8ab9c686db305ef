//! The camera as a clip that never ends: an object keeps its number, and so its colour.

import { rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import config from '../playwright.config.js';
import { done, expect, labelsOnCanvas, open, test } from './support.js';

const [WIDTH, HEIGHT] = [320, 240];
/** The file is played again from its first frame, which follows the last one. */
const FRAMES = 150;
const FILE = join(tmpdir(), `veronese-camera-${process.pid}.y4m`);

/** A disc goes round in a circle, before a background that stands still. */
function frame(k: number): Buffer {
  const pixels = Buffer.alloc((WIDTH * HEIGHT * 3) / 2, 128);
  const angle = (2 * Math.PI * k) / FRAMES;
  const [cx, cy] = [WIDTH / 2 + 60 * Math.cos(angle), HEIGHT / 2 + 60 * Math.sin(angle)];
  const texture = (x: number, y: number): number => 128 + 50 * Math.sin(0.31 * x + 0.12 * y) + 40 * Math.cos(0.17 * x - 0.33 * y);
  for (let y = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++) {
      const inside = Math.hypot(x - cx, y - cy) < 36;
      pixels[y * WIDTH + x] = inside ? texture(1.7 * (x - cx) + 500, 1.7 * (y - cy)) : texture(x, y);
    }
  }
  return Buffer.concat([Buffer.from('FRAME\n'), pixels]);
}

const { launchOptions } = config.use!;
test.use({ launchOptions: { ...launchOptions, args: [...launchOptions!.args!, `--use-file-for-fake-video-capture=${FILE}`] } });

test.beforeAll(async () => {
  await writeFile(FILE, Buffer.concat([Buffer.from(`YUV4MPEG2 W${WIDTH} H${HEIGHT} F20:1 Ip A1:1 C420jpeg\n`), ...Array.from({ length: FRAMES }, (_, k) => frame(k))]));
});

test.afterAll(() => rm(FILE, { force: true }));

test('an object before the camera keeps its colour', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await open(page, 'groups');
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: [\d.]+ frames per second, one object\.$/);
  await expect(page.locator('#kinds')).toBeHidden();
  // The number of most pixels of the disc, whenever it is seen.
  const numbers: number[] = [];
  await expect(async () => {
    const counts = new Map<number, number>();
    for (const label of await labelsOnCanvas(page)) if (label > 0) counts.set(label, (counts.get(label) ?? 0) + 1);
    const [most] = [...counts].sort(([, one], [, other]) => other - one);
    if (most !== undefined) numbers.push(most[0]);
    expect(numbers.length).toBeGreaterThan(10);
  }).toPass({ intervals: [150] });
  expect(new Set(numbers)).toEqual(new Set([1]));

  // The last two frames stay as a pair like any other, with the kind of masks that was chosen before.
  await page.getByRole('button', { name: 'Stop camera' }).click();
  await done(page);
  await expect(page.locator('#look [value=groups]')).toBeChecked();
  await expect(page.locator('[data-slot=second] .slot-name')).toContainText('camera');
  await expect(page.locator('#motions .motion-name').first()).toHaveValue('Background');
});
