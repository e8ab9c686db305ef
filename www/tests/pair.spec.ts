//! Two frames are a clip: found, corrected, undone and kept like any other.

import { type Page } from '@playwright/test';

import { type Upload, clipDone, differences, drag, expect, kept, labelsOnCanvas, masksOf, openEmpty, openExport, opened, reloadEmpty, rename, said, square, test, undoAll, upload, withoutStorage } from './support.js';

/** Frames of a square that moves right and down. */
function frames(count: number): Promise<Upload[]> {
  return Promise.all(Array.from({ length: count }, (_, k) => square(`f${k}.png`, 100, 64, 3 * k, k)));
}

/** Opens two frames, which are segmented by themselves with quality `fast`. */
async function openPair(page: Page, files: Upload[]): Promise<void> {
  await openEmpty(page);
  await page.getByLabel('Segment a clip when it is opened').check();
  await upload(page, files);
  await expect(page.locator('#clip-name')).toHaveText('f0 and f1, 2 frames, 100 × 64');
  await clipDone(page);
}

const undo = (page: Page) => page.locator('#undo');

test('two frames have objects in both, which are corrected, undone and kept like those of a longer clip', async ({ page }) => {
  const files = await frames(4);
  const pair = files.slice(0, 2);
  await openPair(page, pair);
  await expect(page.locator('#clip-status')).toHaveText('One object in 2 frames.');
  const [second, first] = (await masksOf(page, [1, 0])) as [Uint8Array, Uint8Array];
  expect([first, second].map((labels) => new Set(labels).size)).toEqual([2, 2]);

  await test.step('they are kept before anything is done', async () => {
    await kept(page);
    await reloadEmpty(page);
    await upload(page, pair);
    await expect(page.locator('#clip-status')).toHaveText('Continued: one object in 2 frames.');
    expect((await masksOf(page, [1, 0])).map((labels, k) => differences(labels, [second, first][k]!))).toEqual([0, 0]);
  });

  await test.step('a stroke is carried to the other frame; undo and redo, also after a reload', async () => {
    await page.locator('#tools [value=brush]').check();
    await drag(page, [0.75, 0.2], [0.85, 0.25]);
    await said(page, /^Corrected/);
    const at = Math.round(0.225 * 64) * 100 + 80;
    expect((await labelsOnCanvas(page))[at]).toBe(1);
    await rename(page, 1, 'Square');
    await page.keyboard.press('Control+z');
    await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Object 1');
    await kept(page);

    await reloadEmpty(page);
    await upload(page, pair);
    await expect(undo(page)).toBeEnabled();
    await page.keyboard.press('Control+z');
    await said(page, /^Undone in /);
    expect(differences(await labelsOnCanvas(page), first)).toBe(0);
    await page.keyboard.press('Control+y');
    expect((await labelsOnCanvas(page))[at]).toBe(1);
    await page.keyboard.press('Control+y');
    await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Square');
  });

  await test.step('after another pair it is as it was', async () => {
    await upload(page, files.slice(2));
    await opened(page, 'f2 and f3');
    await upload(page, pair);
    await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Square');
    await expect(undo(page)).toBeEnabled();
    await undoAll(page);
    expect([await page.locator('#caption').textContent(), differences(await labelsOnCanvas(page), first)]).toEqual(['Frame 0', 0]);
  });
});

test('where nothing is kept, leaving asks first only with unsaved corrections; the camera leaves a clip', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await withoutStorage(page);
  const files = await frames(2);
  await openPair(page, files);
  const asks = (): Promise<boolean> => page.evaluate(() => !window.dispatchEvent(new Event('beforeunload', { cancelable: true })));
  expect(await asks()).toBe(false);
  await rename(page, 1, 'Square');
  expect(await asks()).toBe(true);
  await openExport(page);
  await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save clip' }).click()]);
  await expect.poll(asks).toBe(false);
  await page.keyboard.press('Escape');
  await rename(page, 1, 'Box');
  await page.getByLabel('Segment a clip when it is opened').uncheck();
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#status')).toHaveText(/^Live/);
  expect(await asks()).toBe(true);
  await page.getByRole('button', { name: 'Stop camera' }).click();
  await expect(page.locator('#clip-name')).toHaveText(/^camera 1 and camera 2,/);
  await upload(page, files);
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Box');
});
