//! Failures are reported in a sentence, and the page stays usable.

import { type Page } from '@playwright/test';

import { expect, labelsOnCanvas, openEmpty, opened, segmentClip, square, test, upload } from './support.js';

let count = 0;

/** The page still segments. */
async function expectToWork(page: Page): Promise<void> {
  const name = `works-${++count}.png`; // not one that is on screen already
  await upload(page, [await square('a.png', 96, 64, 0, 0), await square(name, 96, 64, 2, 0)]);
  await opened(page, `a and ${name.replace('.png', '')}, 2 frames, 96 × 64`);
  await segmentClip(page);
  await expect(page.getByRole('alert')).toBeHidden();
  expect((await labelsOnCanvas(page)).length).toBe(96 * 64);
}

test('what cannot be read or segmented is rejected, and the page goes on', async ({ page }) => {
  await openEmpty(page);
  const a = await square('a.png', 96, 64, 0, 0);
  await expectToWork(page);

  await test.step('a broken file is reported, and the open pair stays', async () => {
    await upload(page, [{ name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('this is not an image') }, a]);
    await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image that this browser can read.');
    await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
    await expect(page.locator('#clip-name')).toContainText('a and works-1');
    await expect(page.locator('#objects > li')).not.toHaveCount(0);
    await expectToWork(page);
  });

  await test.step('frames that differ in size, or are too small, are rejected with the message of the package', async () => {
    await upload(page, [a, await square('b.png', 64, 96, 0, 0)]);
    await opened(page, 'a and b');
    await page.getByRole('button', { name: 'Segment the clip' }).click();
    await expect(page.getByRole('alert')).toContainText('the frames differ in size: 96×64 and 64×96 pixels.');
    await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
    await expect(page.locator('#motions-empty')).toBeVisible();
    await expectToWork(page);
    await expect(page.locator('#motions-empty')).toBeHidden();
    const dot = await square('dot.png', 1, 1, 0, 0);
    await upload(page, [dot, { ...dot, name: 'dot2.png' }]);
    await opened(page, 'dot and dot2');
    await page.getByRole('button', { name: 'Segment the clip' }).click();
    await expect(page.locator('#notice-code')).toHaveText('frame-size-unsupported');
    await expectToWork(page);
  });
});

test('a missing sample is reported, and files can still be opened', async ({ page, context }) => {
  await context.route('**/samples/**', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await page.goto('./');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#invitation')).toBeVisible();
  await expectToWork(page);
});
