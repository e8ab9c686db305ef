//! Two frames are a clip: found, corrected, undone and kept like any other. The motions of the two are a view, which changes nothing.

import { type Page } from '@playwright/test';
import { encodePng } from 'veronese/codecs';

import { type Upload, chooseMotions, clipDone, clipFrames, differences, done, drag, expect, goTo, kept, labelsOnCanvas, masksOf, motionsChosen, openAdvanced, openEmpty, openExport, reloadEmpty, rename, said, shown, square, test, undoAll, upload, withoutStorage } from './support.js';

/** Frames of a square that moves right and down. */
function frames(count: number): Promise<Upload[]> {
  return Promise.all(Array.from({ length: count }, (_, k) => square(`f${k}.png`, 100, 64, 3 * k, k)));
}

/** Opens frames, which are segmented by themselves. */
async function openPair(page: Page, files: Upload[]): Promise<void> {
  await holdAutomatic(page);
  await upload(page, files);
  await expect(page.locator('#clip-name')).toHaveText('f0 and f1, 2 frames, 100 × 64');
  await clipDone(page);
}

/** The page without frames, with quality fast, where clips are segmented when they are opened. */
async function holdAutomatic(page: Page): Promise<void> {
  await openEmpty(page);
  await page.getByLabel('Segment a clip when it is opened').check();
}

const undo = (page: Page) => page.locator('#undo');

test('two frames have objects in both, which are corrected, undone and kept like those of a longer clip', async ({ page }) => {
  const files = await frames(4);
  const pair = files.slice(0, 2);
  await openPair(page, pair);
  await page.locator('#kinds [value=objects]').check();
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

  await test.step('replaced and put back, swapped, and after another pair it is as it was', async () => {
    const name = page.locator('#objects .motion-name').nth(1);
    for (const [k, clip] of [[3, 'f0 and f3'], [1, 'f0 and f1']] as const) {
      await page.locator('#inspect').evaluate((details) => void ((details as HTMLDetailsElement).open = true));
      await page.getByLabel('Replace the second frame').setInputFiles([files[k]!]);
      await expect(page.locator('#clip-name')).toContainText(clip);
      await done(page);
      await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', k === 1 ? 'done' : 'idle');
    }
    await expect(name).toHaveValue('Square');
    await page.locator('#swap').click();
    await expect(page.locator('#caption')).toHaveText('Frame 1');
    await expect(name).toHaveValue('Square');
    await page.locator('#swap').click();
    await upload(page, files.slice(2));
    await shown(page, 'first', 'f2.png');
    await upload(page, pair);
    await expect(name).toHaveValue('Square');
    await expect(undo(page)).toBeEnabled();
    await undoAll(page);
    expect(differences(await labelsOnCanvas(page), first)).toBe(0);
  });
});

test('the motions of two frames are a view: tools and undo are about the objects; what is chosen stays', async ({ page }) => {
  await openEmpty(page);
  await page.getByLabel('Segment a clip when it is opened').check();
  await upload(page, await clipFrames(2));
  await clipDone(page);
  await done(page);
  const rows = page.locator('#motions > li');
  await expect(page.locator('#look [value=motions]')).toBeChecked();
  expect(await rows.count()).toBeGreaterThan(2);
  await expect(rows.nth(1).locator('[type=color]')).toBeDisabled();
  await rows.nth(1).locator('.motion-name').dblclick({ position: { x: 12, y: 10 } });
  await expect(rows.nth(1).locator('.motion-name')).toHaveAttribute('readonly');

  await page.keyboard.press('b');
  await expect(page.locator('#look [value=objects]')).toBeChecked();
  await drag(page, [0.7, 0.2], [0.8, 0.2]);
  await said(page, /^Corrected/);
  await page.keyboard.press('g');
  await done(page);
  await expect(page.locator('#look [value=groups]')).toBeChecked();
  await page.keyboard.press('Control+z');
  await expect(page.locator('#look [value=objects]')).toBeChecked();
  await said(page, /^Undone/);
});

