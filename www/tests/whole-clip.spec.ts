//! Whole clips: objects that keep their numbers, segmented in the background; moving through the frames.

import { readFile } from 'node:fs/promises';

import { type Page } from '@playwright/test';

import { PALETTE } from '../src/drawing/palette.js';
import { video } from './video.js';
import { clipFrames, clipInNode, clipPhase, differences, done, expect, labelsOnCanvas, mergeWith, openClip, openEmpty, openExport, segmentClip, square, test, upload, withProcessors, withSamples } from './support.js';

/** Waits until a frame is on screen with its masks. */
async function shows(page: Page, index: number): Promise<void> {
  await expect(page.locator('#caption')).toHaveText(`Frame ${index}`);
  await done(page);
}

test('the objects of a clip keep number, name and colour in all frames', async ({ page }) => {
  const files = await clipFrames(8);
  const found = await clipInNode(files);
  // Three workers find the same.
  await withProcessors(page, 4);
  await openClip(page, files);
  await expect(page.locator('#kind-objects')).toBeHidden();
  await segmentClip(page);
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 8 frames.');
  await shows(page, 0);
  expect(differences(await labelsOnCanvas(page), found[0]!)).toBe(0);
  await expect(page.locator('#lane-names button')).toHaveText(['Object 1', 'Object 2']);

  const names = page.locator('#objects .motion-name');
  await expect(names).toHaveCount(3);
  await names.nth(1).fill('Ball');
  await names.nth(1).press('Enter');
  await expect(page.locator('#lane-names button')).toHaveText(['Ball', 'Object 2']);

  // The keys of a slider go to any frame, the last one too.
  const track = page.getByRole('slider', { name: 'Current frame' });
  await track.press('End');
  await shows(page, 7);
  await expect(track).toHaveAttribute('aria-valuetext', 'Frame 7 of 0–7');
  expect(differences(await labelsOnCanvas(page), found[7]!)).toBe(0);
  await expect(names.nth(1)).toHaveValue('Ball');

  // A press moves the frame, a drag goes on moving it.
  const box = (await track.boundingBox())!;
  const at = (index: number): number => box.x + ((index + 0.5) * box.width) / 8;
  await page.mouse.move(at(2), box.y + 20);
  await page.mouse.down();
  await shows(page, 2);
  await page.mouse.move(at(4), box.y + 20, { steps: 4 });
  await page.mouse.up();
  await shows(page, 4);
  expect(differences(await labelsOnCanvas(page), found[4]!)).toBe(0);
  // The second frame keeps its distance, and has masks of its own.
  await expect(page.locator('#clip-second-at')).toHaveText('#5');
  await page.locator('#look [name=frame][value=second]').check();
  await expect(page.locator('#caption')).toHaveText('Frame 5');
  expect(differences(await labelsOnCanvas(page), found[5]!)).toBe(0);
  await page.locator('#look [name=frame][value=first]').check();

  // Nothing is segmented again when the clip is played.
  await page.keyboard.press('k');
  await shows(page, 7);
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
  expect(differences(await labelsOnCanvas(page), found[7]!)).toBe(0);

  // Hidden objects are hidden in every frame.
  await page.getByLabel('Show Ball').uncheck();
  await page.keyboard.press(',');
  await shows(page, 6);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));

  // The pair is still there.
  await page.locator('#look [value=groups]').check();
  await expect(page.locator('#motions > li')).toHaveCount(3);
  await done(page);
  await page.locator('#look [value=objects]').check();
  await shows(page, 6);
  await expect(names.nth(1)).toHaveValue('Ball');
});

test('a video is segmented as a whole, and gives exactly the requested frames meanwhile', async ({ page }) => {
  await openEmpty(page, 'groups');
  await openClip(page, [await video(page, 10, 'webm', 'vp8')], { count: 10 });
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  const track = page.getByRole('slider', { name: 'Current frame' });
  for (const [key, index] of [['ArrowRight', 1], ['ArrowRight', 2], ['Home', 0]] as const) {
    await track.press(key);
    await expect(page.locator('[data-slot=first] .slot-name')).toContainText(`#${index},`);
  }
  await clipPhase(page, 'done');
  await expect(page.locator('#clip-status')).toHaveText(/in 10 frames\.$/);
  await track.press('End');
  await shows(page, 9);
  await expect(page.locator('#notice')).toBeHidden();
});

