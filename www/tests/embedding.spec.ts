//! <veronese-segmenter> in the example of a host page.

import { readFile } from 'node:fs/promises';

import { type Page } from '@playwright/test';
import { davisPalette } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import { axe, clipFrames, clipInNode, differences, expect, smallSampleClip, test, withSmallSampleClip } from './support.js';

/** The current labels of the element. */
async function labels(page: Page): Promise<Uint8Array> {
  return Uint8Array.from(await page.locator('veronese-segmenter').evaluate((element) => [...(element as HTMLElementTagNameMap['veronese-segmenter']).labels()!]));
}

const status = (page: Page) => page.locator('#host-status');

test('a pair in the colours of the host, in which axe finds nothing serious; other settings and other files', async ({ page }) => {
  await withSmallSampleClip(page);
  await page.goto('./embed.html');
  await page.getByLabel('Source').selectOption('Two cars, pair');
  await expect(status(page)).toHaveText(/objects? in two frames\.$/);
  await expect(page.locator('#annotations li')).toHaveCount(new Set(await labels(page)).size - 1);
  for (const colorScheme of ['dark', 'light'] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await axe(page)).toEqual([]);
  }
  await expect(page.getByRole('img', { name: /masks of \d motions?$/ })).toBeVisible();

  await page.locator('#motions').selectOption('2');
  await expect(page.getByRole('img', { name: /masks of 2 motions$/ })).toBeVisible();
  const colours = await page.locator('veronese-segmenter').evaluate((element) => {
    const canvas = element.shadowRoot!.querySelector<HTMLCanvasElement>('.masks')!;
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    return [...new Set(new Uint32Array(data.buffer))].filter((colour) => colour !== 0);
  });
  expect(colours).toEqual([0xff93_5cff]); // --veronese-colour-1, from its last byte to its first

  await page.getByLabel('Open').setInputFiles((await clipFrames(3)).reverse());
  await expect(status(page)).toHaveText(/in 3 frames\.$/);
  await page.getByLabel('Open').setInputFiles({ name: 'notes.mp4', mimeType: 'video/mp4', buffer: Buffer.from('text') });
  await expect(status(page)).toHaveText('No masks: the clip is not a video that this browser can read.');
});

test('a clip is cancelled, segmented, named and saved', { tag: '@soak' }, async ({ page }) => {
  await withSmallSampleClip(page);
  await page.goto('./embed.html');
  const cancel = page.getByRole('button', { name: 'Cancel' });
  await cancel.waitFor();
  await page.getByRole('button', { name: 'Save' }).click();
  await expect(page.getByRole('dialog')).toBeHidden(); // the masks are not ready yet
  await cancel.click();
  await expect(status(page)).toHaveText('Cancelled.');
  await page.reload();
  await expect(status(page)).toHaveText('2 objects in 33 frames.');
  const expected = await clipInNode((await smallSampleClip()).slice(16, 49));
  expect(differences(await labels(page), expected[0]!)).toBe(0);

  const name = page.getByRole('textbox', { name: 'Name of object 2' });
  await name.fill('red car');
  await expect(page.getByRole('option', { name: 'Object 2', selected: true })).toBeAttached();
  await page.getByRole('button', { name: 'Save' }).click();
  const saved = page.getByRole('dialog', { name: 'Saved by the form' });
  await expect(saved.getByRole('listitem')).toHaveCount(35);
  await expect(saved.getByRole('listitem').last()).toHaveText('object-2: red car');
  const [download] = await Promise.all([page.waitForEvent('download'), saved.getByRole('link', { name: '00002.png' }).click()]);
  const { data } = await decodeImage(await readFile(await download.path()));
  const palette = davisPalette().map((colour) => [...colour, 255]);
  expect(differences(data, [...expected[2]!].flatMap((label) => palette[label]!))).toBe(0);
  await saved.getByRole('button', { name: 'Close' }).click();

  await page.getByRole('button', { name: 'Reset' }).click();
  await expect(name).toHaveValue('');
  await expect(page.getByRole('listbox', { name: 'Objects' }).getByRole('option', { selected: true })).toHaveCount(0);
});
