//! Zooming and panning.

import { type Page } from '@playwright/test';

import { PAIR, done, expect, test } from './support.js';

async function zoomShown(page: Page): Promise<number> {
  return Number((await page.locator('#zoom-value').textContent())!.replace(/[^\d.]/g, ''));
}

test('the picture is zoomed and panned', async ({ page }) => {
  await page.goto(`${PAIR}&segment=asked`);
  await done(page);
  const box = (await page.locator('.layers').boundingBox())!;
  const whole = await zoomShown(page);
  const place = async (): Promise<{ x: number; y: number; width: number }> => (await page.locator('#frame').boundingBox())!;

  // The point under the pointer stays there.
  const [x, y] = [box.x + 0.25 * box.width, box.y + 0.6 * box.height];
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -300);
  await expect.poll(() => zoomShown(page)).toBeGreaterThan(whole);
  const large = await place();
  expect((x - large.x) / large.width).toBeCloseTo(0.25, 2);

  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 4 });
  await page.mouse.up();
  expect((await place()).x).toBeCloseTo(large.x + 60, 0);

  await page.locator('#zoom-fit').click();
  expect(await zoomShown(page)).toBe(whole);
  await page.locator('#zoom-in').click();
  expect(Math.abs((await zoomShown(page)) - 1.5 * whole)).toBeLessThanOrEqual(1);
  await page.keyboard.press('0');
  expect(await zoomShown(page)).toBe(whole);
  for (let k = 0; k < 8; k++) await page.keyboard.press('+');
  await expect(page.locator('#grid')).toBeVisible();
  await expect(page.locator('#stage')).toHaveClass(/squares/);
  await page.locator('.layers').focus(); // elsewhere arrows step
  const before = await place();
  await page.keyboard.press('ArrowRight');
  expect((await place()).x).toBeLessThan(before.x);
  await page.keyboard.press('-');
  expect((await place()).width).toBeLessThan(before.width);

  await page.keyboard.press('0');
  // The zoom button shows the picture at 100 %.
  await page.setViewportSize({ width: 600, height: 800 });
  await expect.poll(() => zoomShown(page)).toBeLessThan(100);
  await page.locator('#zoom-value').click();
  expect(await zoomShown(page)).toBe(100);
  expect((await page.locator('#frame').boundingBox())!.width).toBeCloseTo(768, 0);
});