test('a cancelled clip shows the masks of what is done, takes corrections, and continues from there', async ({ page }) => {
  const files = await clipFrames(10);
  const found = await clipInNode(files);
  // More workers would have begun all frames.
  await withProcessors(page, 2);
  await openClip(page, files);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-detail')).toContainText('left');
  await page.locator('#clip-cancel').click();
  await clipPhase(page, 'cancelled');
  const kept = Number(/^Cancelled\. (\d+) of 10 frames have masks\.$/.exec((await page.locator('#clip-status').textContent()) ?? '')?.[1]);
  expect(kept).toBeGreaterThan(1);
  expect(kept).toBeLessThan(10);
  await expect(page.getByRole('button', { name: 'Continue' })).toBeFocused();
  // The same masks as of a clip that ends there.
  const shorter = await clipInNode(files.slice(0, kept));
  await shows(page, 0);
  expect(differences(await labelsOnCanvas(page), shorter[0]!)).toBe(0);
  await goTo(page, kept - 1);
  expect(differences(await labelsOnCanvas(page), shorter[kept - 1]!)).toBe(0);
  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).not.toContain(1);
  await page.getByRole('button', { name: 'Undo' }).click();
  await page.getByRole('button', { name: 'Continue' }).click();
  const continued = /^(\d+) of/.exec((await page.locator('#clip-detail').textContent()) ?? '')?.[1];
  expect(Number(continued)).toBeGreaterThanOrEqual(kept);
  await clipPhase(page, 'done');
  await goTo(page, 0);
  expect(differences(await labelsOnCanvas(page), found[0]!)).toBe(0);
});

test('a clip that is cancelled before its first frame can be segmented', async ({ page }) => {
  const files = await clipFrames(4);
  const found = await clipInNode(files);
  await openClip(page, files);
  await page.evaluate(() => {
    for (const id of ['clip-segment', 'clip-cancel']) document.getElementById(id)!.click();
  });
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText('Cancelled. 0 of 4 frames have masks.');
  await page.getByRole('button', { name: 'Continue' }).click();
  await clipPhase(page, 'done');
  await shows(page, 0);
  expect(differences(await labelsOnCanvas(page), found[0]!)).toBe(0);
});

test('only the frames from the in point to the out point are segmented and exported', async ({ page }) => {
  const files = await clipFrames(9);
  const found = await clipInNode(files.slice(2, 7));
  await openClip(page, files);
  const [from, to] = [page.getByRole('slider', { name: 'In point' }), page.getByRole('slider', { name: 'Out point' })];
  await expect(to).toHaveAttribute('aria-valuetext', 'Frame 8');
  // The in point by key, the out point by its handle.
  const track = page.getByRole('slider', { name: 'Current frame' });
  for (const index of [1, 2]) {
    await track.press('ArrowRight');
    await expect(track).toHaveAttribute('aria-valuenow', String(index));
  }
  await page.keyboard.press('i');
  await expect(from).toHaveAttribute('aria-valuenow', '2');
  const box = (await track.boundingBox())!;
  const handle = (await to.boundingBox())!;
  await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + (7 * box.width) / 9, handle.y + handle.height / 2, { steps: 4 });
  await page.mouse.up();
  await expect(to).toHaveAttribute('aria-valuenow', '6');
  await expect(track).toHaveAttribute('aria-valuenow', '2'); // dragging a handle does not move the frame
  await to.press('ArrowRight');
  await to.press('ArrowLeft');
  await page.getByRole('button', { name: 'Segment frames 2–6' }).click();
  await clipPhase(page, 'done');
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 5 frames.');
  for (const index of [2, 6]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), found[index - 2]!)).toBe(0);
  }
  await track.press('Home');
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');

  // A correction in the range.
  await goTo(page, 4);
  await page.getByRole('button', { name: 'New object' }).click();
  await paint(page, [0.2, 0.3], [0.32, 0.46]);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).toContain(3);
  await page.getByRole('button', { name: 'Undo' }).click();

  const saved = async (format: string): Promise<Buffer> => {
    await openExport(page);
    await page.getByLabel('Format of the clip').selectOption({ label: format });
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save clip' }).click()]);
    return readFile(await download.path());
  };
  const vis = JSON.parse((await saved('YouTube-VIS')).toString()) as { videos: { file_names: string[] }[] };
  expect(vis.videos[0]!.file_names).toEqual(files.slice(2, 7).map((file) => file.name));
  // Tracks count the frames of the whole video.
  const frames = [...(await saved('CVAT, tracks')).toString().matchAll(/<polygon frame="(\d+)"[^>]*outside="0"/g)].map(([, frame]) => Number(frame));
  expect(new Set(frames)).toEqual(new Set([2, 3, 4, 5, 6]));
});

