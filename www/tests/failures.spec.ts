//! Failures are reported in a sentence, and the page stays usable.

import { type Page } from '@playwright/test';

import { clipFrames, clipPhase, expect, labelsOnCanvas, openClip, opened, segmentClip, square, test, upload } from './support.js';

/** The page still segments. */
async function expectToWork(page: Page, name: string): Promise<void> {
  await upload(page, (await clipFrames(2, 96, 64)).map((frame, k) => ({ ...frame, name: `${name}${k}.png` })));
  await opened(page, `${name}0 and ${name}1, 2 frames, 96 × 64`);
  await expect(page.getByRole('alert')).toBeHidden();
  await segmentClip(page);
  expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
}

test('what cannot be read or segmented is rejected, with the message of the package', async ({ page }) => {
  const a = await square('a.png', 96, 64, 0, 0);
  await openClip(page, [a, await square('b.png', 96, 64, 2, 0)]);
  await upload(page, [{ name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('this is not an image') }, a]);
  await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image that this browser can read.');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#clip-name')).toHaveText('a and b, 2 frames, 96 × 64');

  await upload(page, [a, await square('tall.png', 64, 96, 0, 0)]);
  await opened(page, 'a and tall');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.getByRole('alert')).toContainText('96×64 and 64×96 pixels.');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
  await clipPhase(page, 'failed');
  await expect(page.locator('#clip-status')).toHaveText('The clip could not be segmented to its end. 0 of 2 frames have masks.');
  await expectToWork(page, 'e');

  const dot = await square('dot.png', 1, 1, 0, 0);
  await upload(page, [dot, { ...dot, name: 'dot2.png' }]);
  await opened(page, 'dot and dot2');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#notice-code')).toHaveText('frame-size-unsupported');
  await expectToWork(page, 'g');
});

test('a missing sample is reported, and files can still be opened', async ({ page, context }) => {
  await context.route('**/samples/**', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await page.goto('./#quality=fast&segment=asked');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#invitation')).toBeVisible();
  await expectToWork(page, 'f');
});
