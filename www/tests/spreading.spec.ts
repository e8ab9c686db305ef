//! A correction while it spreads through a clip: frames are redrawn as they change, it can be taken back, and locked objects stay.

import { type Page } from '@playwright/test';

import { type Place, type Upload, axe, clipDone, clipFrames, clipInNode, differences, drag, drawAtOnce, enter, expect, goTo, kept, labelsOnCanvas, masksOf, openSegmented, reopen, test } from './support.js';

async function selectNew(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
  await expect(page.locator('#strokes .brush')).toBeAttached(); // it is loaded when it is chosen
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

const [WIDTH, HEIGHT] = [120, 84];
/** Pixels of the picture, as shares of it. */
const at = (x: number, y: number): Place => [x / WIDTH, y / HEIGHT];
const pixelAt = (x: number, y: number): number => y * WIDTH + x;

/** Over the disc of `clipFrames`, whose centre is at (36, 33) in frame 3, and what is beside it; brushes of 4 pixels. */
const OVER_DISC = [at(30, 29), at(41, 38)] as const;
const DISC_IN_3 = pixelAt(36, 33);
const BESIDE = [at(65, 9), at(76, 12)] as const;
const BESIDE_IN_3 = pixelAt(71, 11);

/** A segmented clip with a brush for its size. */
async function openSmall(page: Page, files: Upload[]): Promise<void> {
  await openSegmented(page, files);
  await page.locator('#tools [name=radius]').fill('4');
}

/** Draws two strokes in one task, so that the second waits for the first; the keys that follow meet both. */
async function drawTwo(page: Page): Promise<void> {
  await drawAtOnce(page, [OVER_DISC, BESIDE]);
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
}

test('a correction that spreads: frames are redrawn as it changes them, and it is taken back alone or followed by what waits', async ({ page }) => {
  const files = await clipFrames(10, WIDTH, HEIGHT);
  await openSmall(page, files);
  const undo = page.locator('#undo');
  const status = page.locator('#clip-status');
  const undoAll = async (): Promise<void> => {
    while (await undo.isEnabled()) {
      await undo.click();
      await expect(status).toHaveText(/^Undone in/);
    }
    await goTo(page, 3);
  };
  await goTo(page, 3);
  await selectNew(page);
  const before = await labelsOnCanvas(page);

  await test.step('frames are redrawn as it changes them, with its progress, and not only the corrected one', async () => {
    // At each change: what is told, and the pixels on screen, which are those of the second frame once it is shown.
    await page.evaluate(() => {
      const [told, drawn]: [string[], string[]] = [[], []];
      const canvas = document.querySelector<HTMLCanvasElement>('#fill')!;
      const [run, status, detail, cancel] = ['#clip-run', '#clip-status', '#clip-detail', '#clip-cancel'].map((name) => document.querySelector<HTMLElement>(name)!);
      const works = (): boolean => run!.dataset.phase === 'working';
      const observer = new MutationObserver(() => {
        if (works() && detail!.textContent !== '') told.push(`${status!.textContent} ${detail!.textContent} ${cancel!.hidden}`);
        requestAnimationFrame(() => works() && drawn.push(canvas.toDataURL()));
      });
      observer.observe(detail!, { childList: true, characterData: true, subtree: true });
      Object.assign(window, { seen: { told, drawn }, unwatch: () => observer.disconnect() });
      document.querySelector('.layers')!.addEventListener('pointerup', () => document.querySelector<HTMLInputElement>('#look [value=second]')!.click(), { once: true });
    });
    await drag(page, ...OVER_DISC);
    await clipDone(page);
    const { told, drawn } = await page.evaluate(() => {
      const { seen, unwatch } = window as unknown as { seen: { told: string[]; drawn: string[] }; unwatch: () => void };
      unwatch();
      return seen;
    });
    expect(told.length).toBeGreaterThan(1);
    expect(told[0]).toBe('Carrying your correction to other frames… 1 of 10 frames false');
    const counts = told.map((text) => Number(/… (\d+) of 10 frames(?:, about \d+\u00a0s left)? false$/.exec(text)?.[1]));
    expect(counts).toEqual([...counts].sort((one, other) => one - other));
    expect(counts.at(-1)).toBe(10);
    expect(new Set(drawn).size).toBeGreaterThan(1);
    await page.locator('#look [value=first]').check();
    expect(differences(await labelsOnCanvas(page), before)).toBeGreaterThan(0);
  });

  await test.step('a stroke that waits for the one that Escape takes back is carried on', async () => {
    await undoAll();
    await pressAtFirstChange(page, 'Escape');
    await drawTwo(page);
    const masks = await labelsOnCanvas(page);
    expect(masks[BESIDE_IN_3]).toBe(3);
    expect(masks[DISC_IN_3]).toBe(1);
  });

  await test.step('undo takes back the stroke that waits, and the one that spreads goes on', async () => {
    await undoAll();
    await pressAtFirstChange(page, 'z');
    await drawTwo(page);
    expect((await labelsOnCanvas(page))[DISC_IN_3]).toBe(3);
    await page.keyboard.press('Control+z');
    await expect(status).toHaveText(/^Undone in/);
    await expect(undo).toBeDisabled();
  });

  await test.step('a colour that is looked for in the palette meanwhile is one step after it', async () => {
    const colour = page.getByLabel('Colour of Object 1');
    const first = await colour.inputValue();
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
    await undo.click();
    await expect(colour).toHaveValue(first);
    await expect(undo).toBeEnabled();
    await undo.click();
    await expect(undo).toBeDisabled();
  });

  await test.step('Escape takes back the correction that spreads, and nothing else', async () => {
    await page.locator('#objects > li').nth(2).locator('summary').click();
    await page.getByRole('button', { name: 'Delete Object 2' }).click();
    await expect(status).toHaveText(/^Corrected/);
    const kept = await masksOf(page, [8, 3]);
    await selectNew(page);
    await pressAtFirstChange(page, 'Escape');
    await drag(page, ...OVER_DISC);
    await clipDone(page);
    await expect(status).toHaveText('Undone.');
    await expect(page.locator('#clip-cancel')).toBeHidden();
    expect(differences(await labelsOnCanvas(page), kept[1]!)).toBe(0);
    expect(differences((await masksOf(page, [8]))[0]!, kept[0]!)).toBe(0);
    // The correction before can be undone still, and another one be made.
    await undo.click();
    await expect(status).toHaveText(/^Undone in/);
    expect(differences(await labelsOnCanvas(page), (await clipInNode(files))[8]!)).toBe(0);
    await page.getByRole('button', { name: 'Redo' }).click();
    expect(differences(await labelsOnCanvas(page), kept[0]!)).toBe(0);
    await goTo(page, 3);
    await drag(page, ...OVER_DISC);
    await expect(status).toHaveText(/^Corrected/);
    expect((await labelsOnCanvas(page))[DISC_IN_3]).toBe(3);
  });
});

test('corrections of others leave objects with a name or a lock as they are; a lock is set with the keyboard, undone, and kept', async ({ page }) => {
  const files = await clipFrames(6, WIDTH, HEIGHT);
  const found = (await clipInNode(files)).map((labels) => labels.map((label) => Number(label === 1)));
  /** The pixels of the disc in frame 5 that a new object changes which is painted over its edge in frame 3; `label`: what that has there. */
  const taken = async (label: number): Promise<number> => {
    await goTo(page, 3);
    await selectNew(page);
    await drag(page, at(36, 33), at(62, 33));
    await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
    const masks = await labelsOnCanvas(page);
    expect([masks[DISC_IN_3 + 3], masks[DISC_IN_3 + 24]]).toEqual([label, 3]);
    const changed = differences((await masksOf(page, [5]))[0]!.map((label) => Number(label === 1)), found[5]!);
    await page.getByRole('button', { name: 'Undo' }).click();
    await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
    return changed;
  };
  await openSmall(page, files);
  const row = page.locator('#objects > li').nth(1);
  const lock = row.locator('[data-action=lock]');
  await expect(lock).toHaveAccessibleName('Lock Object 1');
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  expect(await taken(3)).toBeGreaterThan(40);

  // The row of a new object that was not painted goes; the one where a name is typed or a button pressed stays.
  await enter(row.locator('.motion-name'), 'Disc');
  await expect(lock).toHaveAccessibleName('Lock Disc');
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  expect(await taken(1)).toBe(0);
  await lock.click();
  await expect(page.locator('#clip-status')).toHaveText('Locked.');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  expect(await taken(1)).toBe(0);
  await goTo(page, 3);
  await selectNew(page);
  await drag(page, at(34, 31), at(38, 35));
  await expect(page.locator('#notice-sentence')).toHaveText('What you painted belongs to an object with a lock or a name, so it stays.');
  await page.locator('#notice-close').click();

  // A correction of the object itself changes it once it is unlocked.
  await page.keyboard.press('1');
  await page.locator('#tools [value=eraser]').check();
  await lock.click();
  await expect(page.locator('#clip-status')).toHaveText('Unlocked.');
  await drag(page, at(29, 27), at(40, 27));
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of (\d+|one) frames? ha(ve|s) changed/);
  await lock.click();

  // By keyboard, undone, and there after a reload.
  await page.locator('#tools [value=look]').check();
  const other = page.locator('#objects [data-action=lock]').nth(2);
  await other.focus();
  await page.keyboard.press('Space');
  await expect(other).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('#clip-status')).toHaveText('Locked.');
  await expect(other).toBeFocused();
  expect(await axe(page)).toEqual([]);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(other).toHaveAttribute('aria-pressed', 'false');
  await page.getByRole('button', { name: 'Redo' }).click();
  await expect(other).toHaveAttribute('aria-pressed', 'true');
  await page.getByRole('button', { name: 'Undo' }).click();
  await kept(page);
  await reopen(page, files);
  await expect(page.locator('#clip-status')).toHaveText('Continued: 2 objects in 6 frames.');
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await expect(other).toHaveAttribute('aria-pressed', 'false');
});
