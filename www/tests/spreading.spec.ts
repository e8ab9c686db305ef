//! A correction while it spreads through a clip: frames are redrawn as they change, it can be taken back, and locked objects stay.

import { type Page } from '@playwright/test';

import { axe, clipDone, clipFrames, clipInNode, differences, drag, expect, goTo, labelsOnCanvas, openEmpty, openSegmented, test, upload } from './support.js';

/** The masks of a frame, shown. */
async function masksOf(page: Page, index: number): Promise<Uint8Array> {
  await goTo(page, index);
  return labelsOnCanvas(page);
}

async function selectNew(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
}

/** Presses keys, in one task, when the correction that comes has changed its first frame. */
async function pressAtFirstChange(page: Page, ...keys: string[]): Promise<void> {
  await page.evaluate((keys) => {
    const observer = new MutationObserver(([change]) => {
      if (change!.target.textContent === '') return;
      observer.disconnect();
      for (const key of keys) document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, ctrlKey: key === 'z' }));
    });
    observer.observe(document.querySelector('#clip-detail')!, { childList: true, characterData: true, subtree: true });
  }, keys);
}

/** Over the disc of `clipFrames` in frame 3, and what is below it to the right. */
const OVER_DISC = [[0.2, 0.3], [0.32, 0.46]] as const;
const DISC_IN_3 = Math.round(0.38 * 140) * 200 + Math.round(0.26 * 200);
const BESIDE = [[0.5, 0.1], [0.6, 0.15]] as const;
const BESIDE_IN_3 = Math.round(0.125 * 140) * 200 + Math.round(0.55 * 200);

test('frames are redrawn as a correction changes them, with its progress', async ({ page }) => {
  await openSegmented(page, await clipFrames(16));
  await goTo(page, 3);
  await selectNew(page);
  await page.evaluate(() => {
    const told: string[] = [];
    Object.assign(window, { told });
    new MutationObserver(() => {
      const [run, status, detail, cancel] = ['#clip-run', '#clip-status', '#clip-detail', '#clip-cancel'].map((name) => document.querySelector<HTMLElement>(name)!);
      if (run!.dataset.phase === 'working' && detail!.textContent !== '') told.push(`${status!.textContent} ${detail!.textContent} ${cancel!.hidden}`);
    }).observe(document.querySelector('#clip-detail')!, { childList: true, characterData: true, subtree: true });
  });
  const before = await labelsOnCanvas(page);
  await drag(page, ...OVER_DISC);
  await clipDone(page);
  const told = await page.evaluate(() => (window as unknown as { told: string[] }).told);
  expect(told.length).toBeGreaterThan(1);
  expect(told[0]).toBe('Carrying your correction to other frames… 1 so far false');
  const counts = told.slice(1).map((text) => Number(/… (\d+) so far false$/.exec(text)?.[1]));
  expect(counts).toEqual([...counts].sort((one, other) => one - other));
  expect(counts[0]).toBeGreaterThan(1);
  expect(differences(await labelsOnCanvas(page), before)).toBeGreaterThan(0);
});

test('a frame that is not the corrected one has its new masks before the correction has spread to the end', async ({ page }) => {
  const files = await clipFrames(16);
  await openSegmented(page, files);
  await goTo(page, 3);
  await selectNew(page);
  // At each change: the pixels on screen, which are those of the second frame once it is shown.
  await page.evaluate(() => {
    const drawn: string[] = [];
    Object.assign(window, { drawn });
    const canvas = document.querySelector<HTMLCanvasElement>('#fill')!;
    const look = (): void => {
      if (document.querySelector<HTMLElement>('#clip-run')!.dataset.phase === 'working') drawn.push(canvas.toDataURL());
    };
    new MutationObserver(() => requestAnimationFrame(look)).observe(document.querySelector('#clip-detail')!, { childList: true, characterData: true, subtree: true });
    document.querySelector('.layers')!.addEventListener('pointerup', () => document.querySelector<HTMLInputElement>('#look [value=second]')!.click());
  });
  await drag(page, ...OVER_DISC);
  await clipDone(page);
  const drawn = await page.evaluate(() => (window as unknown as { drawn: string[] }).drawn);
  expect(new Set(drawn).size).toBeGreaterThan(1);
});

test('Escape takes back the correction that spreads, and nothing else', async ({ page }) => {
  const files = await clipFrames(16);
  await openSegmented(page, files);
  await page.locator('#objects > li').nth(2).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  const kept = [await masksOf(page, 12), await masksOf(page, 3)];
  await selectNew(page);
  await pressAtFirstChange(page, 'Escape');
  await drag(page, ...OVER_DISC);
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText('Undone.');
  await expect(page.locator('#clip-cancel')).toBeHidden();
  expect(differences(await labelsOnCanvas(page), kept[1]!)).toBe(0);
  expect(differences(await masksOf(page, 12), kept[0]!)).toBe(0);
  // The correction before can be undone still, and another one be made.
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
  expect(differences(await labelsOnCanvas(page), (await clipInNode(files))[12]!)).toBe(0);
  await page.getByRole('button', { name: 'Redo' }).click();
  expect(differences(await labelsOnCanvas(page), kept[0]!)).toBe(0);
  await goTo(page, 3);
  await drag(page, ...OVER_DISC);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect((await labelsOnCanvas(page))[DISC_IN_3]).toBe(3);
});

