//! Many objects: they are found in the list, and handled together. What is for the first visit makes way for them.

import type { Page } from '@playwright/test';
import { encode } from 'veronese/formats';

import { clipDone, clipFrames, expect, goTo, openClip, openSegmented, said, test, upload } from './support.js';

const COUNT = 20;

/** A clip with so many objects: squares side by side, from a file of masks. */
async function openMany(page: Page): Promise<void> {
  await openSegmented(page, await clipFrames(4));
  await goTo(page, 1);
  const [width, height] = [100, 70];
  const labels = Uint8Array.from({ length: width * height }, (_, p) => {
    const [x, y] = [p % width, Math.floor(p / width)];
    const cell = 5 * Math.floor(y / 17.5) + Math.floor(x / 20);
    return x % 20 > 3 && y % 17.5 > 3 ? cell + 1 : 0;
  });
  await upload(page, [{ name: 'f01.png', mimeType: 'image/png', buffer: Buffer.from((await encode('davis', { labels, width, height }))[0]!.content) }]);
  await said(page, /^Corrected/);
  await expect(page.locator('#objects > li')).toHaveCount(1 + COUNT);
}

/** The row of the object in the list, whole and in sight. */
function inSight(page: Page, row: number): Promise<boolean> {
  return page.locator('#objects > li').nth(row).evaluate((item) => {
    const [inner, outer] = [item.getBoundingClientRect(), item.parentElement!.getBoundingClientRect()];
    return inner.top >= outer.top - 1 && inner.bottom <= outer.bottom + 1;
  });
}

test('the object that is selected in the picture, or is new, is scrolled into view; all others are locked, hidden, deleted at once', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await openMany(page);
  expect(await inSight(page, COUNT)).toBe(false);
  // The last one is at the lower right.
  const box = (await page.locator('.layers').boundingBox())!;
  await page.locator('.layers').click({ position: { x: 0.92 * box.width, y: 0.9 * box.height } });
  const last = page.locator('#objects > li').last();
  await expect(last).toHaveClass(/selected/);
  expect(await inSight(page, COUNT)).toBe(true);
  await page.keyboard.press('1');
  expect(await inSight(page, 1)).toBe(true);
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#objects > li')).toHaveCount(2 + COUNT);
  expect(await inSight(page, 1 + COUNT)).toBe(true);
  expect(await page.evaluate(() => scrollY)).toBe(0);

  // Eight rows and eight lanes are seen.
  await page.keyboard.press('1');
  const seen = (await Promise.all(Array.from({ length: COUNT }, (_, k) => inSight(page, k)))).filter(Boolean);
  expect(seen.length).toBeGreaterThanOrEqual(6); // one of them has its actions, as high as two
  const tracks = (await page.locator('.tracks').boundingBox())!;
  const lanes = page.locator('#lane-names > li');
  const eighth = (await lanes.nth(7).boundingBox())!;
  expect(eighth.y + eighth.height).toBeLessThanOrEqual(tracks.y + tracks.height + 1);
  await expect(page.locator('#frame')).toBeInViewport({ ratio: 0.9 });

  await page.keyboard.press('v');
  await page.keyboard.press('3');
  const row = page.locator('#objects > .selected');
  await row.locator('summary').click();
  await expect(row.getByText('All others')).toBeVisible();
  const shown = page.locator('#objects [data-action=show]:checked:not([hidden])');
  await row.getByRole('button', { name: 'Hide all objects but Object 3' }).click();
  await expect(shown).toHaveCount(1);
  await row.getByRole('button', { name: 'Lock all objects but Object 3' }).click();
  await expect(page.locator('#objects [data-action=lock][aria-pressed=true]')).toHaveCount(COUNT - 1);
  await page.keyboard.press('Control+z');
  await expect(page.locator('#objects [data-action=lock][aria-pressed=true]')).toHaveCount(0);
  await row.getByRole('button', { name: 'Delete all objects but Object 3' }).click();
  await clipDone(page);
  await expect(page.locator('#objects > li')).toHaveCount(2); // and the background
  await expect(page.locator('#objects .motion-name').last()).toHaveValue('Object 3');
  await page.keyboard.press('Control+z');
  await expect(page.locator('#objects > li')).toHaveCount(1 + COUNT);
});

test('samples fold away once there are frames of one\'s own, and stay if they are unfolded', async ({ page }) => {
  await openClip(page, await clipFrames(3));
  const parallax = page.getByRole('button', { name: 'Parallax' });
  await expect(parallax).toBeHidden();
  await page.locator('#welcome > summary').click();
  await expect(parallax).toBeVisible();
  await upload(page, await clipFrames(4));
  await expect(page.locator('#clip-name')).toContainText('4 frames');
  await expect(parallax).toBeVisible();
});
