//! The page shows exactly what the package computes.

import { decodeImage } from 'veronese/codecs';

import { clipInNode, differences, expect, labelsOnCanvas, openEmpty, opened, pixelsOf, square, test, upload } from './support.js';

test('frames and masks are those of Node, with the settings of the page, and shown as is asked', async ({ page }) => {
  await openEmpty(page);
  // Numbers in names are compared by value. The odd size catches a wrong row length.
  const [second, first] = [await square('frame10.png', 161, 97, 3, 1), await square('frame9.png', 161, 97, 0, 0)];
  await upload(page, [second, first]);
  await opened(page, 'frame9 and frame10, 2 frames, 161 × 97');
  for (const quality of ['fast', 'best'] as const) {
    await page.locator(`#settings [value=${quality}]`).check();
    await page.locator('#clip-segment').click();
    await expect(page.locator('#clip-status')).toHaveText(/^One object in 2 frames/);
    expect(differences(await labelsOnCanvas(page), (await clipInNode([first, second], { quality }))[0]!)).toBe(0);
  }
  const shows = async ({ buffer }: typeof first): Promise<number> => differences((await pixelsOf(page, '#frame')).data, (await decodeImage(buffer)).data);
  expect(await shows(first)).toBe(0);
  await page.keyboard.down('f');
  expect(await shows(second)).toBe(0);
  await page.keyboard.up('f');
  expect(await shows(first)).toBe(0);

  // Visibility, solo, opacity and outlines change the picture.
  const all = await labelsOnCanvas(page);
  const row = page.locator('#objects > li').nth(1);
  await row.getByRole('checkbox', { name: 'Show Object 1' }).uncheck();
  expect(differences(await labelsOnCanvas(page), all.map(() => 0))).toBe(0);
  await row.getByRole('button', { name: 'Show only' }).click();
  expect(differences(await labelsOnCanvas(page), all)).toBe(0);
  await row.getByRole('button', { name: 'Show only' }).click();
  await row.getByRole('checkbox', { name: 'Show Object 1' }).check();
  expect(differences(await labelsOnCanvas(page), all)).toBe(0);
  const slider = page.getByRole('slider', { name: /Opacity/ });
  for (const opacity of [100, 0]) {
    await slider.fill(String(opacity));
    await expect(page.locator('#fill')).toHaveCSS('opacity', String(opacity / 100));
  }
  await page.getByLabel('Outlines').uncheck();
  await expect(page.locator('#outlines')).toBeHidden();
});
