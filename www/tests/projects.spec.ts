//! Projects: what is done with a clip is kept in the browser and as a file, and is there when the same frames are opened again.

import { gunzipSync, gzipSync } from 'node:zlib';

import { type Page } from '@playwright/test';

import type { Clip } from '../src/clips/clip.js';
import { packed } from '../src/correction/runs.js';
import { fileOf, projectFromFile } from '../src/projects/file.js';
import type { Project } from '../src/projects/project.js';
import { DEFAULT_SETTINGS } from '../src/state/settings.js';
import { type Span, type TrackedFrame, untracked, versionOf } from '../src/state/tracked.js';
import { type Upload, clipDone, clipFrames, differences, drag, enter, expect, goTo, hide, holdBack, kept, labelsOnCanvas, leaves, masksOf, openAdvanced, openClip, openExport, openSegmented, projectsInBrowser, reloadEmpty, rename, reopen, said, savedProject, test, upload } from './support.js';

/** The names of objects in the only project of the browser; undefined before there is one. */
async function namesInBrowser(page: Page): Promise<unknown> {
  const [, project] = (await projectsInBrowser(page)).join('').split('\n');
  return project === undefined ? undefined : (JSON.parse(project) as { clip: { names: unknown } }).clip.names;
}

/** A segmented clip with a name and a correction. Gives the masks of its first and its last frame. */
async function correctedClip(page: Page, files: Upload[]): Promise<Uint8Array[]> {
  await openSegmented(page, files);
  await rename(page, '#objects', 2, 'Box');
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
  const remove = async (): Promise<void> => page.evaluate(async () => (await navigator.storage.getDirectory()).removeEntry('projects', { recursive: true }));
  await expect(remove).toPass();
}

test('a corrected clip is there after a reload, and can be corrected further', async ({ page }) => {
  const files = await clipFrames(4);
  const masks = await correctedClip(page, files);
  await goTo(page, 2);
  await page.getByLabel('Show Box').uncheck();
  await expect.poll(async () => (await projectsInBrowser(page)).join('')).toContain('"hidden":[2]');
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
  expect(await leaves(page)).toBe(false);
  await kept(page);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');

  // A write that was ended leaves a file that is no project.
  await page.evaluate(async () => {
    const folder = await (await navigator.storage.getDirectory()).getDirectoryHandle('projects');
    for await (const name of folder.keys()) {
      const content = await (await folder.getFileHandle(name)).getFile();
      const swap = await (await folder.getFileHandle(`${name}.1.crswap`, { create: true })).createWritable();
      await swap.write(content);
      await swap.close();
    }
  });
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
  expect(JSON.parse(header!)).toMatchObject({ format: 'veronese-project', version: 4, name: 'f00 to f03', frames: 4 });

  await openExport(page);
  await page.getByText('One project in this browser').click();
  await page.getByRole('button', { name: 'Forget the project of f00 to f03' }).click();
  await expect(page.locator('#notice')).toContainText('The project of “f00 to f03” is forgotten.');
  await expect(page.locator('#projects')).toBeHidden();
  await reopen(page, files);
  await expect(page.locator('#kind-objects')).toBeHidden();
  // A damaged one changes nothing.
  await upload(page, [{ ...project, name: 'other.veronese', buffer: project.buffer.subarray(0, -9) }]);
  await expect(page.locator('#notice-code')).toHaveText('damaged-project');
  await expect(page.locator('#notice-sentence')).toContainText('“other.veronese”');
  await expect(page.locator('#kind-objects')).toBeHidden();
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

for (const [lack, tag, remove] of [
  ['has no private file system', [], () => delete (StorageManager.prototype as { getDirectory?: unknown }).getDirectory],
  ['cannot write it', ['@soak'], () => delete (FileSystemFileHandle.prototype as { createWritable?: unknown }).createWritable],
] as const) {
  test(`projects are in a database if the browser ${lack}`, { tag: [...tag] }, async ({ page }) => {
    await page.addInitScript(remove);
    const files = await clipFrames(4);
    const masks = await correctedClip(page, files);
    await kept(page);
    await reopen(page, files);
    await isContinued(page, masks, 4);
    await openExport(page);
    await page.getByText('One project in this browser').click();
    await page.getByRole('button', { name: 'Forget the project' }).click();
    await expect(page.locator('#projects')).toBeHidden();
  });
}

test('a full disk loses nothing, and the next change is kept again, with the settings', async ({ page, context, baseURL }) => {
  const files = await clipFrames(4);
  await openSegmented(page, files);
  const unlabelled = page.getByLabel('Leave unexplained pixels unlabelled');
  await openAdvanced(page);
  await unlabelled.check();
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
  const files = await clipFrames(4);
  await openSegmented(first, files);
  await kept(first);

  await openClip(second, files);
  await expect(second.locator('#clip-status')).toHaveText('Continued: 2 objects in 4 frames.');
  await expect(second.locator('#notice-code')).toHaveText('open-elsewhere');
  await expect(second.locator('#notice-sentence')).toContainText('“f00 to f03” is open in another tab');
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

test('damaged and foreign projects are refused', async () => {
  const runs = packed(Uint8Array.of(0, 1, 1, 0, 0, 0), 6, 1);
  const masks: TrackedFrame = { runs, objects: [{ id: 1, pixels: 2, bbox: [1, 0, 2, 1], confidence: 0.9, matrix: null }], background: null };
  const state: Span = { range: { first: 0, last: 1 }, state: new Blob(['state']), numbers: new Map([[1, 1]]) };
  const version = { ...versionOf(untracked({ count: 2 } as Clip)), frames: [masks, { ...masks }], found: [runs, runs], spans: [state], longestSide: 6, largest: 1 };
  const project: Project = {
    of: 'a clip',
    name: 'clip.png',
    frames: 2,
    thumbnail: 'data:image/jpeg;base64,',
    settings: DEFAULT_SETTINGS,
    classList: [],
    clip: { ...version, range: state.range, past: [], future: [], at: 0, hidden: [], solved: null },
  };
  const whole = Buffer.from(await (await fileOf(project, new Date())).arrayBuffer());
  const read = async (bytes: Buffer): Promise<unknown> => projectFromFile(new Blob([new Uint8Array(bytes)]), 'other.veronese').then(() => 'read', ({ code }) => code as unknown);
  expect(await read(whole)).toBe('read');

  const lines = gunzipSync(whole).toString('latin1').split('\n');
  const remade = (line: number, from: string | RegExp, to: string): Buffer => {
    const changed = lines.with(line, lines[line]!.replace(from, to));
    expect(changed[line]).not.toBe(lines[line]);
    return gzipSync(Buffer.from(changed.join('\n'), 'latin1'));
  };
  const flipped = Buffer.from(whole);
  flipped[Math.floor(flipped.length / 2)]! ^= 1;
  expect(await read(remade(0, '"version":4', '"version":5'))).toBe('newer-project');
  const damaged = [
    Buffer.from(''),
    Buffer.from('not a project'),
    whole.subarray(0, -9),
    flipped,
    remade(0, '"version":4', '"version":3'),
    remade(0, '"frames":2', '"frames":1'),
    remade(0, 'data:image/jpeg;', 'data:text/html;'),
    remade(1, /\{"image":\d+\}/, '{"image":999}'),
    remade(2, '"confidence"', '"confident"'),
    remade(2, '[6,1,', '[6,2,'),
  ];
  for (const [k, bytes] of damaged.entries()) expect(await read(bytes), `case ${k}`).toBe('damaged-project');
});
