//! Steps to other frames, which take time: what is done meanwhile is about the frame that is seen.

import { clipDone, clipFrames, differences, drag, expect, goTo, holdBack, labelsOnCanvas, openSegmented, said, test } from './support.js';

const [WIDTH, HEIGHT] = [100, 70];

test('a stroke that begins before the next frame is there belongs to the frame that is seen, from beginning to end', async ({ page }) => {
  await openSegmented(page, await clipFrames(6));
  await goTo(page, 2);
  await page.keyboard.press('p');
  await page.keyboard.press('1');
  await page.locator('#tools [name=radius]').fill('3');
  await page.keyboard.press('q'); // nothing but what is drawn changes
  const before = await labelsOnCanvas(page);
  const box = (await page.locator('.layers').boundingBox())!;
  const at = (x: number, y: number): [number, number] => [box.x + ((x + 0.5) / WIDTH) * box.width, box.y + ((y + 0.5) / HEIGHT) * box.height];
  const release = await holdBack(page, 'f04.png');
  await page.keyboard.press('.');
  await expect(page.getByRole('slider', { name: 'Current frame' })).toHaveAttribute('aria-valuenow', '3');
  await page.mouse.move(...at(10, 60));
  await page.mouse.down();
  await page.mouse.move(...at(30, 60), { steps: 4 });
  await release();
  await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 200))); // the frame has come
  await page.mouse.move(...at(50, 60), { steps: 4 });
  await page.mouse.up();
  await expect(page.locator('#caption')).toHaveText('Frame 3');
  await clipDone(page);
  await goTo(page, 2);
  const painted = (await labelsOnCanvas(page)).map((label, p) => Number(label !== before[p]));
  expect([10, 30, 50].map((x) => painted[60 * WIDTH + x])).toEqual([1, 1, 1]);
});

test('drawing stops a clip that is played', async ({ page }) => {
  await openSegmented(page, await clipFrames(6));
  await page.keyboard.press('p');
  await page.keyboard.press('1');
  await page.keyboard.press('q');
  const release = await holdBack(page, 'f03.png');
  await page.getByRole('button', { name: 'Play' }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  const before = await labelsOnCanvas(page);
  await drag(page, [0.1, 0.85], [0.3, 0.85]);
  await release();
  await said(page, /^Corrected/);
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
  await expect(page.locator('#caption')).toHaveText('Frame 2'); // it was on its way
  await goTo(page, 1);
  expect(differences(await labelsOnCanvas(page), before)).toBeGreaterThan(0);
});

test('what the page says stays while frames are stepped', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  await page.keyboard.press('1');
  await page.keyboard.press('p');
  await page.keyboard.press('Shift+L');
  await drag(page, [0.1, 0.85], [0.3, 0.85]);
  const sentence = page.locator('#notice-sentence');
  await expect(sentence).toHaveText('Object 1 is locked, so nothing changes it. Unlock it first.');
  await expect(page.locator('#tool-help [data-help=brush]')).toHaveText('Object 1 is locked, so nothing changes it. Unlock it first.');
  await page.keyboard.press('.');
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await expect(sentence).toBeVisible();
});

test('Backspace takes the corners of a polygon back, and then nothing', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  await page.keyboard.press('1');
  await page.keyboard.press('w');
  await drag(page, [0.1, 0.8], [0.1, 0.8]);
  await drag(page, [0.2, 0.8], [0.2, 0.8]);
  const corners = page.locator('.corners');
  await expect(corners).toHaveAttribute('d', /^(M[^M]+){2}$/);
  for (let k = 0; k < 4; k++) await page.keyboard.press('Backspace');
  await expect(corners).toHaveAttribute('d', '');
  await expect(page.locator('#objects > li')).toHaveCount(3);
  await expect(page.getByRole('button', { name: 'Undo' })).toBeDisabled();
  await page.keyboard.press('v');
  await page.keyboard.press('Backspace');
  await expect(page.locator('#objects > li')).toHaveCount(2);
});

test('a box may begin beside the picture; a press there is none', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await openSegmented(page, await clipFrames(4));
  await page.keyboard.press('x');
  const rows = page.locator('#objects > li');
  await drag(page, [-0.05, 0.5], [-0.05, 0.5]);
  await drag(page, [-0.05, 0.55], [0.12, 0.95]);
  await said(page, /^Corrected/);
  await expect(rows).toHaveCount(4);
  await clipDone(page);
  const at = (await labelsOnCanvas(page)).indexOf(3);
  expect(Math.floor(at / WIDTH)).toBeGreaterThanOrEqual(Math.floor(0.55 * HEIGHT));
});
