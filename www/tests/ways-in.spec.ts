//! Files dropped or pasted, the keyboard alone, a phone, a folder of another host.

import { type Page } from '@playwright/test';

import { type Upload, done, expect, labelsOnCanvas, open, sample, segmentedInNode, differences, square, test } from './support.js';

/** Sends files to the page as a drop or a paste would. */
async function give(page: Page, how: 'drop' | 'paste', files: Upload[]): Promise<void> {
  const plain = files.map(({ name, mimeType, buffer }) => ({ name, mimeType, base64: buffer.toString('base64') }));
  await page.evaluate(
    ([how, plain]) => {
      const transfer = new DataTransfer();
      for (const { name, mimeType, base64 } of plain) {
        transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name, { type: mimeType }));
      }
      const common = { bubbles: true, cancelable: true };
      if (how === 'drop') {
        document.body.dispatchEvent(new DragEvent('dragenter', { ...common, dataTransfer: transfer }));
        document.body.dispatchEvent(new DragEvent('drop', { ...common, dataTransfer: transfer }));
      } else document.body.dispatchEvent(new ClipboardEvent('paste', { ...common, clipboardData: transfer }));
    },
    [how, plain] as const,
  );
}

test('two files are dropped at once', async ({ page }) => {
  await open(page);
  const [a, b] = [await square('a.png', 80, 60, 0, 0), await square('b.png', 80, 60, 2, 1)];
  await give(page, 'drop', [b, a]);
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('a.png, 80 × 60');
  await done(page);
  expect(differences(await labelsOnCanvas(page), (await segmentedInNode(a, b)).labels)).toBe(0);
});

test('one file is pasted, then the other', async ({ page }) => {
  await open(page);
  await give(page, 'paste', [await square('z.png', 80, 60, 0, 0)]);
  await expect(page.locator('#status')).toHaveText('Now add the second frame.');
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('none yet');
  await give(page, 'paste', [await square('a.png', 80, 60, 2, 1)]);
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('a.png, 80 × 60');
  await done(page);
});

test('one frame of the pair is replaced', async ({ page }) => {
  await open(page);
  const other = await sample('first', 'other.png');
  await page.getByLabel('Replace the second frame').setInputFiles(other);
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('other.png, 768 × 432');
  await done(page);
});

/** Presses Tab until the element has the focus. */
async function tabTo(page: Page, selector: string): Promise<void> {
  for (let i = 0; i < 150; i++) {
    await page.keyboard.press('Tab');
    if (await page.locator(selector).first().evaluate((element) => element === document.activeElement)) return;
  }
  throw new Error(`Tab does not reach ${selector}`);
}

test('works by keyboard alone', async ({ page }) => {
  const chooser = page.waitForEvent('filechooser'); // asked for early: the browser must know before the key is pressed
  await open(page);
  const all = await labelsOnCanvas(page);

  await tabTo(page, '#open-pair');
  await page.keyboard.press('Enter');
  expect((await chooser).isMultiple()).toBe(true);

  await tabTo(page, '#look [name=frame]');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#caption')).toHaveText('Second frame');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowLeft');
  await tabTo(page, '#look [name=opacity]');
  await page.keyboard.press('End');
  await expect(page.locator('#opacity-value')).toHaveText('100 %');

  await tabTo(page, '#motions [type=checkbox]');
  await page.keyboard.press('Space');
  expect(differences(await labelsOnCanvas(page), all)).toBeGreaterThan(0);
  await page.keyboard.press('Space');
  expect(differences(await labelsOnCanvas(page), all)).toBe(0);

  await tabTo(page, '#settings select');
  await page.keyboard.press('2'); // the choice that begins with it
  await page.keyboard.press('Tab');
  await done(page);
  await expect(page.getByLabel('Number of motions')).toHaveValue('2');
});

test('works from any folder', async ({ page, context, baseURL }) => {
  await context.route('**/some/folder/**', async (route) => {
    const url = route.request().url().replace('/some/folder/', '/');
    await route.fulfill({ response: await route.fetch({ url }) });
  });
  const asked: string[] = [];
  page.on('request', (request) => asked.push(new URL(request.url()).pathname));
  await page.goto(`${baseURL}some/folder/`);
  await done(page);
  expect(asked.filter((path) => !path.startsWith('/some/folder/'))).toEqual([]);
});

test('fits a phone of 360 pixels', async ({ page }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await open(page);
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(360);
});
