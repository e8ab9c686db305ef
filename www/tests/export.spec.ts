//! Exports match what is on screen: files are downloaded and read, commands and scripts are copied and run.

import { spawnSync } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { type Page } from '@playwright/test';
import { unzipSync } from 'fflate';
import { decodeImage } from 'veronese/codecs';
import { readAnnotations } from 'veronese/formats';

import { type Upload, chooseMotions, clipFrames, differences, done, expect, labelsOnCanvas, motionsChosen, open, openAdvanced, openEmpty, openExport, openSample, pixelsOf, rename, sample, saved, segmentClip, shown, square, test, upload } from './support.js';

/** Clicks a button of the panel that saves a file. */
async function savedBy(page: Page, name: string): Promise<{ name: string; bytes: Buffer }> {
  await openExport(page);
  return saved(page, page.getByRole('button', { name, exact: true }));
}

async function savedAs(page: Page, format: string): Promise<{ name: string; bytes: Buffer }> {
  await openExport(page);
  await page.getByLabel('File format').selectOption({ label: format });
  return savedBy(page, 'Save');
}

/** Opens a pair of a disc and a square, with one mask for each, which is segmented fast. */
async function openPair(page: Page): Promise<Upload[]> {
  const files = await clipFrames(2);
  await openEmpty(page);
  await upload(page, files);
  await shown(page, 'second', 'f01.png');
  return files;
}

/** The red channel of a PNG. */
async function reds(bytes: Uint8Array): Promise<Uint8Array> {
  const { data } = await decodeImage(bytes);
  return Uint8Array.from({ length: data.length / 4 }, (_, p) => data[4 * p]!);
}

test('frames larger than the working size are scaled down, and their masks exported at full size', async ({ page }) => {
  await openEmpty(page);
  await openAdvanced(page);
  await page.getByLabel('Working size').selectOption('640');
  await upload(page, [await square('a.png', 720, 405, 0, 0), await square('b.png', 720, 405, 6, 3)]);
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('a.png, 720 × 405');
  await done(page);
  expect((await pixelsOf(page, '#frame')).width).toBe(640);
  const { width, height } = await decodeImage((await savedBy(page, 'Labels PNG')).bytes);
  expect([width, height]).toEqual([720, 405]);
  const report = JSON.parse((await savedBy(page, 'Result JSON')).bytes.toString()) as { motions: { matrix: number[] }[] };
  const [a11, a12, a13, a21, a22, a23] = report.motions[1]!.matrix as [number, number, number, number, number, number];
  expect(a11 * 400 + a12 * 250 + a13).toBeCloseTo(6, 0);
  expect(a21 * 400 + a22 * 250 + a23).toBeCloseTo(3, 0);
});

test('the copied command and script give the same masks', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const files = await openPair(page);
  await chooseMotions(page, 2);
  await done(page);
  const folder = await mkdtemp(join(tmpdir(), 'veronese-'));
  try {
    for (const { name, buffer } of files) await writeFile(join(folder, name), buffer);

    await openExport(page);
    await page.getByRole('button', { name: 'Copy command' }).click();
    await expect(page.locator('#notice')).toContainText('Copied the command to the clipboard.');
    const command = await page.evaluate(() => navigator.clipboard.readText());
    const program = fileURLToPath(new URL('../../pkg/bin/veronese.js', import.meta.url));
    const words = command.split(' ');
    expect(words.shift()).toBe('veronese');
    const { status } = spawnSync(process.execPath, [program, ...words], { cwd: folder });
    expect(status).toBe(0);
    const { bytes } = await savedBy(page, 'Labels PNG');
    const written = await decodeImage(await readFile(join(folder, 'masks', 'labels.png')));
    expect(differences(written.data, (await decodeImage(bytes)).data)).toBe(0);

    await openExport(page);
    await page.getByRole('button', { name: 'Copy JavaScript' }).click();
    await expect(page.locator('#notice')).toContainText('Copied the JavaScript to the clipboard.');
    const script = (await page.evaluate(() => navigator.clipboard.readText()))
      .replaceAll(/from '(veronese[^']*)'/g, (_, name: string) => `from '${import.meta.resolve(name)}'`)
      .concat('process.stdout.write(Buffer.from(masks));\n');
    await writeFile(join(folder, 'script.mjs'), script);
    const { stdout, stderr } = spawnSync(process.execPath, ['script.mjs'], { cwd: folder, maxBuffer: 2 ** 24 });
    expect(stderr.toString()).toBe('');
    expect(differences(stdout, await labelsOnCanvas(page))).toBe(0);
  } finally {
    await rm(folder, { recursive: true });
  }
});

