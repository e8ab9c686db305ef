//! The first minute of a later visit: work that the browser keeps is seen, and one click goes on with it; and what the page tells of it.

import { gunzipSync } from 'node:zlib';

import { type Page } from '@playwright/test';

import { type Upload, clipDone, clipFrames, done, expect, goTo, hide, holdBack, kept, leaves, openClip, openEmpty, openExport, openSample, openSegmented, projectsInBrowser, reloadEmpty, rename, said, saved, segmentClip, test, upload, withoutStorage, withSamples, withSmallSampleClip } from './support.js';

/** Leaves the page, and comes back without frames. */
async function visit(page: Page): Promise<void> {
  await page.goto('about:blank');
  await openEmpty(page);
}

/** Waits until the work is written. The copy of its frames comes after it. */
async function written(page: Page, name: string): Promise<void> {
  await expect.poll(() => projectsInBrowser(page)).toContainEqual(expect.objectContaining({ name }));
  await kept(page);
}

/** The sizes of the copies of frames, bytes; an empty one is none. */
function sizes(page: Page): Promise<number[]> {
  return page.evaluate(async () => {
    const folder = await (await navigator.storage.getDirectory()).getDirectoryHandle('frames').catch(() => null);
    const found: number[] = [];
    // It may be removed meanwhile.
    if (folder !== null) for await (const file of folder.keys()) found.push((await folder.getFileHandle(file).then((handle) => handle.getFile()).catch(() => null))?.size ?? 0);
    return found.filter((size) => size > 0);
  });
}

/** How many copies of frames the browser has. */
const copies = async (page: Page): Promise<number> => (await sizes(page)).length;

/** Work on a small clip that the browser keeps, with a copy of its frames unless that is left out. */
async function keptWork(page: Page, { copied = true } = {}): Promise<Upload[]> {
  const files = await clipFrames(4);
  await openSegmented(page, files);
  await rename(page, 1, 'Disc');
  await written(page, 'f00 to f03');
  if (copied) await expect.poll(() => copies(page)).toBe(1);
  return files;
}

/** Goes on with that work by choosing its frames. */
async function chooseFrames(page: Page, files: Upload[]): Promise<void> {
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.getByRole('button', { name: /^f00 to f03 4 frames, .*: choose the frames$/ }).click()]);
  await chooser.setFiles(files);
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Disc');
}

/** Where the parts of the panel and of the bar are, from the top and from the left. */
function places(page: Page): Promise<number[]> {
  return page.evaluate(() =>
    ['#samples', '#motions-title', '#status', '.masthead-actions'].flatMap((part) => {
      const { left, top } = document.querySelector(part)!.getBoundingClientRect();
      return [left, top];
    }),
  );
}

test('the next visit shows the work, and one click opens it with its frames', async ({ page }) => {
  await visit(page);
  const before = await places(page);
  await expect(page.locator('#continue')).toBeHidden();
  await keptWork(page);

  await visit(page);
  const work = page.getByRole('region', { name: 'Continue your work' }).getByRole('button');
  await expect(work).toHaveText(/^f00 to f034 frames, \d\d:\d\d$/);
  expect(await places(page)).toEqual(before);
  await expect(page.locator('#continue details')).toBeHidden();
  // The picture has the frame with its masks: what is orange and blue is not so in the frame.
  const strong = await work.locator('img').evaluate(async (image: HTMLImageElement) => {
    await image.decode();
    const context = new OffscreenCanvas(image.naturalWidth, image.naturalHeight).getContext('2d')!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.naturalWidth, image.naturalHeight);
    const at = (x: number, y: number): number[] => [...data.subarray(4 * (y * image.naturalWidth + x), 4 * (y * image.naturalWidth + x) + 3)];
    return { size: [image.naturalWidth, image.naturalHeight], disc: at(24, 36), ground: at(100, 20) };
  });
  expect(strong.size).toEqual([144, 96]);
  expect(strong.disc[0]! - strong.disc[2]!).toBeGreaterThan(60); // orange

  await work.click();
  await expect(page.locator('#clip-name')).toHaveText('f00 to f03, 4 frames, 100 × 70');
  await expect(page.locator('#clip-status')).toHaveText('Continued: 2 objects in 4 frames.');
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Disc');
  // The open clip is not offered.
  await expect(page.locator('#continue')).toBeHidden();

  // The clip's message is not shown for a pair.
  await expect(page.locator('#saving button')).toBeVisible();
  await withSamples(page);
  await openSample(page, 'Parallax');
  await expect(page.locator('#saving button')).toBeHidden();
  await work.click();
  await expect(page.locator('#saving button')).toBeVisible();
  expect(await leaves(page)).toBe(true);

  await openExport(page);
  await page.getByText('One project in this browser').click();
  const forget = page.getByRole('button', { name: 'Forget the project of f00 to f03' });
  // The list is of work that goes on: it tells the size with the copy, and the focus stays.
  await forget.focus();
  await page.getByLabel('Show Disc').evaluate((box: HTMLInputElement) => box.click());
  await expect.poll(() => projectsInBrowser(page)).toMatchObject([{ hidden: [1] }]);
  const [header] = await projectsInBrowser(page);
  const size = (await sizes(page)).reduce((sum, one) => sum + one, header!.bytes);
  await expect(page.locator('#projects li')).toContainText(`, ${Number((size / 1000).toFixed(1))}\u00A0kB,`);
  await expect(forget).toBeFocused();

  // Frames on screen are still read from the copy; it goes with them.
  await forget.click();
  await expect(page.locator('#projects')).toBeHidden();
  await expect(page.locator('#saving button')).toBeHidden();
  expect(await leaves(page)).toBe(false);
  await page.keyboard.press('Escape');
  await goTo(page, 3);
  await expect(page.locator('#notice-code')).toHaveText('');
  page.on('dialog', (dialog) => void dialog.accept());
  await visit(page);
  await expect.poll(() => copies(page)).toBe(0);
  await expect(page.locator('#continue')).toBeHidden();
});

