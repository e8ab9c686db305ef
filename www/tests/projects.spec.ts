//! Projects: what is done with a clip is kept in the browser and as a file, and is there when the same frames are opened again.

import { gunzipSync, gzipSync } from 'node:zlib';

import { type Page } from '@playwright/test';

import { type Upload, clipInNode, differences, done, enter, expect, goTo, hide, kept, labelsOnCanvas, leaves, openAdvanced, openClip, openExport, openSegmented, projectsInBrowser, reloadEmpty, rename, reopen, savedProject, segmentClip, smallFrames, test, upload } from './support.js';

/** The names of objects in the only project of the browser; undefined before there is one. */
async function namesInBrowser(page: Page): Promise<unknown> {
  const [, project] = (await projectsInBrowser(page)).join('').split('\n');
  return project === undefined ? undefined : (JSON.parse(project) as { clip: { names: unknown } }).clip.names;
}

/** A segmented clip with a name and a correction. */
async function correctedClip(page: Page, files: Upload[]): Promise<void> {
  await openSegmented(page, files);
  await rename(page, '#objects', 2, 'Box');
  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of \d+ frames/);
}

/** Whether it is the clip of {@link correctedClip}, continued without being segmented again. */
async function isContinued(page: Page, files: readonly Upload[]): Promise<void> {
  const found = await clipInNode(files, { quality: 'fast', edits: { delete: [1] } });
  const last = files.length - 1;
  await expect(page.locator('#clip-status')).toHaveText(`Continued: one object in ${files.length} frames.`);
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Box');
  for (const index of [0, last]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), found[index]!)).toBe(0);
  }
}

/** Removes all projects from the browser, once none is being written. */
async function forgetAll(page: Page): Promise<void> {
  const remove = async (): Promise<void> => page.evaluate(async () => (await navigator.storage.getDirectory()).removeEntry('projects', { recursive: true }));
  await expect(remove).toPass();
}

test('a corrected clip is there after a reload, and can be corrected further', async ({ page }) => {
  const files = await smallFrames(4);
  await correctedClip(page, files);
  await goTo(page, 2);
  await page.getByLabel('Show Box').uncheck();
  await expect.poll(async () => (await projectsInBrowser(page)).join('')).toContain('"hidden":[2]');
  await reopen(page, files);
  await expect(page.locator('#caption')).toHaveText('Frame 2');
  await expect(page.getByLabel('Show Box')).not.toBeChecked();
  await page.getByLabel('Show Box').check();
  await isContinued(page, files);
  expect(await leaves(page)).toBe(true);

  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Box' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0]));
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Undone/);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));
});

test('classes are those of the project, and their list is there for the next clip', async ({ page }) => {
  const files = await smallFrames(3);
  await openSegmented(page, files);
  const own = page.getByLabel(/^Class of .* 1$/);
  await page.keyboard.press('1');
  await enter(own, 'ball');
  await page.getByRole('button', { name: 'Classes…' }).click();
  await page.getByRole('textbox', { name: 'Classes' }).fill('person\nball');
  await page.keyboard.press('Escape');
  const saved = await savedProject(page);
  expect(gunzipSync(saved.buffer).toString('latin1')).toContain('"classList":["person","ball"]');
  await kept(page);

  // Another clip, without the project.
  await forgetAll(page);
  await reloadEmpty(page);
  await openSegmented(page, files);
  const offered = page.locator('#class-names option');
  await expect(offered).toHaveText(['person', 'ball']);
  await expect(own).toHaveValue('');
  await page.getByRole('button', { name: 'Classes…' }).click();
  await page.getByRole('textbox', { name: 'Classes' }).fill('tree');
  await page.keyboard.press('Escape');

  // The classes of the project keep their numbers.
  await upload(page, [saved]);
  await expect(own).toHaveValue('ball');
  await expect(offered).toHaveText(['person', 'ball', 'tree']);
});

test('a project is saved as a file and opened where nothing is left of it, over its frames or before them', async ({ page }) => {
  const files = await smallFrames(4);
  await correctedClip(page, files);
  const project = await savedProject(page);
  expect(project.name).toBe('f00-f03.veronese');
  const [header] = gunzipSync(project.buffer).toString('latin1').split('\n');
  expect(JSON.parse(header!)).toMatchObject({ format: 'veronese-project', version: 4, name: 'f00-f03.png', frames: 4 });

  await openExport(page);
  await page.getByText('One project in this browser').click();
  await page.getByRole('button', { name: 'Forget the project of f00-f03.png' }).click();
  await expect(page.locator('#notice')).toContainText('The project of “f00-f03.png” is forgotten.');
  await expect(page.locator('#projects')).toBeHidden();
  await reopen(page, files);
  await expect(page.locator('#kind-objects')).toBeHidden();
  // Over the open clip.
  await upload(page, [project]);
  await isContinued(page, files);
  await forgetAll(page);
  await reloadEmpty(page);
  await upload(page, [project]);
  await expect(page.locator('#notice')).toContainText('The project of “f00-f03.png” is open. Now open its frames');
  await upload(page, files);
  await isContinued(page, files);
});

for (const [lack, remove] of [
  ['has no private file system', () => delete (StorageManager.prototype as { getDirectory?: unknown }).getDirectory],
  ['cannot write it', () => delete (FileSystemFileHandle.prototype as { createWritable?: unknown }).createWritable],
] as const) {
  test(`projects are in a database if the browser ${lack}`, async ({ page }) => {
    await page.addInitScript(remove);
    const files = await smallFrames(3);
    await correctedClip(page, files);
    await kept(page);
    await reopen(page, files);
    await isContinued(page, files);
    await openExport(page);
    await page.getByText('One project in this browser').click();
    await page.getByRole('button', { name: 'Forget the project' }).click();
    await expect(page.locator('#projects')).toBeHidden();
  });
}