test('the picture is copied, and a notice confirms a copy in view, on all screens', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await openPair(page);
  await openExport(page);
  // Chromium decodes pictures for the clipboard in a process of its own, which a busy machine may refuse: users press again, too.
  await expect(async () => {
    await page.getByRole('button', { name: 'Copy picture' }).click();
    await expect(page.locator('#notice')).toContainText('Copied the picture to the clipboard.');
    const size = await page.evaluate(async () => {
      const [item] = await navigator.clipboard.read();
      const bitmap = await createImageBitmap(await item!.getType('image/png'));
      return [bitmap.width, bitmap.height];
    });
    expect(size).toEqual([100, 70]);
  }).toPass();

  const notice = page.locator('#notice');
  for (const [width, height] of [[1280, 860], [390, 780]] as const) {
    await page.setViewportSize({ width, height });
    await page.getByRole('button', { name: 'Dismiss' }).click();
    await openExport(page);
    await page.getByRole('button', { name: 'Copy link' }).click();
    await expect(notice).toBeInViewport({ ratio: 1 });
  }
  // A notice that is not an error disappears by itself.
  await page.mouse.move(1, 1); // it stays while the pointer is over it
  await expect(notice).toBeHidden();
});

test('a copied link opens with the same settings and the current sample', { tag: '@soak' }, async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await open(page);
  await chooseMotions(page, 2);
  await done(page);
  await openExport(page);
  await page.getByRole('button', { name: 'Copy link' }).click();
  await expect(page.locator('#notice')).toContainText('Copied the link with the settings to the clipboard.');
  const first = await page.evaluate(() => navigator.clipboard.readText());
  expect(new URL(first).hash).toBe('#sample=intel-two-cars&motions=2&quality=fast&segment=asked&masks=motions');
  await page.goto('about:blank');
  await page.goto(first);
  await done(page);
  await motionsChosen(page, 2);
  await expect(page.getByLabel('Fast')).toBeChecked();
  await expect(page.locator('#motions > li')).toHaveCount(2);
  await expect(page.locator('#look [value=motions]')).toBeChecked();

  await chooseMotions(page, 'Automatic');
  await done(page);
  const copied = async (): Promise<string> => {
    await page.evaluate(() => navigator.clipboard.writeText(''));
    await openExport(page);
    await page.getByRole('button', { name: 'Copy link' }).click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).not.toBe('');
    return page.evaluate(() => navigator.clipboard.readText());
  };
  await openSample(page, 'Parallax');
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('first.png, 400 × 300');
  await done(page);
  expect(new URL(await copied()).hash).toBe('#sample=parallax&quality=fast&segment=asked&masks=motions');

  // With a replaced frame the pair is no longer a sample.
  await page.getByLabel('Replace the second frame').setInputFiles(await sample('first', 'other.png'));
  await expect(page.locator('[data-slot=second] .slot-name')).toContainText('other.png');
  expect(new URL(await copied()).hash).toBe('#quality=fast&segment=asked&masks=motions');

  // Also in a page that is open.
  await page.evaluate(() => (location.hash = '#sample=intel-two-cars&motions=2&masks=groups'));
  await expect(page.locator('.slot-name')).toHaveText(['first.png, 768 × 432', 'second.png, 768 × 432']);
  await done(page);
  await expect(page.locator('#look [value=groups]')).toBeChecked();
  await motionsChosen(page, 2);
});

