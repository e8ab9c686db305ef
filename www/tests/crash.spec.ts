//! The page is closed in the middle of the work, without a word: what was said and kept is there, and goes on.

import { type Page } from '@playwright/test';

import { clipDone, clipFrames, differences, drag, expect, holdSamples, labelsOnCanvas, masksOf, openSegmented, kept, test } from './support.js';

const COUNT = 5;

/** A page that opens with the last work. */
async function again(page: Page): Promise<Page> {
  const next = await page.context().newPage();
  await page.close();
  await holdSamples(next);
  await next.goto('./#quality=fast&segment=asked');
  await expect(next.locator('#clip-name')).toContainText(`${COUNT} frames`);
  return next;
}

/** Paints the k-th object, beside what is found. */
async function paint(page: Page, k: number): Promise<void> {
  await page.getByRole('button', { name: 'New object' }).click();
  await page.locator('#tools [name=radius]').fill('2');
  await expect(page.locator('#strokes .brush')).toBeAttached();
  const [x, y] = [0.05 + 0.09 * k, k % 2 === 0 ? 0.06 : 0.94];
  await drag(page, [x, y], [x + 0.03, y]);
}

for (const [strokes, tag] of [[3, ''], [10, '@soak']] as const) {
  test(`closing the page twice for each of ${strokes} strokes loses none of them`, { tag: tag === '' ? [] : [tag] }, async ({ page: first }) => {
    let page = await first.context().newPage();
    await openSegmented(page, await clipFrames(COUNT));
    await kept(page);
    let seed = 7;
    const random = (below: number): number => (seed = (seed * 16_807) % 2_147_483_647) % below;
    for (let k = 0; k < strokes; k++) {
      await paint(page, k);
      await kept(page);
      for (let times = 0; times < 2; times++) {
        await page.waitForTimeout(random(400));
        page = await again(page);
      }
      await expect(page.locator('#objects > li')).toHaveCount(3 + k + 1);
    }
    await clipDone(page);
    const after = await masksOf(page, [0, COUNT - 1]);

    // The same strokes without a crash.
    await page.close();
    const other = await first.context().newPage();
    await other.addInitScript(() => delete (window as { indexedDB?: unknown }).indexedDB);
    await openSegmented(other, await clipFrames(COUNT));
    await other.locator('#notice-close').click(); // it keeps nothing, and says so over the picture
    for (let k = 0; k < strokes; k++) {
      await paint(other, k);
      await expect(other.locator('#objects > li')).toHaveCount(3 + k + 1);
      await clipDone(other);
    }
    expect((await masksOf(other, [0, COUNT - 1])).map((labels, k) => differences(labels, after[k]!))).toEqual([0, 0]);
    // Each is a step.
    for (let k = 0; k < strokes; k++) await other.keyboard.press('Control+z');
    await expect(other.locator('#undo')).toBeDisabled();
    expect(new Set(await labelsOnCanvas(other)).size).toBe(3);
    await other.close();
  });
}