test('a frame of another size ends the clip, and the frames before it have masks', async ({ page }) => {
  const files = await clipFrames(6);
  await openClip(page, [...files.slice(0, 5), await square('f05.png', 120, 90, 0, 0)]);
  // It is told at once.
  await expect(page.locator('#notice-sentence')).toHaveText('“f05.png” is 120 × 90, the first frame 200 × 140: only what is before it can be segmented as a clip.');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
  await page.locator('#notice-close').click();
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipPhase(page, 'failed');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
  await shows(page, 0);
  await page.getByRole('slider', { name: 'Current frame' }).press('End');
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
  await page.getByRole('slider', { name: 'Current frame' }).press('ArrowLeft');
  await shows(page, 4);
  expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
});

/** Paints a stroke; positions are shares of the picture. */
async function paint(page: Page, from: readonly [number, number], to: readonly [number, number]): Promise<void> {
  await page.locator('.layers').scrollIntoViewIfNeeded();
  const box = (await page.locator('.layers').boundingBox())!;
  await page.mouse.move(box.x + from[0] * box.width, box.y + from[1] * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + to[0] * box.width, box.y + to[1] * box.height, { steps: 6 });
  await page.mouse.up();
}

async function goTo(page: Page, index: number): Promise<void> {
  const track = page.getByRole('slider', { name: 'Current frame' });
  const box = (await track.boundingBox())!;
  const count = Number(await track.getAttribute('aria-valuemax')) + 1;
  await track.click({ position: { x: ((index + 0.5) * box.width) / count, y: 10 } });
  await shows(page, index);
}

test('a stroke in one frame is carried through the clip, and can be undone', async ({ page }) => {
  const files = await clipFrames(8);
  const found = await clipInNode(files);
  await openClip(page, files);
  await segmentClip(page);
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#objects .motion.selected .motion-name')).toHaveValue('Object 3');
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
  // Over the disc, whose centre is at (0.2 · 200 + 12, 0.36 · 140 + 3).
  await paint(page, [0.2, 0.3], [0.32, 0.46]);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of \w+ frames have changed\.$/);
  const corrected = await labelsOnCanvas(page);
  // What was painted is certain.
  expect(corrected[Math.round(0.38 * 140) * 200 + Math.round(0.26 * 200)]).toBe(3);
  await goTo(page, 4);
  expect(new Set(await labelsOnCanvas(page))).toContain(3);

  await page.keyboard.press('Control+z');
  await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
  expect(differences(await labelsOnCanvas(page), found[4]!)).toBe(0);
  await goTo(page, 3);
  expect(differences(await labelsOnCanvas(page), found[3]!)).toBe(0);
  await expect(page.locator('#objects .motion')).toHaveCount(4); // the new object is selected still
  await page.getByRole('button', { name: 'Redo' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Redone in/);
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);
});

test('objects are merged and deleted in the whole clip, and the corrections are restored with it', async ({ page }) => {
  const files = await clipFrames(6);
  const merged = await clipInNode(files, { quality: 'fast', edits: { merge: [[1, 2]] } });
  await openClip(page, files);
  await segmentClip(page);
  const leaves = (): Promise<boolean> => page.evaluate(() => window.dispatchEvent(new Event('beforeunload', { cancelable: true })));
  expect(await leaves()).toBe(true);

  const rows = page.locator('#objects > li');
  await rows.nth(2).locator('summary').click();
  await mergeWith(rows.nth(2), 1);
  await expect(rows).toHaveCount(2);
  await expect(page.locator('#clip-status')).toHaveText('Corrected: the masks of 6 frames have changed.');
  for (const index of [0, 5]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), merged[index]!)).toBe(0);
  }
  // It is kept as a project.
  await expect.poll(leaves).toBe(true);

  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows).toHaveCount(3);
  expect(await leaves()).toBe(true);
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(rows).toHaveCount(2);
  await rows.nth(1).locator('.motion-name').fill('Box');
  await rows.nth(1).locator('.motion-name').press('Enter');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));

  // Another pair, and the clip again.
  await withSamples(page);
  await page.getByRole('button', { name: 'Parallax' }).click();
  await expect(page.locator('#timeline')).toBeHidden();
  await done(page);
  await expect(page.locator('#objects')).toBeHidden();
  await expect.poll(leaves).toBe(true);
  await upload(page, files);
  await shows(page, 0);
  await expect(rows).toHaveCount(2);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Box');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Object 2');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows).toHaveCount(3);
});

