//! Masks of annotation tools, imported into a clip as corrections of its frames.

import { type Page } from '@playwright/test';
import { encodePng } from 'veronese/codecs';
import { encode } from 'veronese/formats';

import { type Upload, clipFrames, differences, expect, give, goTo, labelsOnCanvas, masksOf, openEmpty, openExport, openSegmented, said, test, upload } from './support.js';
import { HEIGHT, WIDTH, video } from './video.js';

const SIZE = { width: 100, height: 70 };

const corrected = (page: Page): Promise<void> => said(page, /^Corrected: the masks of \w+ frames have changed\.$/);
const json = (name: string, value: unknown): Upload => ({ name, mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(value)) });
const text = (name: string, content: string): Upload => ({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
const encoded = async (...given: Parameters<typeof encode>): Promise<string> => String((await encode(...given))[0]!.content);

/** The labels with a rectangle as another object. */
function withBox(labels: Uint8Array, id: number, left: number): Uint8Array {
  return labels.map((label, p) => {
    const [x, y] = [p % SIZE.width, Math.floor(p / SIZE.width)];
    return x >= left && x < left + 15 && y >= 45 && y < 60 ? id : label;
  });
}

test('a file of annotations corrects the frames that it is of, in one step that can be undone; masks that are dropped are no frames', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const found = await masksOf(page, [2, 3, 1]);
  // Objects 1 and 2 are gone in frames 2 and 3; there is a third one, and a frame that the clip does not have.
  const nothing = new Uint8Array(SIZE.width * SIZE.height);
  const drawn = [2, 3].map((index) => withBox(nothing, 7, 10 + 2 * index));
  const frames = [...drawn, withBox(nothing, 7, 0)].map((labels, k) => ({ labels, ...SIZE, image: `data/${['f02', 'f03', 'f99'][k]}.jpg` }));
  const document = await encoded('coco', frames, { names: { 7: 'Plate' } });
  await openExport(page);
  await expect(page.locator('#import-masks')).toBeEnabled();
  await page.locator('#import-masks').setInputFiles([text('instances.json', document)]);
  // The notice goes by itself, maybe before all is corrected.
  await expect(page.locator('#notice-sentence')).toHaveText('Took the masks of 2 of 3 frames. No frame with masks here is called f99.');
  await corrected(page);
  await page.keyboard.press('Escape');
  const changes = async (from: readonly Uint8Array[]): Promise<number[]> => (await masksOf(page, [2, 3])).map((labels, k) => differences(labels, from[k]!));
  expect(await changes(drawn)).toEqual([0, 0]);
  // Their class is one of the list from now on.
  await expect(page.locator('#lane-names button')).toContainText(['Plate 7']);
  await expect(page.getByLabel('Class of Plate 7')).toHaveValue('Plate');
  await expect(page.locator('#class-names option')).toHaveText(['Plate']);

  await page.locator('#undo').click();
  await said(page, /^Undone/);
  expect(await changes(found)).toEqual([0, 0]);
  await expect(page.locator('#undo')).toBeDisabled();

  await test.step('masks that are dropped on the clip are no frames, and frames are', async () => {
    const drop = (files: Upload[]): Promise<void> => give(page, 'drop', files);
    const drawn = withBox(found[2]!, 3, 50);
    await drop([{ name: 'f01.png', mimeType: 'image/png', buffer: Buffer.from((await encode('davis', { labels: drawn, ...SIZE }))[0]!.content) }]);
    await corrected(page);
    await goTo(page, 1);
    expect(differences(await labelsOnCanvas(page), drawn)).toBe(0);

    // A file that cannot be taken says why, and changes nothing.
    const notice = page.locator('#notice-sentence');
    await drop([text('f01.json', await encoded('coco', { labels: new Uint8Array(4).fill(1), width: 2, height: 2, image: 'f01.png' }))]);
    await expect(notice).toHaveText('The masks of “f01” are 2 × 2, the frames 100 × 70.');
    await drop([text('f01.json', await encoded('coco', { labels: drawn, ...SIZE, image: 'other.png' }))]);
    await expect(notice).toHaveText('No frame with masks here is called other.');
    await drop([json('f01.json', { shapes: [] })]);
    await expect(notice).toHaveText(/^'f01\.json' is not an annotation in a format that is read/);
    await drop([{ name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('1 2') }, { name: 'b.csv', mimeType: 'text/csv', buffer: Buffer.from('') }]);
    await expect(notice).toHaveText('“b.csv” is not an image that this browser can read.');
    expect(differences(await labelsOnCanvas(page), drawn)).toBe(0);

    await drop((await clipFrames(4)).slice(0, 3));
    await expect(page.locator('#clip-name')).toContainText('3 frames');
    await drop([json('f01.json', {})]);
    await expect(notice).toHaveText('Segment the clip first.');
  });
});

test('masks of which nobody knows how to read them are read as a person chooses', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const [sentence, choices, close] = [page.locator('#notice-sentence'), page.locator('#notice-choices button'), page.locator('#notice-close')];
  const shareAt = (p: number): number => Math.min(1, Math.max(0, (14 - Math.hypot((p % SIZE.width) - 70, Math.floor(p / SIZE.width) - 40)) / 4 + 0.5));
  const soft = Uint8Array.from({ length: SIZE.width * SIZE.height }, (_, p) => Math.round(255 * shareAt(p)));
  const grey = { name: 'f01.png', mimeType: 'image/png', buffer: Buffer.from(await encodePng(SIZE.width, SIZE.height, soft)) };
  await openExport(page);
  await expect(page.locator('#import-masks')).toBeEnabled();
  const choose = async (file: Upload, name: string): Promise<void> => {
    await page.locator('#import-masks').setInputFiles([file]);
    await page.getByRole('button', { name, exact: true }).click();
    await expect(page.locator('#notice')).toBeHidden();
  };
  await page.locator('#import-masks').setInputFiles([grey]);
  await expect(sentence).toHaveText(/^'f01\.png': it has .* levels only between others, as smoothed edges or lossy compression give: save it without\.$/);
  await expect(choices).toHaveText(['Read as a soft mask, above one half', 'Take each level for an object']);
  await close.click();
  await expect(page.locator('#undo')).toBeDisabled();
  await choose(grey, 'Read as a soft mask, above one half');
  await corrected(page);
  const [masks] = await masksOf(page, [1]);
  expect(differences(masks!, soft.map((level) => Number(level >= 128)))).toBe(0);

  const drawn = withBox(new Uint8Array(SIZE.width * SIZE.height), 7, 10);
  const frames = [new Uint8Array(drawn.length), drawn].map((labels, k) => ({ labels, ...SIZE, image: `f0${k}.png` }));
  const gt = text('gt.txt', await encoded('mots', frames, { names: { 7: 'Plate' } }));
  await page.locator('#import-masks').setInputFiles([gt]);
  await expect(sentence).toHaveText("'gt.txt': nothing tells whether its first frame is 0 or 1.");
  await expect(choices).toHaveText(['It is 1', 'It is 0']);
  await close.click();
  await choose(gt, 'It is 0');
  await expect.poll(async () => differences((await masksOf(page, [2]))[0]!.map((label) => (label === 7 ? 7 : 0)), drawn)).toBe(0);
});

