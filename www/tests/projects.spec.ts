//! Projects: what is done with a clip is kept in the browser and as a file, and is there when the same frames are opened again.

import { gunzipSync, gzipSync } from 'node:zlib';

import { type Page } from '@playwright/test';

import { fileOf, headerFrom, projectFromFile } from '../src/projects/file.js';
import { DEFAULT_SETTINGS } from '../src/state/settings.js';
import { type Upload, clipDone, clipFrames, differences, drag, enter, expect, goTo, hide, holdBack, kept, labelsOnCanvas, leaves, masksOf, openAdvanced, openClip, openExport, openSegmented, projectsInBrowser, reloadEmpty, rename, reopen, said, savedProject, test, upload } from './support.js';

/** A segmented clip with a name and a correction. Gives the masks of its first and its last frame. */
async function correctedClip(page: Page, files: Upload[]): Promise<Uint8Array[]> {
  await openSegmented(page, files);
  await rename(page, 2, 'Box');
  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await said(page, /^Corrected: the masks of \d+ frames/);
  return masksOf(page, [files.length - 1, 0]);
}

/** Whether it is the clip of {@link correctedClip}, with those masks, continued without being segmented again. */
async function isContinued(page: Page, masks: readonly Uint8Array[], count: number): Promise<void> {
  await expect(page.locator('#clip-status')).toHaveText(`Continued: one object in ${count} frames.`);
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Box');
  expect((await masksOf(page, [count - 1, 0])).map((labels, k) => differences(labels, masks[k]!))).toEqual([0, 0]);
}

/** Removes all projects from the browser, once none is being written. */
async function forgetAll(page: Page): Promise<void> {
  await page.evaluate(
    () =>
      new Promise((resolve) => {
        const request = indexedDB.deleteDatabase('veronese-projects');
        request.onsuccess = resolve;
        request.onblocked = resolve;
      }),
  );
}

test('a corrected clip is there after a reload, and can be corrected further', async ({ page }) => {
  const files = await clipFrames(4);
  const masks = await correctedClip(page, files);
  await goTo(page, 2);
  await page.getByLabel('Show Box').uncheck();
  await expect.poll(() => projectsInBrowser(page)).toMatchObject([{ hidden: [2], at: 2 }]);
  await reopen(page, files);
  await expect(page.locator('#caption')).toHaveText('Frame 2');
  await expect(page.getByLabel('Show Box')).not.toBeChecked();
  await page.getByLabel('Show Box').check();
  await isContinued(page, masks, 4);
  expect(await leaves(page)).toBe(true);

  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Box' }).click();
  await said(page, /^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0]));
  await page.getByRole('button', { name: 'Undo' }).click();
  await said(page, /^Undone/);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));
});

test('what is said is kept while it is being carried through the clip, and carried on after the page was left', async ({ page }) => {
  const files = await clipFrames(6);
  await openSegmented(page, files);
  await kept(page);
  const found = await masksOf(page, [5, 2]);
  await page.keyboard.press('1');
  await page.keyboard.press('p');
  await page.locator('#tools [name=radius]').fill('4');
  await holdBack(page, 'f05.png');
  await drag(page, [0.1, 0.85], [0.2, 0.85]);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await kept(page);
  // Another one waits for it.
  await drag(page, [0.8, 0.15], [0.9, 0.15]);
  await kept(page);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');

  await reopen(page, files);
  await said(page, /^Corrected/);
  await clipDone(page);
  await goTo(page, 2);
  const drawn = await labelsOnCanvas(page);
  expect([59 * 100 + 15, 10 * 100 + 85].map((p) => drawn[p])).toEqual([1, 1]);
  await kept(page);
  await openExport(page);
  await expect(page.locator('#project summary')).toHaveText('One project in this browser');
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Undo' }).click();
  await said(page, /^(Undone|Corrected)/);
  await clipDone(page);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.getByRole('button', { name: 'Undo' })).toBeDisabled();
  expect((await masksOf(page, [5, 2])).map((labels, k) => differences(labels, found[k]!))).toEqual([0, 0]);
});

test('classes are those of the project, and their list is there for the next clip', async ({ page }) => {
  const files = await clipFrames(4);
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
  const files = await clipFrames(4);
  const masks = await correctedClip(page, files);
  const project = await savedProject(page);
  expect(project.name).toBe('f00_to_f03.veronese');
  const [header] = gunzipSync(project.buffer).toString('latin1').split('\n');
  expect(JSON.parse(header!)).toMatchObject({ format: 'veronese-project', version: 5, name: 'f00 to f03', frames: 4 });

  await openExport(page);
  await page.getByText('One project in this browser').click();
  await page.getByRole('button', { name: 'Forget the project of f00 to f03' }).click();
  await expect(page.locator('#notice')).toContainText('The project of “f00 to f03” is forgotten.');
  await expect(page.locator('#projects')).toBeHidden();
  await reopen(page, files);
  await expect(page.locator('#objects')).toBeHidden();
  // A damaged one changes nothing.
  await upload(page, [{ ...project, name: 'other.veronese', buffer: project.buffer.subarray(0, -9) }]);
  await expect(page.locator('#notice-code')).toHaveText('damaged-project');
  await expect(page.locator('#notice-sentence')).toContainText('“other.veronese”');
  await expect(page.locator('#objects')).toBeHidden();
  // Over the open clip.
  await upload(page, [project]);
  await isContinued(page, masks, 4);
  await forgetAll(page);
  await reloadEmpty(page);
  await upload(page, [project]);
  await expect(page.locator('#notice')).toContainText('The project of “f00 to f03” is open. Now open its frames');
  await upload(page, files);
  await isContinued(page, masks, 4);
});

