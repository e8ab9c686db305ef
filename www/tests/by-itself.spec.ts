//! A clip of one's own is segmented by itself, and what is drawn with can be seen.

import { clipDone, expect, holdSamples, clipFrames, openSegmented, test, upload } from './support.js';

test('a clip of one\'s own is segmented when it is opened; a setting keeps it off, also at the next visit', async ({ page }) => {
  await holdSamples(page);
  await page.goto('./#sample=parallax&quality=fast');
  await upload(page, await clipFrames(4));
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 4 frames.');
  await expect(page.locator('#caption')).toHaveText('Frame 0');

  const automatic = page.getByLabel('Segment a clip when it is opened');
  await automatic.uncheck();
  await page.reload();
  await expect(automatic).not.toBeChecked();
  await upload(page, (await clipFrames(6)).slice(1));
  await expect(page.locator('#clip-name')).toContainText('5 frames');
  await expect(page.getByRole('button', { name: 'Segment the clip' })).toBeVisible();
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'idle');
  await automatic.check();
  await page.reload();
  await expect(automatic).toBeChecked();
});

test('what is selected is named beside the pointer, and painting with the background says what it does', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const [cursor, help] = [page.locator('#cursor'), page.locator('#tool-help')];
  // It rests there from now on.
  await page.locator('.layers').hover();
  await expect(cursor).toBeHidden();
  await page.keyboard.press('1');
  await page.keyboard.press('b');
  await expect(cursor).toHaveText('Object 1');
  await expect(cursor).toBeVisible();
  const colour = await page.locator('#objects > li').nth(1).evaluate((row) => row.style.getPropertyValue('--colour'));
  await expect(cursor).toHaveCSS('border-left-color', colour.replaceAll(' ', ', '));
  await page.keyboard.press('2');
  await expect(cursor).toHaveText('Object 2');
  await page.keyboard.press('x');
  await expect(cursor).toHaveText('New object');
  await page.keyboard.press('b');
  await page.locator('#objects > li').first().locator('.motion-name').click({ position: { x: 12, y: 10 } });
  await expect(help).toContainText('Background is selected: what you paint is taken away from objects.');
  await page.keyboard.press('e');
  await expect(help).toContainText('Background is selected, and cannot be erased: select an object first.');
  await page.locator('.layers').hover();
  await expect(cursor).toHaveText('Background');
});
