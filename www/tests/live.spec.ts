//! The camera as a clip that never ends: an object keeps its number, and so its colour. Without a camera what is open stays.

import { type Page } from '@playwright/test';

import { clipFrames, done, expect, labelsOnCanvas, openClip, opened, test } from './support.js';

/**
 * Gives the page a camera before which a disc goes round in a circle, over a background that stands still; or none. The disc goes on by a
 * step whenever the page has taken a frame: on a busy machine it moves no further from one to the next.
 */
async function withCamera(page: Page, present: boolean): Promise<void> {
  await page.evaluate((present) => {
    const [width, height, steps] = [320, 240, 150];
    const texture = (x: number, y: number): number => 128 + 50 * Math.sin(0.31 * x + 0.12 * y) + 40 * Math.cos(0.17 * x - 0.33 * y);
    const picture = (size: readonly [number, number], grey: (x: number, y: number) => number, alpha: (x: number, y: number) => boolean): OffscreenCanvas => {
      const canvas = new OffscreenCanvas(...size);
      const image = new ImageData(...size);
      for (let p = 0; p < size[0] * size[1]; p++) {
        const [x, y] = [p % size[0], Math.floor(p / size[0])];
        image.data.set([grey(x, y), grey(x, y), grey(x, y), alpha(x, y) ? 255 : 0], 4 * p);
      }
      canvas.getContext('2d')!.putImageData(image, 0, 0);
      return canvas;
    };
    const ground = picture([width, height], texture, () => true);
    const disc = picture([72, 72], (x, y) => texture(1.7 * (x - 36) + 500, 1.7 * (y - 36)), (x, y) => Math.hypot(x - 36, y - 36) < 36);
    navigator.mediaDevices.getUserMedia = async () => {
      if (!present) throw new DOMException('Requested device not found', 'NotFoundError');
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      const context = canvas.getContext('2d')!;
      const stream = canvas.captureStream();
      let step = 0;
      const draw = (): void => {
        const angle = (2 * Math.PI * step) / steps;
        context.drawImage(ground, 0, 0);
        context.drawImage(disc, width / 2 + 60 * Math.cos(angle) - 36, height / 2 + 60 * Math.sin(angle) - 36);
      };
      const take = createImageBitmap.bind(window) as (...given: unknown[]) => Promise<ImageBitmap>;
      window.createImageBitmap = async (...given: unknown[]) => {
        const taken = await take(...given);
        if (given[0] instanceof HTMLVideoElement) {
          Object.assign(window, { taken: (step += 1) });
          draw();
        }
        return taken;
      };
      const start = (): void => {
        draw();
        if (step === 0) requestAnimationFrame(start);
      };
      start();
      return stream;
    };
  }, present);
}

test('a clip stays open if there is no camera; an object before one keeps its colour', async ({ page }) => {
  await openClip(page, await clipFrames(3, 96, 64));
  await withCamera(page, false);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#notice-code')).toHaveText('no-camera');
  await expect(page.locator('#timeline')).toBeVisible();
  await page.getByRole('button', { name: 'Step forward' }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await done(page);
  await page.locator('#notice-close').click();

  await withCamera(page, true);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live: [\d.]+ frames per second, one object\.$/);
  await expect(page.locator('#caption')).toHaveText('Camera');
  // The number of most pixels of the disc, whenever it is seen: in every third frame.
  const numbers: number[] = [];
  for (let look = 0, next = 0; look < 15; look++) {
    const taken = await page.waitForFunction((least) => {
      const { taken } = window as unknown as { taken: number };
      return taken >= least ? taken : null;
    }, next);
    next = (await taken.jsonValue())! + 3;
    const counts = new Map<number, number>();
    for (const label of await labelsOnCanvas(page)) if (label > 0) counts.set(label, (counts.get(label) ?? 0) + 1);
    const [most] = [...counts].sort(([, one], [, other]) => other - one);
    if (most !== undefined) numbers.push(most[0]);
  }
  expect(numbers.length).toBeGreaterThan(10);
  expect(new Set(numbers)).toEqual(new Set([1]));

  // The last two frames are a clip like any other.
  await page.getByRole('button', { name: 'Stop camera' }).click();
  await opened(page, 'camera');
  await expect(page.locator('#clip-name')).toContainText('2 frames, 320 × 240');
  await expect(page.locator('#caption')).toHaveText('Frame 0');
});
