//! Dropped and pasted files, use by keyboard, a narrow screen, a page in a subfolder.

import { mkdir, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';

import { type Page } from '@playwright/test';
import { encodePng } from 'veronese/codecs';

import { video } from './video.js';
import { type Upload, axe, clipDone, clipFrames, differences, expect, give, goTo, inspect, labelsOnCanvas, openEmpty, openSegmented, opened, pixelsOf, test, withSmallSampleClip } from './support.js';

/** Drops files and folders from the disk. */
async function dropPaths(page: Page, paths: string[]): Promise<void> {
  const cdp = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop'] as const) await cdp.send('Input.dispatchDragEvent', { type, x: 300, y: 300, data });
}

/** Calls `use` with a temporary folder of these files. */
async function withFolder(files: Record<string, Buffer>, use: (path: string) => Promise<void>): Promise<void> {
  const root = await mkdtemp(join(tmpdir(), 'veronese-'));
  try {
    for (const [name, bytes] of Object.entries(files)) {
      await mkdir(dirname(join(root, name)), { recursive: true });
      await writeFile(join(root, name), bytes);
    }
    await use(root);
  } finally {
    await rm(root, { recursive: true });
  }
}

/** The shade of the frame on screen. */
async function shade(page: Page): Promise<number> {
  return (await pixelsOf(page, '#frame')).data[0]!;
}

/** A frame of one shade, 96 × 64. */
async function grey(value: number): Promise<Buffer> {
  return Buffer.from(await encodePng(96, 64, new Uint8Array(96 * 64 * 3).fill(value)));
}

test('folders are clips in the order of their names, of subfolders one after another if that is chosen, dropped or picked', async ({ page }) => {
  await openEmpty(page);
  // More files than browsers return in one batch. Files that are hidden or not images are skipped.
  const files: Record<string, Buffer> = { 'clip/notes.txt': Buffer.from('notes'), 'clip/.thumb.png': Buffer.from('hidden') };
  for (let k = 0; k < 130; k++) files[`clip/f${k}.png`] = await grey(k);
  await withFolder(files, async (root) => {
    await dropPaths(page, [join(root, 'clip')]);
    await opened(page, 'clip, 130 frames, 96 × 64');
    for (const index of [2, 129]) {
      await goTo(page, index);
      expect(await shade(page)).toBe(index);
    }
  });

  const inOrder = ['9.png', '10.png', 'a2/1.png', 'a2/2.png', 'a10/1.png', 'b/1.png'];
  const shades = await Promise.all(inOrder.map(async (name, k) => [`clip/${name}`, await grey(10 + k)] as const));
  await withFolder(Object.fromEntries(shades.toReversed()), async (root) => {
    await dropPaths(page, [join(root, 'clip')]);
    await page.getByRole('button', { name: 'All 6 images, folder by folder' }).click();
    await opened(page, 'clip, 6 frames, 96 × 64');
    for (const k of inOrder.keys()) {
      await goTo(page, k);
      expect(await shade(page)).toBe(10 + k);
    }
  });
  const picked = { 'b/1.png': 3, 'a/2.png': 2, 'a/1.png': 1, '.hidden.png': 0 };
  const buffers = await Promise.all(Object.entries(picked).map(async ([name, value]) => [`clip/${name}`, await grey(value)] as const));
  await withFolder(Object.fromEntries(buffers), async (root) => {
    await page.locator('#open-folder').setInputFiles(join(root, 'clip'));
    await page.getByRole('button', { name: 'All 3 images' }).click();
    await opened(page, 'clip, 3 frames, 96 × 64');
    expect(await shade(page)).toBe(1);
  });
});

test('of a folder with frames and masks the frames are opened, and a folder may hold a video, a pair or nothing to open', { tag: '@soak' }, async ({ page }) => {
  await openEmpty(page);
  const buffer = await grey(0);
  const names = ['frames', 'masks', 'meta/Ground Truth'].flatMap((folder) => [0, 1, 2].map((k) => `set/${folder}/${k}.png`));
  await withFolder(Object.fromEntries(names.map((name) => [name, buffer])), async (root) => {
    await dropPaths(page, [join(root, 'set')]);
    await opened(page, 'set/frames, 3 frames, 96 × 64');
    await expect(page.locator('#notice-sentence')).toHaveText('Opened the images of “set/frames”. 6 images of other folders are left out.');
    // Masks alone are what was asked for.
    await dropPaths(page, [join(root, 'set', 'masks')]);
    await opened(page, 'masks, 3 frames, 96 × 64');
    await expect(page.locator('#notice')).toBeHidden();
  });

  // A video, a pair or nothing to open.
  const { buffer: clip } = await video(page, 4, 'webm', 'vp8');
  const pair = { 'pair/.hidden': Buffer.from(''), 'pair/b.png': await grey(2), 'pair/a.png': await grey(1) };
  await withFolder({ 'video/clip.webm': clip, 'video/read.me': Buffer.from(''), 'empty/notes.txt': Buffer.from(''), ...pair }, async (root) => {
    await dropPaths(page, [join(root, 'video')]);
    await opened(page, 'clip.webm, 4 frames, 192 × 128');
    await dropPaths(page, [join(root, 'empty')]);
    await expect(page.getByRole('alert')).toContainText('There is no image or video among these files.');
    await expect(page.locator('#timeline')).toBeVisible();
    await dropPaths(page, [join(root, 'pair')]);
    await opened(page, 'pair, 2 frames, 96 × 64');
    expect(await shade(page)).toBe(1);
    // A file can still be dropped by itself.
    await dropPaths(page, [join(root, 'pair', 'b.png')]);
    await expect(page.locator('#status')).toHaveText('Now add the second frame.');
    expect(await shade(page)).toBe(2);
  });
});

test('of several folders of images one is chosen, or none', async ({ page }) => {
  await openEmpty(page);
  await give(page, 'drop', await clipFrames(2, 96, 64));
  await opened(page, 'f00 and f01');
  const buffer = await grey(0);
  const names = ['day/1.png', 'day/2.png', 'day/3.png', 'night/1.png', 'night/2.png', 'night/3.png', 'night/4.png', 'night/masks/1.png'];
  await withFolder(Object.fromEntries(names.map((name) => [`street/${name}`, buffer])), async (root) => {
    const dialog = page.getByRole('dialog', { name: 'Which folder has the frames?' });
    for (const leave of ['Escape', 'Cancel']) {
      await dropPaths(page, [join(root, 'street')]);
      await expect(dialog.getByRole('button')).toHaveText(['street/day, 3 images', 'street/night, 4 images', 'street/night/masks, one image', 'All 8 images, folder by folder', 'Cancel']);
      if (leave === 'Cancel') expect(await axe(page)).toEqual([]);
      if (leave === 'Escape') await page.keyboard.press('Escape');
      else await dialog.getByRole('button', { name: 'Cancel' }).click();
      await expect(dialog).toBeHidden();
      await opened(page, 'f00 and f01');
    }
    await dropPaths(page, [join(root, 'street')]);
    await dialog.getByRole('button', { name: 'street/night, 4 images' }).click();
    await opened(page, 'street/night, 4 frames, 96 × 64');
    await expect(page.locator('#notice')).toBeHidden();
    // Something else is opened while the question is asked.
    await dropPaths(page, [join(root, 'street')]);
    await expect(dialog).toBeVisible();
    await dropPaths(page, [join(root, 'street', 'day')]);
    await expect(dialog).toBeHidden();
    await opened(page, 'day, 3 frames, 96 × 64');
  });
});

test('two files are dropped together, or pasted one after the other; the page fits a screen 360 pixels wide', async ({ page }) => {
  await openEmpty(page);
  const [a, b] = await clipFrames(2, 96, 64) as [Upload, Upload];
  await give(page, 'drop', [b, a]);
  await opened(page, 'f00 and f01, 2 frames, 96 × 64');

  // In the order in which they came.
  await give(page, 'paste', [{ ...b, name: 'z.png' }]);
  await expect(page.locator('#status')).toHaveText('Now add the second frame.');
  await expect(page.locator('#timeline')).toBeHidden();
  const seen = await pixelsOf(page, '#frame');
  await give(page, 'paste', [a]);
  await opened(page, 'z and f00, 2 frames, 96 × 64');
  expect(differences((await pixelsOf(page, '#frame')).data, seen.data)).toBe(0);

  await page.setViewportSize({ width: 360, height: 740 });
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(360);
});

/** Presses Tab until the element has focus. */
async function tabTo(page: Page, selector: string): Promise<void> {
  for (let i = 0; i < 150; i++) {
    await page.keyboard.press('Tab');
    if (await page.locator(selector).first().evaluate((element) => element === document.activeElement)) return;
  }
  throw new Error(`Tab does not reach ${selector}`);
}

test('the page can be used with the keyboard', async ({ page }) => {
  await openSegmented(page, await clipFrames(3, 96, 64));
  const all = await labelsOnCanvas(page);

  const chooser = page.waitForEvent('filechooser'); // must be set up before the key is pressed
  await tabTo(page, '#open-pair');
  await page.keyboard.press('Enter');
  expect((await chooser).isMultiple()).toBe(true);

  await tabTo(page, '#objects > li:nth-child(2) [data-action=show]');
  await page.keyboard.press('Space');
  await expect.poll(async () => differences(await labelsOnCanvas(page), all)).toBeGreaterThan(0);
  await page.keyboard.press('Space');
  await expect.poll(async () => differences(await labelsOnCanvas(page), all)).toBe(0);

  await tabTo(page, '#look [name=opacity]');
  await page.keyboard.press('End');
  await expect(page.locator('#opacity-value')).toHaveText('100 %');

  await tabTo(page, '#inspect summary');
  await page.keyboard.press('Enter');
  await tabTo(page, '#look [name=frame]');
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#caption')).toHaveText('Frame 0 | Frame 1');
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await page.keyboard.press('ArrowRight'); // around
  await tabTo(page, '[name=motions]');
  await page.keyboard.press('Space');
  await expect(page.locator('#caption')).toHaveText('Motions: frame 0');
  await inspect(page);
  await tabTo(page, '#motions > li:nth-child(2) [data-action=take]');
  await page.keyboard.press('Enter');
  await expect(page.locator('#caption')).toHaveText('Frame 0');
});

test('the page works in any folder', async ({ page, context, baseURL }) => {
  await context.route('**/some/folder/**', async (route) => {
    const url = route.request().url().replace('/some/folder/', '/');
    await route.fulfill({ response: await route.fetch({ url }) });
  });
  await withSmallSampleClip(page);
  const asked: string[] = [];
  page.on('request', (request) => asked.push(new URL(request.url()).pathname));
  await page.goto(`${baseURL}some/folder/#quality=fast`);
  await clipDone(page);
  expect(asked.filter((path) => !path.startsWith('/some/folder/'))).toEqual([]);
});