test('a full disk loses nothing, and the next change is kept again, with the settings', async ({ page, context, baseURL }) => {
  const files = await clipFrames(4);
  const session = await context.newCDPSession(page);
  await session.send('Storage.overrideQuotaForOrigin', { origin: new URL(baseURL!).origin, quotaSize: 100 });
  await openSegmented(page, files);
  await expect(page.locator('#notice-code')).toHaveText('storage-full');
  await rename(page, 1, 'Ball');
  await expect.poll(() => leaves(page)).toBe(false);
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText('Your work is not kept in this browser. Save the project before you leave.');
  const project = await savedProject(page);
  expect(gunzipSync(project.buffer).toString('latin1')).toContain('Ball');

  await session.send('Storage.overrideQuotaForOrigin', { origin: new URL(baseURL!).origin });
  const unlabelled = page.getByLabel('Leave unexplained pixels unlabelled');
  await openAdvanced(page);
  await unlabelled.check();
  await rename(page, 2, 'Box');
  await kept(page);
  await page.goto('about:blank'); // a reload would keep what the form says
  await openClip(page, files);
  await expect(unlabelled).toBeChecked();
  await expect(page.locator('#objects .motion-name').nth(1)).toHaveValue('Ball');
  await expect(page.locator('#objects .motion-name').nth(2)).toHaveValue('Box');
});

test('a second tab on a clip says that its work is not kept, and overwrites nothing', async ({ page: second, context }) => {
  const first = await context.newPage();
  const files = await clipFrames(4);
  await openSegmented(first, files);
  await kept(first);

  await openClip(second, files);
  await expect(second.locator('#clip-status')).toHaveText('Continued: 2 objects in 4 frames.');
  await expect(second.locator('#notice-code')).toHaveText('open-elsewhere');
  await expect(second.locator('#notice-sentence')).toContainText('“f00 to f03” is open in another tab');
  await rename(second, 1, 'Ball');
  expect(await leaves(second)).toBe(false);
  await openExport(second);
  await expect(second.locator('#project-status')).toHaveText('Your work is not kept in this browser. Save the project before you leave.');
  await second.keyboard.press('Escape');

  // The first tab keeps its own work as before, and that stays when it is gone.
  await rename(first, 2, 'Box');
  await kept(first);
  await first.close();
  await rename(second, 2, 'Square');
  await second.locator('#notice-close').click();
  await hide(second);
  expect(await leaves(second)).toBe(false);

  // The only tab left goes on from there.
  second.on('dialog', (dialog) => void dialog.accept());
  await reopen(second, files);
  await expect(second.locator('#objects .motion-name').nth(2)).toHaveValue('Box');
  await rename(second, 1, 'Ball');
  await kept(second);
  await reopen(second, files);
  for (const [row, name] of [[1, 'Ball'], [2, 'Box']] as const) await expect(second.locator('#objects .motion-name').nth(row)).toHaveValue(name);
});

test('damaged and foreign projects are refused', async () => {
  const header = headerFrom({
    of: 'a clip',
    name: 'clip.png',
    frames: 2,
    saved: '2026-01-01T00:00:00.000Z',
    thumbnail: 'data:image/jpeg;base64,',
    settings: DEFAULT_SETTINGS,
    classList: [],
    range: { first: 0, last: 1 },
    at: 0,
    hidden: [],
    found: 1,
    annotated: false,
    bytes: 3,
  });
  const whole = Buffer.from(await (await fileOf({ header, journal: Uint8Array.of(1, 10, 2) })).arrayBuffer());
  const read = async (bytes: Buffer): Promise<unknown> => projectFromFile(new Blob([new Uint8Array(bytes)]), 'other.veronese').then(({ journal }) => [...journal], ({ code }) => code as unknown);
  expect(await read(whole)).toEqual([1, 10, 2]);
  const text = gunzipSync(whole).toString('latin1');
  const remade = (from: string, to: string): Buffer => {
    expect(text).toContain(from);
    return gzipSync(Buffer.from(text.replace(from, to), 'latin1'));
  };
  const flipped = Buffer.from(whole);
  flipped[Math.floor(flipped.length / 2)]! ^= 1;
  expect(await read(remade('"version":5', '"version":6'))).toBe('newer-project');
  const damaged = [
    Buffer.from(''),
    Buffer.from('not a project'),
    whole.subarray(0, -9),
    flipped,
    remade('"version":5', '"version":4'),
    remade('"frames":2', '"frames":1'),
    remade('data:image/jpeg;', 'data:text/html;'),
    remade('"hidden":[]', '"hidden":[300]'),
    remade('"quality":"best"', '"quality":"other"'),
  ];
  for (const [k, bytes] of damaged.entries()) expect(await read(bytes), `case ${k}`).toBe('damaged-project');
});
