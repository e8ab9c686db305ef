//! A correction while it spreads through a clip: it is told of and can be taken back, and objects with a name or a lock stay.
//! What waits for it: `carrying.spec.ts`.

import { type Page } from '@playwright/test';

import { type Place, clipFrames, differences, drag, enter, expect, goTo, kept, labelsOnCanvas, masksOf, openSegmented, reopen, said, test } from './support.js';

const [WIDTH, HEIGHT] = [100, 70];
/** Pixels of the picture, as shares of it. */
const at = (x: number, y: number): Place => [x / WIDTH, y / HEIGHT];
const pixelAt = (x: number, y: number): number => y * WIDTH + x;

/** The centre of the disc of `clipFrames` in frame 2. */
const [X, Y] = [28, 27];

/** A new object, to be painted with a brush of 3 pixels in frame 2. */
async function selectNew(page: Page): Promise<void> {
  await goTo(page, 2);
  await page.getByRole('button', { name: 'New object' }).click();
  await page.locator('#tools [name=radius]').fill('3');
}

test('a correction tells how far it has spread, and Escape takes it back, and nothing else', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const [status, undo] = [page.locator('#clip-status'), page.locator('#undo')];
  await page.locator('#objects > [data-mask="2"] .thumbnail').click();
  await page.keyboard.press('Delete');
  await said(page, /^Corrected/);
  const before = await masksOf(page, [0, 2]);
  await selectNew(page);

  // In one task with the first change.
  await page.locator('#clip-detail').evaluate((detail) => {
    const observer = new MutationObserver(() => {
      if (detail.textContent === '') return;
      observer.disconnect();
      document.body.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true }));
    });
    observer.observe(detail, { childList: true, characterData: true, subtree: true });
  });
  await drag(page, at(X - 6, Y - 4), at(X + 3, Y + 4));
  await expect(status).toHaveText('Undone.');
  await expect(page.locator('#clip-cancel')).toBeHidden();
  expect((await masksOf(page, [0, 2])).map((labels, k) => differences(labels, before[k]!))).toEqual([0, 0]);

  await page.evaluate(() => {
    const told: string[] = [];
    const [run, status, detail, cancel] = ['#clip-run', '#clip-status', '#clip-detail', '#clip-cancel'].map((name) => document.querySelector<HTMLElement>(name)!);
    new MutationObserver(() => {
      if (run!.dataset.phase === 'working' && detail!.textContent !== '') told.push(`${status!.textContent} ${detail!.textContent} ${cancel!.hidden}`);
    }).observe(detail!, { childList: true, characterData: true, subtree: true });
    Object.assign(window, { told });
  });
  await drag(page, at(X - 6, Y - 4), at(X + 3, Y + 4));
  await said(page, /^Corrected/);
  const told = await page.evaluate(() => (window as unknown as { told: string[] }).told);
  const counts = told.map((text) => Number(/^Carrying your correction to other frames… (\d+) of 4 frames(?:, about \d+\u00a0s left)? false$/.exec(text)?.[1]));
  expect(counts).toEqual(counts.toSorted((one, other) => one - other));
  expect(counts.at(-1)).toBe(4);
  expect((await labelsOnCanvas(page))[pixelAt(X, Y)]).toBe(3);
  // The one before is a step of its own.
  await undo.click();
  await undo.click();
  await expect(undo).toBeDisabled();
});

test('corrections of others leave objects with a name as they are; a lock is set with the keyboard, undone, and kept', async ({ page }) => {
  const files = await clipFrames(4);
  await openSegmented(page, files);
  const [status, notice] = [page.locator('#clip-status'), page.locator('#notice-sentence')];
  const disc = async (): Promise<Uint8Array> => (await masksOf(page, [3]))[0]!.map((label) => Number(label === 1));
  const found = await disc();
  const row = page.locator('#objects > [data-mask="1"]');
  const lock = row.locator('[data-action=lock]');
  await expect(lock).toHaveAccessibleName('Lock Object 1');
  await enter(row.locator('.motion-name'), 'Disc');
  await expect(lock).toHaveAccessibleName('Lock Disc');
  // A new object over its edge.
  await selectNew(page);
  await drag(page, at(X, Y), at(X + 22, Y));
  await said(page, /^Corrected/);
  const masks = await labelsOnCanvas(page);
  expect([masks[pixelAt(X + 3, Y)], masks[pixelAt(X + 20, Y)]]).toEqual([1, 3]);
  expect(differences(await disc(), found)).toBe(0);
  await selectNew(page);
  await drag(page, at(X - 2, Y - 2), at(X + 2, Y + 2));
  await expect(notice).toHaveText('What you painted belongs to an object with a lock or a name, so it stays.');
  await page.locator('#notice-close').click();
  // A correction of the object itself changes it.
  await page.keyboard.press('1');
  await page.keyboard.press('e');
  await drag(page, at(X - 6, Y - 5), at(X + 3, Y - 5));
  await said(page, /^Corrected: the masks of (\d+|one) frames? ha(ve|s) changed/);

  await page.keyboard.press('v');
  await lock.focus();
  await page.keyboard.press('Space');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await expect(status).toHaveText('Locked.');
  await expect(lock).toBeFocused();
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  await page.getByRole('button', { name: 'Redo' }).click();
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await kept(page);
  await reopen(page, files);
  await expect(status).toHaveText('Continued: 3 objects in 4 frames.');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await lock.click();
  await expect(status).toHaveText('Unlocked.');
});
