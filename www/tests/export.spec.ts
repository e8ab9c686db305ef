//! What is taken away besides the clip: its masks at the size of the files, the picture on screen, a link.

import { unzipSync } from 'fflate';
import { decodeImage } from 'veronese/codecs';

import { clipFrames, done, expect, openAdvanced, openClip, openEmpty, openExport, openSample, openSegmented, opened, pixelsOf, savedClip, segmentClip, square, test, upload } from './support.js';

test('frames larger than the working size are scaled down, and their masks exported at full size', async ({ page }) => {
  await openEmpty(page);
  await openAdvanced(page);
  await page.getByLabel('Working size').selectOption('640');
  await upload(page, [await square('a.png', 720, 405, 0, 0), await square('b.png', 720, 405, 6, 3)]);
  await opened(page, 'a and b, 2 frames, 720 × 405');
  expect((await pixelsOf(page, '#frame')).width).toBe(640);
  await segmentClip(page);
  const davis = unzipSync((await savedClip(page, 'DAVIS')).bytes);
  const { width, height } = await decodeImage(davis[Object.keys(davis).find((name) => name.endsWith('a.png'))!]!);
  expect([width, height]).toEqual([720, 405]);
  const coco = JSON.parse((await savedClip(page, 'COCO, RLE')).bytes.toString()) as { annotations: { bbox: number[]; attributes: { matrix: number[] } }[] };
  const { bbox, attributes } = coco.annotations[0]!;
  expect(bbox[2]! / 135).toBeCloseTo(1, 1); // a third of the height
  const [a11, a12, a13, a21, a22, a23] = attributes.matrix as [number, number, number, number, number, number];
  expect(a11 * 400 + a12 * 250 + a13).toBeCloseTo(6, 0);
  expect(a21 * 400 + a22 * 250 + a23).toBeCloseTo(3, 0);
});

test('the picture is copied, and a notice confirms a copy in view, on all screens', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await openSegmented(page, await clipFrames(2));
  await openExport(page);
  // Chromium decodes pictures for the clipboard in a process of its own, which a busy machine may refuse: users press again, too.
  await expect(async () => {
    await page.getByRole('button', { name: 'Copy picture' }).click();
    await expect(page.locator('#notice')).toContainText('Copied the picture to the clipboard.');
    const size = await page.evaluate(async () => {
      const [item] = await navigator.clipboard.read();
      const bitmap = await createImageBitmap(await item!.getType('image/png'));
      return [bitmap.width, bitmap.height];
    });
    expect(size).toEqual([100, 70]);
  }).toPass();

  const notice = page.locator('#notice');
  for (const [width, height] of [[1280, 860], [390, 780]] as const) {
    await page.setViewportSize({ width, height });
    await page.getByRole('button', { name: 'Dismiss' }).click();
    await openExport(page);
    await page.getByRole('button', { name: 'Copy link' }).click();
    await expect(notice).toBeInViewport({ ratio: 1 });
  }
  // A notice that is not an error disappears by itself.
  await page.mouse.move(1, 1); // it stays while the pointer is over it
  await expect(notice).toBeHidden();
});

test('a copied link opens the current sample with the same settings', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.goto('./#sample=parallax&motions=2&quality=fast&segment=asked');
  await done(page);
  const copied = async (): Promise<string> => {
    await page.evaluate(() => navigator.clipboard.writeText(''));
    await openExport(page);
    await page.getByRole('button', { name: 'Copy link' }).click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).not.toBe('');
    const link = await page.evaluate(() => navigator.clipboard.readText());
    await page.keyboard.press('Escape');
    return new URL(link).hash;
  };
  expect(await copied()).toBe('#sample=parallax&motions=2&quality=fast&segment=asked');
  await openSample(page, 'Two cars');
  await opened(page, '768 × 432');
  await page.getByLabel('Best').check();
  expect(await copied()).toBe('#sample=intel-two-cars&motions=2&segment=asked');
  await openClip(page, await clipFrames(2));
  expect(await copied()).toBe('#motions=2&quality=fast&segment=asked');
  // Also in a page that is open.
  await page.evaluate(() => (location.hash = '#sample=intel-two-cars&quality=best'));
  await opened(page, '768 × 432');
  await expect(page.getByLabel('Best')).toBeChecked();
});