test('a full disk loses nothing, and the next change is kept again, with the settings', async ({ page, context, baseURL }) => {
  const files = await smallFrames(4);
  await openClip(page, files);
  const unlabelled = page.getByLabel('Leave unexplained pixels unlabelled');
  await openAdvanced(page);
  await unlabelled.check();
  await done(page);
  await segmentClip(page);
  await kept(page);
  const session = await context.newCDPSession(page);
  await session.send('Storage.overrideQuotaForOrigin', { origin: new URL(baseURL!).origin, quotaSize: 100 });
  await rename(page, '#objects', 1, 'Ball');
  await expect(page.locator('#notice-code')).toHaveText('storage-full');
  expect(await leaves(page)).toBe(false);
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText('Your work is not kept in this browser. Save the project before you leave.');
  // The project from before is whole.
  await expect(page.locator('#project summary')).toHaveText('One project in this browser');
  const project = await savedProject(page);
  expect(await leaves(page)).toBe(true);
  expect(gunzipSync(project.buffer).toString('latin1')).toContain('"Ball"');

  await session.send('Storage.overrideQuotaForOrigin', { origin: new URL(baseURL!).origin });
  await rename(page, '#objects', 2, 'Box');
  await kept(page);
  await page.goto('about:blank'); // a reload would keep what the form says
  await openClip(page, files);
  await expect(unlabelled).toBeChecked();
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Ball');
  await expect(page.locator('#objects .motion-name').nth(2)).toHaveValue('Box');
});

test('a second tab on a clip says that its work is not kept, and overwrites nothing', async ({ page: second, context }) => {
  const first = await context.newPage();
  const files = await smallFrames(3);
  await openSegmented(first, files);
  await kept(first);

  await openClip(second, files);
  await expect(second.locator('#clip-status')).toHaveText('Continued: 2 objects in 3 frames.');
  await expect(second.locator('#notice-code')).toHaveText('open-elsewhere');
  await expect(second.locator('#notice-sentence')).toContainText('“f00-f02.png” is open in another tab');
  await rename(second, '#objects', 1, 'Ball');
  expect(await leaves(second)).toBe(false);
  await openExport(second);
  await expect(second.locator('#project-status')).toHaveText('Your work is not kept in this browser. Save the project before you leave.');
  await second.keyboard.press('Escape');

  // The first tab keeps its own work as before, and that stays when it is gone.
  await rename(first, '#objects', 2, 'Box');
  await kept(first);
  await first.close();
  await rename(second, '#objects', 2, 'Square');
  await second.locator('#notice-close').click();
  await hide(second);
  expect(await namesInBrowser(second)).toEqual({ 'objects-2': 'Box' });
  expect(await leaves(second)).toBe(false);

  // The only tab left goes on from there.
  second.on('dialog', (dialog) => void dialog.accept());
  await reopen(second, files);
  await expect(second.locator('#objects .motion-name').nth(2)).toHaveValue('Box');
  await rename(second, '#objects', 1, 'Ball');
  await kept(second);
  expect(await namesInBrowser(second)).toEqual({ 'objects-1': 'Ball', 'objects-2': 'Box' });
});

test('damaged and foreign projects are refused with a reason and change nothing', async ({ page }) => {
  const files = await smallFrames(5);
  await openSegmented(page, files);
  const project = await savedProject(page);
  const lines = gunzipSync(project.buffer).toString('latin1').split('\n');
  const remade = (change: (lines: string[]) => string[]): Buffer => gzipSync(Buffer.from(change([...lines]).join('\n'), 'latin1'));
  const flipped = Buffer.from(project.buffer);
  flipped[Math.floor(flipped.length / 2)]! ^= 1;
  const cases: readonly (readonly [Buffer, string])[] = [
    [Buffer.from(''), 'damaged-project'],
    [Buffer.from('not a project'), 'damaged-project'],
    [project.buffer.subarray(0, project.buffer.length - 9), 'damaged-project'],
    [flipped, 'damaged-project'],
    [remade(([header, ...rest]) => [header!.replace('"version":4', '"version":5'), ...rest]), 'newer-project'],
    [remade(([header, ...rest]) => [header!.replace('"version":4', '"version":3'), ...rest]), 'damaged-project'],
    [remade(([header, ...rest]) => [header!.replace('"frames":5', '"frames":4'), ...rest]), 'damaged-project'],
    [remade(([header, ...rest]) => [header!.replace('data:image/jpeg;', 'data:text/html;'), ...rest]), 'damaged-project'],
    [remade(([header, content, lists, ...rest]) => [header!, content!, lists!.replace('"confidence"', '"confident"'), ...rest]), 'damaged-project'],
    [remade(([header, content, lists, ...rest]) => [header!, content!, lists!.replace('[100,70,', '[100,71,'), ...rest]), 'damaged-project'],
    [remade(([header, content, ...rest]) => [header!, content!.replace(/\{"image":\d+\}/, '{"image":999}'), ...rest]), 'damaged-project'],
  ];
  for (const [buffer, code] of cases) {
    await upload(page, [{ name: 'other.veronese', mimeType: '', buffer }]);
    await expect(page.locator('#notice-code')).toHaveText(code);
    await expect(page.locator('#notice-sentence')).toContainText('“other.veronese”');
    await page.locator('#notice-close').click();
  }
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 5 frames.');
});
