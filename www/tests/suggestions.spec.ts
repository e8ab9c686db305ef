//! The page asks whether neighbouring masks belong together, and does what is answered.

import { type Page } from '@playwright/test';

import { encodeColourPng } from 'veronese/codecs';
import { type Upload, axe, differences, enter, expect, labelsOnCanvas, mergeWith, openEmpty, segmentedInNode, shown, test, upload } from './support.js';

const [WIDTH, HEIGHT] = [320, 240];

/** A textured thing of two parts that touch, before a textured ground: between the frames one part moves by 6 pixels, the other by 4.2. */
async function parts(name: string, t: number): Promise<Upload> {
  const wave = (x: number, y: number, seed: number): number => 128 + 60 * Math.sin(0.31 * x + 0.17 * y + seed) + 50 * Math.cos(0.29 * y - 0.11 * x * seed);
  const pixels = new Uint8Array(WIDTH * HEIGHT * 3);
  for (let p = 0; p < WIDTH * HEIGHT; p++) {
    const [x, y] = [p % WIDTH, Math.floor(p / WIDTH)];
    const inside = (left: number, top: number, width: number, height: number): boolean => x >= left && x < left + width && y >= top && y < top + height;
    const upper = inside(100 + 6 * t, 60, 90, 70);
    const lower = inside(100 + 4.2 * t, 130, 90, 50);
    const [u, seed] = upper ? [x - 6 * t, 2] : lower ? [x - 4.2 * t, 3] : [x, 1];
    for (let c = 0; c < 3; c++) pixels[3 * p + c] = wave(u + 37 * c, y, seed);
  }
  return { name, mimeType: 'image/png', buffer: Buffer.from(await encodeColourPng(WIDTH, HEIGHT, pixels)) };
}

/** Opens the page with the thing of two parts. */
async function openParts(page: Page): Promise<void> {
  await openEmpty(page, 'groups');
  await upload(page, [await parts('first.png', 0), await parts('second.png', 1)]);
  await shown(page, 'second', 'second.png');
}

/** Where the list of masks ends: it stays where it is when a suggestion is dismissed. */
async function placeOfList(page: Page): Promise<number> {
  return page.evaluate(() => document.querySelector('#motions > :last-child')!.getBoundingClientRect().bottom + scrollY);
}

test('two parts of one object are joined by a suggestion, with undo; it uses the names of masks, and is about groups', async ({ page }) => {
  const { motions, junctions } = await segmentedInNode(await parts('first.png', 0), await parts('second.png', 1));
  expect(motions.map(({ group }) => group)).toEqual([0, 1, 2]);
  expect(junctions.find(({ labels }) => labels.join() === '1,2')!.likelihood).toBeGreaterThan(0.35);

  await openParts(page);
  const [suggestions, rows] = [page.locator('#suggestions > li'), page.locator('#motions > li')];
  await expect(suggestions).toHaveText([/^Object 2 may belong to Object 1/]);
  const found = await labelsOnCanvas(page);
  await suggestions.getByRole('button', { name: 'Join: Object 2 may belong to Object 1' }).click();
  await expect(page.locator('#status')).toHaveText('Merged.');
  await expect(rows).toHaveCount(2);
  await expect(suggestions).toHaveCount(0);
  expect(differences(await labelsOnCanvas(page), found.map((mask) => (mask === 2 ? 1 : mask)))).toBe(0);
  await page.locator('#undo').click();
  await expect(rows).toHaveCount(3);
  await expect(suggestions).toHaveCount(1);
  await page.locator('#redo').click();
  await expect(suggestions).toHaveCount(0);

  await page.locator('#undo').click();
  const name = page.locator('#motions > li').nth(1).locator('.motion-name');
  await enter(name, 'Robot');
  await expect(suggestions).toHaveText([/^Object 2 may belong to Robot/]);
  await page.locator('#look [value=motions]').check({ force: true });
  await expect(suggestions).toHaveCount(0);
  await page.locator('#look [value=groups]').check({ force: true });
  await expect(suggestions).toHaveCount(1);

  await test.step('it is a line that axe finds nothing wrong with, wide and narrow, light and dark', async () => {
    await page.emulateMedia({ reducedMotion: 'reduce' });
    const suggestion = suggestions.first();
    for (const [width, height, colorScheme] of [[1280, 860, 'light'], [390, 844, 'dark']] as const) {
      await page.setViewportSize({ width, height });
      await page.emulateMedia({ colorScheme });
      await suggestion.scrollIntoViewIfNeeded();
      expect(await axe(page)).toEqual([]);
      expect((await suggestion.boundingBox())!.height).toBeLessThan(70);
      expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
    }
  });

  await test.step('it is answered with the keyboard, and read out', async () => {
    const asked = page.locator('#suggestions');
    await expect(asked).toHaveAttribute('aria-live', 'polite');
    await asked.getByRole('button', { name: 'Join' }).focus();
    await page.keyboard.press('Tab');
    await expect(asked.getByRole('button', { name: 'Dismiss: Object 2 may belong to Robot' })).toBeFocused();
    const before = await placeOfList(page);
    await page.keyboard.press('Enter');
    await expect(asked.locator('li')).toHaveCount(0);
    expect(await placeOfList(page)).toBe(before);
    await expect(page.locator('#motions > li')).toHaveCount(3);
    // The focus is not lost with the button.
    await expect(page.locator('#motions-title')).toBeFocused();
    // Dismissed is dismissed, also after other corrections.
    const row = page.locator('#motions > li').nth(1);
    await row.getByText('More', { exact: true }).click();
    await mergeWith(row, 0);
    await page.locator('#undo').click();
    await expect(page.locator('#motions > li')).toHaveCount(3);
    await expect(asked.locator('li')).toHaveCount(0);
  });
});