test('the page opens again with the last work, unless another tab has it; the samples are still there', async ({ page, context }) => {
  await withSmallSampleClip(page);
  await keptWork(page);
  // Settings in the address are no other work.
  for (const address of ['./#quality=fast', './']) {
    await page.goto('about:blank');
    await page.goto(address);
    await expect(page.locator('#clip-name')).toContainText('4 frames');
    await said(page, /^Continued/);
    await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Disc');
  }
  await expect(page.locator('#samples .sample')).toHaveCount(3);
  await rename(page, 1, 'Ball');
  await kept(page);
  await page.getByLabel('Segment a clip when it is opened').uncheck(); // the other one need not do it
  const other = await context.newPage();
  await other.goto('./');
  await expect(other.locator('#clip-name')).toContainText('51 frames');
  await expect(other.locator('#notice-code')).toHaveText('');
});

test('files that were not written before the page was closed count for nothing', { tag: '@soak' }, async ({ page }) => {
  const files = await keptWork(page);
  await visit(page);
  await page.evaluate(async () => {
    const root = await navigator.storage.getDirectory();
    const frames = await root.getDirectoryHandle('frames');
    for await (const name of frames.keys()) await (await (await frames.getFileHandle(name)).createWritable()).close();
  });
  expect(await copies(page)).toBe(0);
  await visit(page);
  await chooseFrames(page, files);
  await expect.poll(() => copies(page)).toBe(1);
  await openExport(page);
  await expect(page.locator('#project summary')).toHaveText('One project in this browser');
  await expect(page.locator('#projects li')).toHaveCount(1);
});

test('of several the newest comes first, and a sample needs no copy', async ({ page }) => {
  await keptWork(page);
  await page.goto('about:blank');
  await page.goto('./#sample=parallax&quality=fast');
  await clipDone(page);
  await rename(page, 1, 'Window');
  await written(page, 'parallax');
  await expect.poll(() => copies(page)).toBe(1);

  await visit(page);
  await withSamples(page);
  const work = page.locator('#continue .work');
  await expect(work.first()).toHaveAccessibleName(/^parallax 2 frames, \d\d:\d\d$/);
  await page.getByText('1 more').click();
  await expect(work.nth(1)).toHaveAccessibleName(/^f00 to f03/);
  await work.first().click();
  await expect(page.locator('#clip-name')).toHaveText('parallax, 2 frames, 400 × 300');
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Window');
  await expect(page.getByRole('button', { name: 'Parallax', exact: true })).toHaveAttribute('aria-current', 'true');
  // Now the clip is the newest that is not open.
  await expect(work.first()).toHaveAccessibleName(/^f00 to f03/);
});