test('masks are exported as files of their own and in the formats of annotation tools, under their names', async ({ page }) => {
  const [first] = await openPair(page);
  const groups = await labelsOnCanvas(page);
  const { name, bytes } = await savedBy(page, 'All masks');
  expect(name).toBe('masks.zip');
  const files = unzipSync(bytes);
  const numbers = [...new Set(groups)];
  expect(Object.keys(files).sort()).toEqual([...numbers.map((k) => `mask-${k}.png`), 'labels.png', 'result.json'].sort());
  for (const k of numbers) {
    expect(differences(await reds(files[`mask-${k}.png`]!), groups.map((group) => (group === k ? 255 : 0)))).toBe(0);
  }
  expect(JSON.parse(new TextDecoder().decode(files['result.json']))).toMatchObject({ width: 100 });

  await page.keyboard.press('Escape');
  await page.locator('#motions > li').nth(2).locator('.motion-words').click();
  const mask = await savedAs(page, 'Selected mask');
  expect(mask.name).toBe('mask.png');
  expect(differences(await reds(mask.bytes), groups.map((group) => (group === 2 ? 255 : 0)))).toBe(0);

  await page.getByLabel('Opacity').fill('0');
  await page.getByLabel('Outlines').uncheck();
  const overlay = await decodeImage((await savedAs(page, 'Overlay')).bytes);
  expect(differences(overlay.data, (await decodeImage(first!.buffer)).data)).toBe(0);
  await page.getByLabel('Outlines').check();

  await test.step('formats of annotation tools have the objects under their names, but those that are not ticked', async () => {
    await page.keyboard.press('Escape');
    await segmentClip(page);
    const found = await labelsOnCanvas(page);
    await rename(page, 1, 'White car');
    const mask = (id: number): Uint8Array => found.map((object) => (object === id ? 255 : 0));
    const json = async (format: string): Promise<unknown> => JSON.parse((await savedAs(page, format)).bytes.toString());

    // Read back by the package, whose own tests decode what it encodes.
    for (const [format, near] of [['COCO, RLE', 0], ['CVAT', 0], ['COCO, polygons', 0.01]] as const) {
      const { name, bytes } = await savedAs(page, format);
      const { frames, names } = readAnnotations([{ name, bytes }]);
      const labels = frames.get('f00')!.read();
      const [label] = Object.entries(names).find(([, name]) => name === 'White car')!;
      expect(differences(labels.map((one) => (one === Number(label) ? 255 : 0)), mask(1)), format).toBeLessThanOrEqual(near * labels.length);
    }

    // The background is an annotation only where it is asked for.
    const background = page.getByLabel('Also the background');
    const ids = async (): Promise<number[]> => ((await json('COCO, RLE')) as { categories: { id: number }[] }).categories.map(({ id }) => id - 1);
    const objects = [...new Set(found)].filter((object) => object > 0).sort((a, b) => a - b);
    expect(objects.length).toBeGreaterThan(1);
    expect(await ids()).toEqual(objects);
    await background.check();
    expect(await ids()).toEqual([0, ...objects]);
    await background.uncheck();
    await page.getByLabel('File format').selectOption({ label: 'Overlay' });
    await expect(background).toBeHidden();

    const [task] = (await json('Label Studio')) as [{ predictions: { result: { value: { brushlabels: string[]; rle: number[] } }[] }[] }];
    expect(task.predictions[0]!.result.map(({ value }) => value.brushlabels[0])).toContain('White car');
    const yolo = unzipSync((await savedAs(page, 'YOLO segmentation')).bytes);
    const lines = new TextDecoder().decode(yolo['yolo/labels/f00.txt']).trim().split('\n');
    expect(lines.length).toBe(objects.length);
    for (const line of lines) expect(line).toMatch(/^\d+( (0|1|0?\.\d+|\d\.\d+(e-\d+)?)){6,}$/);
    expect(new TextDecoder().decode(yolo['yolo/data.yaml'])).toContain('White car');

    await page.keyboard.press('Escape');
    await page.getByLabel('Show White car').uncheck();
    expect(await ids()).toEqual(objects.slice(1));
    const zip = unzipSync((await savedBy(page, 'All masks')).bytes);
    expect(Object.keys(zip).sort()).toEqual(['labels.png', ...[0, ...objects.slice(1)].map((k) => `mask-${k}.png`)].sort());
  });
});