test('boxes without masks point to objects; what is left out is said', { tag: '@soak' }, async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const categories = [{ id: 1, name: 'Disc' }];
  const images = ['f01', 'f99'].map((name, k) => ({ id: k + 1, file_name: `${name}.png`, ...SIZE }));
  // The disc of frame 1, a box of a frame that is not there, and an annotation that says nothing.
  const box = { category_id: 1, iscrowd: 0, segmentation: [] };
  const annotations = [{ ...box, id: 1, image_id: 1, bbox: [10, 14, 24, 24] }, { ...box, id: 2, image_id: 2, bbox: [1, 1, 9, 9] }, { id: 3, image_id: 1, category_id: 1, iscrowd: 0 }];
  await give(page, 'drop', [json('boxes.json', { images, annotations, categories })]);
  await expect(page.locator('#notice-sentence')).toHaveText(
    "Took the masks of 1 of 2 frames. No frame with masks here is called f99. 'boxes.json': left out annotations without a mask (1). 'boxes.json': boxes without a mask are prompts (2).",
  );
  await corrected(page);
  await goTo(page, 1);
  await expect(page.locator('#lane-names button')).toContainText([/^Disc/]);
  // YOLO's texts lack the size of their images: it is that of the clip.
  const [lines, names] = await encode('yolo', { labels: withBox(new Uint8Array(SIZE.width * SIZE.height), 1, 50), ...SIZE }, { names: { 1: 'Plate' } });
  await give(page, 'drop', [text('f02.txt', String(lines!.content)), text('classes.txt', String(names!.content))]);
  await corrected(page);
  await expect(page.locator('#class-names option')).toHaveText(['Disc', 'Plate']);
  const labels = await labelsOnCanvas(page);
  const inside = labels.filter((_, p) => Math.hypot((p % SIZE.width) - 24, Math.floor(p / SIZE.width) - 26.2) < 9);
  expect(new Set(inside).size).toBe(1);
  expect([0, 255]).not.toContain(inside[0]);
});

test('the frames of a video are known by their numbers', { tag: '@soak' }, async ({ page }) => {
  await openEmpty(page);
  await openSegmented(page, [await video(page, 6, 'webm', 'vp8')], 6);
  // Frames without a shape are not said: the first that is, is number 4.
  const drawn = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, p) => (p % WIDTH < 40 ? 9 : 0));
  const frames = Array.from({ length: 5 }, (_, k) => ({ labels: k < 4 ? new Uint8Array(drawn.length) : drawn, width: WIDTH, height: HEIGHT }));
  const xml = await encoded('cvat-video', frames, { names: { 9: 'Strip' } });
  await upload(page, [{ name: 'annotations.xml', mimeType: 'application/xml', buffer: Buffer.from(xml) }]);
  await corrected(page);
  await goTo(page, 4);
  expect(differences(await labelsOnCanvas(page), drawn)).toBe(0);
  await expect(page.locator('#notice')).toBeHidden();
});