test('corrections are applied again when the clip is segmented again', async ({ page }) => {
  const files = await clipFrames(6);
  await openClip(page, files);
  await segmentClip(page);
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  // The box is deleted, part of the disc painted as a new object, and merged with what is left of it.
  await rows.nth(2).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await expect(rows).toHaveCount(2);
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await paint(page, [0.2, 0.3], [0.32, 0.46]);
  await expect(status).toHaveText(/^Corrected/);
  await rows.nth(1).locator('.motion-name').fill('Disc');
  await rows.nth(1).locator('.motion-name').press('Enter');
  const corrected = await labelsOnCanvas(page);
  expect(new Set(corrected)).toEqual(new Set([0, 1, 3]));
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('2 objects in 6 frames, corrected as before.');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);

  // In another quality the objects are found anew, but are the same.
  await page.getByRole('radio', { name: 'Best', exact: true }).check();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0); // the masks before stay until then
  await clipPhase(page, 'done');
  await expect(status).toHaveText('2 objects in 6 frames, corrected as before.');
  const best = await labelsOnCanvas(page);
  expect(new Set(best)).toEqual(new Set([0, 1, 3]));
  expect(best[Math.round(0.38 * 140) * 200 + Math.round(0.26 * 200)]).toBe(3);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Disc');
  // What was merged stays merged, and it is selected.
  await rows.nth(2).locator('summary').click();
  await mergeWith(rows.nth(2), 1);
  await expect(rows).toHaveCount(2);
  await expect(status).toHaveText(/^Corrected/);
  await expect(page.locator('#objects .selected')).toHaveAttribute('data-mask', '1');
  await expect.poll(() => page.locator('#strokes').evaluate((strokes) => strokes.style.getPropertyValue('--colour'))).toBe(`rgb(${PALETTE[1]!.join(' ')})`);
  await page.getByRole('radio', { name: 'Fast', exact: true }).check();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('One object in 6 frames, corrected as before.');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 1]));
  await page.getByRole('button', { name: 'Undo' }).click();
  expect(differences(await labelsOnCanvas(page), best)).toBeGreaterThan(0);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect.poll(async () => differences(await labelsOnCanvas(page), best)).toBe(0);
});