/** Draws two strokes in one task, so that the second waits for the first, which is taken back, or the second. */
async function twoStrokes(page: Page, key: 'Escape' | 'z'): Promise<Uint8Array> {
  await openSegmented(page, await clipFrames(16));
  await goTo(page, 3);
  await selectNew(page);
  await pressAtFirstChange(page, key);
  await page.locator('.layers').evaluate((layers, lines) => {
    const box = layers.getBoundingClientRect();
    layers.setPointerCapture = () => undefined; // synthetic pointers cannot be captured
    for (const line of lines) {
      ['pointerdown', 'pointermove', 'pointerup'].forEach((type, k) => {
        const [x, y] = line[Math.min(k, 1)]!;
        const at = { clientX: box.x + x * box.width, clientY: box.y + y * box.height };
        layers.dispatchEvent(new PointerEvent(type, { pointerId: 1, isPrimary: true, button: type === 'pointermove' ? -1 : 0, bubbles: true, ...at }));
      });
    }
  }, [OVER_DISC, BESIDE]);
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  return labelsOnCanvas(page);
}

test('a stroke that waits for the one that Escape takes back is carried on', async ({ page }) => {
  const masks = await twoStrokes(page, 'Escape');
  expect(masks[BESIDE_IN_3]).toBe(3);
  expect(masks[DISC_IN_3]).toBe(1);
});

test('undo takes back the stroke that waits, and the one that spreads goes on', async ({ page }) => {
  const masks = await twoStrokes(page, 'z');
  expect(masks[DISC_IN_3]).toBe(3);
  await page.keyboard.press('Control+z');
  await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
  await expect(page.locator('#undo')).toBeDisabled();
});

test('a colour that is looked for in the palette while a correction spreads is one step after it', async ({ page }) => {
  await openSegmented(page, await clipFrames(16));
  await goTo(page, 3);
  const colour = page.getByLabel('Colour of Object 1');
  const first = await colour.inputValue();
  await selectNew(page);
  await colour.evaluate((field: HTMLInputElement) => {
    const observer = new MutationObserver(([change]) => {
      if (change!.target.textContent === '') return;
      observer.disconnect();
      for (const value of ['#101010', '#202020', '#303030']) {
        field.value = value;
        field.dispatchEvent(new Event('input', { bubbles: true }));
      }
      field.dispatchEvent(new Event('change', { bubbles: true }));
    });
    observer.observe(document.querySelector('#clip-detail')!, { childList: true, characterData: true, subtree: true });
  });
  await drag(page, ...OVER_DISC);
  await expect(colour).toHaveValue('#303030');
  await clipDone(page);
  const undo = page.locator('#undo');
  await undo.click();
  await expect(colour).toHaveValue(first);
  await expect(undo).toBeEnabled();
  await undo.click();
  await expect(undo).toBeDisabled();
});

test('corrections of others leave objects with a name or a lock as they are', async ({ page }) => {
  const files = await clipFrames(8);
  const found = (await clipInNode(files)).map((labels) => labels.map((label) => Number(label === 1)));
  /** The pixels of the disc in frame 6 that a new object changes which is painted over its edge in frame 3; `label`: what that has there. */
  const taken = async (label: number): Promise<number> => {
    await goTo(page, 3);
    await selectNew(page);
    await drag(page, [0.26, 0.38], [0.5, 0.38]);
    await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
    const masks = await labelsOnCanvas(page);
    expect([masks[DISC_IN_3 + 4], masks[DISC_IN_3 + 40]]).toEqual([label, 3]);
    const changed = differences((await masksOf(page, 6)).map((label) => Number(label === 1)), found[6]!);
    await page.getByRole('button', { name: 'Undo' }).click();
    await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
    return changed;
  };
  await openSegmented(page, files);
  const row = page.locator('#objects > li').nth(1);
  const lock = row.locator('[data-action=lock]');
  await expect(lock).toHaveAccessibleName('Lock Object 1');
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  expect(await taken(3)).toBeGreaterThan(100);

  // The row of a new object that was not painted goes; the one where a name is typed or a button pressed stays.
  await row.locator('.motion-name').fill('Disc');
  await row.locator('.motion-name').press('Enter');
  await expect(lock).toHaveAccessibleName('Lock Disc');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  expect(await taken(1)).toBe(0);
  await goTo(page, 3);
  await selectNew(page);
  await drag(page, [0.24, 0.36], [0.28, 0.4]);
  await expect(page.locator('#notice-sentence')).toHaveText('What you painted belongs to a locked object. Unlock it first.');
  await page.locator('#notice-close').click();
  await lock.click();
  await expect(page.locator('#clip-status')).toHaveText('Unlocked.');
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  expect(await taken(3)).toBeGreaterThan(100);

  // A correction of the object itself changes it.
  await lock.click();
  await goTo(page, 3);
  await row.locator('summary').focus();
  await page.locator('#tools [value=eraser]').check();
  await drag(page, [0.2, 0.3], [0.3, 0.3]);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of \d+ frames have changed/);
});

test('a lock is set with the keyboard, undone, and kept', async ({ page }) => {
  const files = await clipFrames(5);
  await openSegmented(page, files);
  const lock = page.locator('#objects [data-action=lock]').nth(1);
  await lock.focus();
  await page.keyboard.press('Space');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('#clip-status')).toHaveText('Locked.');
  await expect(lock).toBeFocused();
  expect(await axe(page)).toEqual([]);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  await page.getByRole('button', { name: 'Redo' }).click();
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await expect.poll(() => page.evaluate(() => window.dispatchEvent(new Event('beforeunload', { cancelable: true })))).toBe(true);
  await page.reload();
  await openEmpty(page, 'groups');
  await upload(page, files);
  await expect(page.locator('#clip-status')).toHaveText('Continued: 2 objects in 5 frames.');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('#objects [data-action=lock]').nth(2)).toHaveAttribute('aria-pressed', 'false');
});