test('the status says how many motions or groups are found, and whether as many as asked', async ({ page }) => {
  await openEmpty(page);
  await upload(page, await frames(2));
  await shown(page, 'second', 'f1.png');
  const status = page.locator('#status');
  await page.evaluate(() => (location.hash = '#quality=fast&masks=motions&motions=10'));
  await done(page);
  const count = await page.locator('#motions > li').count();
  expect(count).toBeLessThan(10);
  await expect(status).toHaveText(/\. Of the 10 motions requested, only (one|\d) could be told apart\.$/);
  await chooseMotions(page, 2);
  await done(page);
  await expect(status).toHaveText(/^2 motions found in [\d.]+\sm?s, as requested\.$/);
  await page.locator('#look [value=groups]').check();
  await expect(status).toHaveText(/^One object found in [\d.]+\sm?s, with 2 motions as requested\.$/);
  // It is a number for these two frames.
  await openAdvanced(page);
  await upload(page, await frames(4));
  await expect(page.locator('#clip-name')).toContainText('4 frames');
  await done(page);
  await motionsChosen(page, 10);
});

test('where nothing is kept, leaving asks first only with unsaved corrections; the camera leaves a clip', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await withoutStorage(page);
  const files = await frames(2);
  await openPair(page, files);
  await page.locator('#kinds [value=objects]').check();
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

/** A textured thing of two parts that touch, before a textured ground: between the frames one part moves by 6 pixels, the other by 4.2. */
async function parts(name: string, t: number): Promise<Upload> {
  const [width, height] = [320, 240];
  const wave = (x: number, y: number, seed: number): number => 128 + 60 * Math.sin(0.31 * x + 0.17 * y + seed) + 50 * Math.cos(0.29 * y - 0.11 * x * seed);
  const pixels = new Uint8Array(width * height * 3);
  for (let p = 0; p < width * height; p++) {
    const [x, y] = [p % width, Math.floor(p / width)];
    const inside = (left: number, top: number, across: number, down: number): boolean => x >= left && x < left + across && y >= top && y < top + down;
    const upper = inside(100 + 6 * t, 60, 90, 70);
    const lower = inside(100 + 4.2 * t, 130, 90, 50);
    const [u, seed] = upper ? [x - 6 * t, 2] : lower ? [x - 4.2 * t, 3] : [x, 1];
    for (let c = 0; c < 3; c++) pixels[3 * p + c] = wave(u + 37 * c, y, seed);
  }
  return { name, mimeType: 'image/png', buffer: Buffer.from(await encodePng(width, height, pixels)) };
}

test('a part that moves by itself becomes an object of its own', async ({ page }) => {
  await holdAutomatic(page);
  await upload(page, [await parts('first.png', 0), await parts('second.png', 1)]);
  await clipDone(page);
  await done(page);
  const rows = page.locator('#motions > li');
  await expect(rows).toHaveCount(3);
  await expect(page.locator('#clip-status')).toHaveText('One object in 2 frames.'); // they touch
  const groups = await labelsOnCanvas(page);
  await rows.nth(2).locator('.motion-words').click();
  await rows.nth(2).getByText('More', { exact: true }).click();
  await rows.nth(2).getByRole('button', { name: 'Make an object of Object 2' }).click();
  await expect(page.locator('#clip-status')).toHaveText('Corrected: the masks of 2 frames have changed.');
  await expect(page.locator('#look [value=objects]')).toBeChecked();
  await expect(page.locator('#objects > .selected')).toHaveAttribute('data-mask', '2');
  const objects = await labelsOnCanvas(page);
  expect([...groups.keys()].filter((p) => (groups[p] === 2) !== (objects[p] === 2)).length).toBe(0);
  await goTo(page, 1);
  // It has gone on with its own motion.
  const [left, right] = [104, 194];
  const there = await labelsOnCanvas(page);
  const covered = Array.from({ length: right - left }, (_, k) => there[155 * 320 + left + k]).filter((object) => object === 2).length;
  expect(covered / (right - left)).toBeGreaterThan(0.9);
  await undo(page).click();
  await expect(page.locator('#clip-status')).toHaveText('Undone in 2 frames.');
  expect(await labelsOnCanvas(page)).not.toContain(2);
});