test('segmenting a part again changes nothing outside it, and both take corrections', async ({ page }) => {
  const files = await clipFrames(9);
  await openClip(page, files);
  await segmentClip(page);
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(status).toHaveText(/^Corrected/);
  await goTo(page, 7);
  await page.getByRole('button', { name: 'New object' }).click();
  await paint(page, [0.1, 0.8], [0.2, 0.8]);
  await expect(status).toHaveText(/^Corrected/);
  const before: Uint8Array[] = [];
  for (let index = 0; index < 9; index++) {
    await goTo(page, index);
    before.push(await labelsOnCanvas(page));
  }
  expect(new Set(before[7])).toEqual(new Set([0, 2, 3]));

  await goTo(page, 3);
  await page.keyboard.press('i');
  await goTo(page, 5);
  await page.keyboard.press('o');
  await page.getByRole('button', { name: 'Segment frames 3–5' }).click();
  await expect(status).toHaveText(/ objects in 9 frames, corrected as before\.$/);
  // The disc is deleted there too, and the box is the object that it was.
  for (let index = 0; index < 9; index++) {
    await goTo(page, index);
    const now = await labelsOnCanvas(page);
    if (index < 3 || index > 5) expect(differences(now, before[index]!)).toBe(0);
    else expect(new Set(now)).toEqual(new Set([0, 2]));
  }
  // A correction is carried through the frames that were segmented with its own, and no others.
  await page.locator('#tools [value=look]').check();
  await page.getByRole('button', { name: 'New object' }).click();
  await goTo(page, 4);
  await paint(page, [0.1, 0.2], [0.2, 0.2]);
  await expect(status).toHaveText(/^Corrected/);
  const seen: number[] = [];
  for (let index = 0; index < 9; index++) {
    await goTo(page, index);
    if (new Set(await labelsOnCanvas(page)).has(4)) seen.push(index);
  }
  expect(seen).toContain(4);
  expect(seen.filter((index) => index < 3 || index > 5)).toEqual([]);
  // The edit of an object is for the whole clip.
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await expect(status).toHaveText('Corrected: the masks of 9 frames have changed.');
  for (const index of [0, 4, 8]) {
    await goTo(page, index);
    expect(new Set(await labelsOnCanvas(page))).not.toContain(2);
  }
  // All of it is there after a reload.
  const last = await labelsOnCanvas(page);
  await expect.poll(() => page.evaluate(() => window.dispatchEvent(new Event('beforeunload', { cancelable: true })))).toBe(true); // kept
  await page.reload();
  await upload(page, files);
  await expect(status).toHaveText(/^Continued/);
  await goTo(page, 8);
  expect(differences(await labelsOnCanvas(page), last)).toBe(0);
  await goTo(page, 0);
  await page.getByRole('button', { name: 'New object' }).click();
  await paint(page, [0.1, 0.2], [0.2, 0.2]);
  await expect(status).toHaveText(/^Corrected/);
});

test('a run that is cancelled early leaves the masks that there were', async ({ page }) => {
  const files = await clipFrames(8);
  const found = await clipInNode(files);
  await openClip(page, files);
  await segmentClip(page);
  await page.getByRole('radio', { name: 'Best', exact: true }).check();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(page.locator('#clip-detail')).toContainText('left');
  await page.locator('#clip-cancel').click();
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText('Cancelled. 8 of 8 frames have masks.');
  for (const index of [0, 7]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), found[index]!)).toBe(0);
  }
});

test('frames that are the same are given as the reason why nothing moves', async ({ page }) => {
  const [{ buffer }] = (await clipFrames(1)) as [Awaited<ReturnType<typeof clipFrames>>[number]];
  await openClip(page, [0, 1, 2].map((k) => ({ name: `f${k}.png`, mimeType: 'image/png', buffer })));
  await expect(page.locator('#status')).toHaveText('Both frames are the same, pixel by pixel: nothing moves.');
  await segmentClip(page);
  await expect(page.locator('#clip-status')).toHaveText('No objects: all 3 frames are the same, pixel by pixel.');
  await upload(page, await clipFrames(3));
  await expect(page.locator('#clip-name')).toHaveText('f00-f02.png, 3 frames, 200 × 140');
  await done(page);
  await expect(page.locator('#status')).toHaveText(/^2 objects found/);
});

test('a clip may have one frame', async ({ page }) => {
  await openEmpty(page, 'groups');
  await upload(page, [await video(page, 1, 'webm', 'vp8')]);
  await expect(page.locator('#clip-name')).toHaveText('clip.webm, one frame, 192 × 128');
  await done(page);
});

test('the button for the least certain frame goes once a person has looked there, until it is another', async ({ page }) => {
  const files = await clipFrames(6);
  await openClip(page, files);
  await segmentClip(page);
  const row = page.locator('#objects > li').nth(1);
  const check = row.locator('[data-action=doubtful]');
  await row.locator('.thumbnail').click();
  const index = Number(/^Check #(\d)$/.exec((await check.textContent())!)![1]);
  await check.click();
  await shows(page, index);
  await expect(row).toHaveClass(/selected/);
  await expect(check).toBeHidden();
  await expect(page.locator('.layers')).toBeFocused();
  const other = page.locator('#objects > li').nth(2);
  await other.locator('.thumbnail').click();
  await expect(other.locator('[data-action=doubtful]')).toBeVisible();
  await row.locator('.thumbnail').click();
  await goTo(page, (index + 3) % 6);
  await expect(check).toBeHidden();
});