test('frames that are too large to copy are asked for', { tag: '@soak' }, async ({ page }) => {
  await page.addInitScript(() => void (isSecureContext && (StorageManager.prototype.estimate = () => Promise.resolve({ quota: 1000, usage: 0 })))); // about:blank has none
  const files = await keptWork(page, { copied: false });
  await expect(page.locator('#saving button')).toHaveText(/^Saved without its frames, \d\d:\d\d/);
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText('Your work is kept in this browser. Open the same frames again to continue.');
  await visit(page);
  await chooseFrames(page, files);
});

test('copies of frames give way to work when the disk is full', { tag: '@soak' }, async ({ page, context, baseURL }) => {
  await keptWork(page);
  const usage = await page.evaluate(async () => (await navigator.storage.estimate()).usage ?? 0);
  const session = await context.newCDPSession(page);
  await session.send('Storage.overrideQuotaForOrigin', { origin: new URL(baseURL!).origin, quotaSize: usage });
  await rename(page, 2, 'Box');
  await expect.poll(() => copies(page)).toBe(0);
  await written(page, 'f00 to f03');
  await expect(page.locator('#notice-code')).toHaveText('');
  await expect(page.locator('#saving button')).toHaveText(/^Saved without its frames/);
});

test('the page tells when work is saved, says so once, and saves it as a file', async ({ page }) => {
  await visit(page);
  const before = await places(page);
  await expect(page.locator('#saving button')).toBeHidden();
  const told = page.locator('#saving [role=status]');
  await told.evaluate((status) => {
    const said: (string | null)[] = [];
    Object.assign(window, { said });
    new MutationObserver(() => said.push(status.textContent)).observe(status, { childList: true, characterData: true, subtree: true });
  });
  await upload(page, await clipFrames(4));
  await done(page);
  await segmentClip(page);
  const saving = page.locator('#saving').getByRole('button', { name: /^Saved in this browser, \d\d:\d\d Save as a file$/ });
  await expect(saving).toBeVisible();
  await rename(page, 1, 'Disc');
  await kept(page);
  await expect(saving).toBeVisible();
  expect(await page.evaluate(() => (window as unknown as { said: string[] }).said)).toEqual(['Your work is saved in this browser.']);
  expect((await places(page)).slice(4)).toEqual(before.slice(4));
  expect(gunzipSync((await saved(page, saving)).bytes).toString('latin1')).toContain('Disc');
});

test('work that the browser refuses to keep is shown as not saved', async ({ page }) => {
  await withoutStorage(page);
  await openSegmented(page, await clipFrames(4));
  await rename(page, 1, 'Disc');
  const saving = page.locator('#saving button');
  await expect(saving).toHaveText(/^Not saved: the browser refused/);
  await expect(page.locator('#notice-code')).toHaveText('storage-refused');
  await expect(page.getByRole('alert')).toContainText('save the project before you leave');
  expect(await leaves(page)).toBe(false);
  await expect(page.locator('#saving [role=status]')).toHaveText('');
  expect((await saved(page, saving)).name).toBe('f00_to_f03.veronese');
  expect(await leaves(page)).toBe(true);
});

test('a clip is kept when it is opened, and one whose run a reload ended goes on where it was', async ({ page }) => {
  await openClip(page, await clipFrames(4));
  await expect(page.locator('#saving')).toContainText('Saved in this browser');
  await expect.poll(() => copies(page)).toBe(1);
  expect(await leaves(page)).toBe(true);
  await reloadEmpty(page);
  const work = page.getByRole('region', { name: 'Continue your work' }).getByRole('button');
  await work.click();
  await expect(page.locator('#clip-name')).toContainText('f00 to f03');
  await done(page);
  await expect(page.locator('#clip-status')).toHaveText('');
  await expect(page.getByRole('button', { name: 'Segment the clip' })).toBeVisible();

  await page.getByLabel('Segment a clip when it is opened').check();
  await holdBack(page, 'f08.png');
  await upload(page, await clipFrames(12));
  await expect(page.locator('#clip-detail')).toHaveText(/^[2-9] of 12/);
  await hide(page); // as before a reload
  await expect.poll(() => copies(page)).toBe(2);
  await reloadEmpty(page);
  await page.getByLabel('Segment a clip when it is opened').check();
  const release = await holdBack(page, 'f08.png');
  await work.filter({ hasText: 'f00 to f11' }).click();
  await expect(page.locator('#clip-detail')).toHaveText(/^[2-9] of 12/); // not from the first one on
  await release();
  await clipDone(page);
  await said(page, /^2 objects in 12 frames/);
});
