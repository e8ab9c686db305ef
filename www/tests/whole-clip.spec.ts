//! Whole clips: objects that keep their numbers, segmented in the background; moving through the frames.

import { type Page } from '@playwright/test';

import { video } from './video.js';
import { type Upload, clipDone, clipInNode, clipPhase, differences, done, drag, enter, expect, goTo, hide, holdBack, kept, labelsOnCanvas, leaves, masksOf, mergeWith, openClip, openEmpty, openSample, openSegmented, reopen, said, savedClip, segmentClip, clipFrames, square, test, upload, withProcessors, withSamples } from './support.js';

/** A stroke over the disc in frame 3, a pixel under it, and a brush for it. */
const OVER_DISC = [[0.26, 0.34], [0.36, 0.45]] as const;
const IN_DISC = 28 * 100 + 31;

async function chooseBrush(page: Page): Promise<void> {
  await page.locator('#tools [name=radius]').fill('4');
}

/** Waits until a frame is on screen with its masks. */
async function shows(page: Page, index: number): Promise<void> {
  await expect(page.locator('#caption')).toHaveText(`Frame ${index}`);
  await done(page);
}

test('the objects of a clip keep number, name and colour in all frames, also when its first run is cancelled at once', async ({ page }) => {
  const files = await clipFrames(6);
  const found = await clipInNode(files);
  // Three workers find the same.
  await withProcessors(page, 4);
  await openClip(page, files);
  await page.evaluate(() => {
    for (const id of ['clip-segment', 'clip-cancel']) document.getElementById(id)!.click();
  });
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText('Cancelled. 0 of 6 frames have masks.');
  await page.getByRole('button', { name: 'Continue' }).click();
  await clipPhase(page, 'done');
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 6 frames.');
  await shows(page, 0);
  expect(differences(await labelsOnCanvas(page), found[0]!)).toBe(0);
  await expect(page.locator('#lane-names button')).toHaveText(['Object 1', 'Object 2']);

  const names = page.locator('#objects .motion-name');
  await expect(names).toHaveCount(3);
  await enter(names.nth(1), 'Ball');
  await expect(page.locator('#lane-names button')).toHaveText(['Ball', 'Object 2']);

  // The keys of a slider go to any frame, the last one too.
  const track = page.getByRole('slider', { name: 'Current frame' });
  await track.press('End');
  await shows(page, 5);
  await expect(track).toHaveAttribute('aria-valuetext', 'Frame 5 of 0–5');
  expect(differences(await labelsOnCanvas(page), found[5]!)).toBe(0);
  await expect(names.nth(1)).toHaveValue('Ball');

  // A press moves the frame, a drag goes on moving it.
  const box = (await track.boundingBox())!;
  const at = (index: number): number => box.x + ((index + 0.5) * box.width) / 6;
  await page.mouse.move(at(1), box.y + 20);
  await page.mouse.down();
  await shows(page, 1);
  await page.mouse.move(at(3), box.y + 20, { steps: 4 });
  await page.mouse.up();
  await shows(page, 3);
  expect(differences(await labelsOnCanvas(page), found[3]!)).toBe(0);
  // The frame beside it has masks of its own, and is seen while the frame is inspected.
  const inspecting = page.locator('#inspect > summary');
  await inspecting.click();
  await page.locator('#inspect [name=frame][value=second]').check();
  await expect(page.locator('#caption')).toHaveText('Frame 4');
  expect(differences(await labelsOnCanvas(page), found[4]!)).toBe(0);
  await inspecting.click();
  await expect(page.locator('#caption')).toHaveText('Frame 3');

  // Nothing is segmented again when the clip is played.
  await page.keyboard.press('k');
  await shows(page, 5);
  await expect(page.getByRole('button', { name: 'Play' })).toBeVisible();
  expect(differences(await labelsOnCanvas(page), found[5]!)).toBe(0);

  // Hidden objects are hidden in every frame.
  await page.getByLabel('Show Ball').uncheck();
  await page.keyboard.press(',');
  await shows(page, 4);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));

  // The button for the least certain frame goes once a person has looked there, until it is another.
  await page.getByLabel('Show Ball').check();
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

test('a video is segmented as a whole, and gives exactly the requested frames meanwhile; it may have one frame', { tag: '@soak' }, async ({ page }) => {
  await openEmpty(page);
  await openClip(page, [await video(page, 6, 'webm', 'vp8')], { count: 6 });
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  const track = page.getByRole('slider', { name: 'Current frame' });
  for (const [key, index] of [['ArrowRight', 1], ['ArrowRight', 2], ['Home', 0]] as const) {
    await track.press(key);
    await shows(page, index);
  }
  await clipPhase(page, 'done');
  await expect(page.locator('#clip-status')).toHaveText(/in 6 frames\.$/);
  await track.press('End');
  await shows(page, 5);
  await expect(page.locator('#notice')).toBeHidden();

  await upload(page, [await video(page, 1, 'webm', 'vp8')]);
  await expect(page.locator('#clip-name')).toHaveText('clip.webm, one frame, 192 × 128');
  await done(page);
});

test('a cancelled clip shows the masks of what is done, takes corrections, and continues from there after a reload', async ({ page }) => {
  const files = await clipFrames(8);
  // More workers would have begun all frames.
  await withProcessors(page, 2);
  await openClip(page, files);
  const goOn = await holdBack(page, 'f03.png');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-detail')).toHaveText(/^3 of 8/);
  await page.locator('#clip-cancel').click();
  await goOn();
  await clipPhase(page, 'cancelled');
  const count = Number(/^Cancelled\. (\d+) of 8 frames have masks\.$/.exec((await page.locator('#clip-status').textContent()) ?? '')?.[1]);
  expect(count).toBeGreaterThan(1);
  expect(count).toBeLessThan(8);
  await expect(page.getByRole('button', { name: 'Continue' })).toBeFocused();
  await goTo(page, count - 1);
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 1, 2]));
  await page.locator('#objects > li').nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).not.toContain(1);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Undone/);
  // Masks that the page has found by itself are kept, too: leaving does not ask for them.
  await kept(page);
  await reopen(page, files);
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText(`Cancelled. ${count} of 8 frames have masks.`);
  // It goes on as far as the last frame, which is held back.
  const release = await holdBack(page, 'f07.png');
  await page.getByRole('button', { name: 'Continue' }).click();
  await expect(page.locator('#clip-detail')).toHaveText(/^7 of 8/);
  // A name given meanwhile is kept at once when the page is hidden.
  const name = page.locator('#objects .motion-name').nth(1);
  await enter(name, 'Early');
  expect(await leaves(page)).toBe(false);
  await hide(page);
  await kept(page);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await release();
  await clipPhase(page, 'done');
  await expect(name).toHaveValue('Early');
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 8 frames.');
});

test('only the frames from the in point to the out point are segmented and exported', async ({ page }) => {
  const files = await clipFrames(7);
  await openClip(page, files);
  const [from, to] = [page.getByRole('slider', { name: 'In point' }), page.getByRole('slider', { name: 'Out point' })];
  await expect(to).toHaveAttribute('aria-valuetext', 'Frame 6');
  const track = page.getByRole('slider', { name: 'Current frame' });
  // The handles cover no frame, from its first pixel to its last.
  const free = await track.evaluate((track) => {
    const { left, right, top } = track.getBoundingClientRect();
    return [left + 1, right - 1].every((x) => track.contains(document.elementFromPoint(x, top + 10)));
  });
  expect(free).toBe(true);
  // The in point by key, the out point by its handle.
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
  await page.mouse.move(box.x + (5 * box.width) / 7, handle.y + handle.height / 2, { steps: 4 });
  await page.mouse.up();
  await expect(to).toHaveAttribute('aria-valuenow', '4');
  await expect(track).toHaveAttribute('aria-valuenow', '2'); // dragging a handle does not move the frame
  await to.press('ArrowRight');
  await to.press('ArrowLeft');
  await page.getByRole('button', { name: 'Segment frames 2–4' }).click();
  await clipPhase(page, 'done');
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 3 frames.');
  for (const index of [2, 4]) {
    await goTo(page, index);
    expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 1, 2]));
  }
  await track.press('Home');
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');

  // A correction in the range.
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await chooseBrush(page);
  await drag(page, ...OVER_DISC);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  expect(new Set(await labelsOnCanvas(page))).toContain(3);
  await page.getByRole('button', { name: 'Undo' }).click();

  const vis = JSON.parse((await savedClip(page, 'YouTube-VIS')).bytes.toString()) as { videos: { file_names: string[] }[] };
  expect(vis.videos[0]!.file_names).toEqual(files.slice(2, 5).map((file) => file.name));
  // Tracks count the frames of the whole video.
  const frames = [...(await savedClip(page, 'CVAT, tracks')).bytes.toString().matchAll(/<polygon frame="(\d+)"[^>]*outside="0"/g)].map(([, frame]) => Number(frame));
  expect(new Set(frames)).toEqual(new Set([2, 3, 4]));
});

test('frames of another size and frames that are all the same are reported', async ({ page }) => {
  const files = await clipFrames(4);
  await openClip(page, [...files.slice(0, 3), await square('f03.png', 120, 90, 0, 0)]);
  // It is told at once.
  await expect(page.locator('#notice-sentence')).toHaveText('“f03.png” is 120 × 90, the first frame 100 × 70: only what is before it can be segmented as a clip.');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
  await page.locator('#notice-close').click();
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipPhase(page, 'failed');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
  await shows(page, 0);
  await page.getByRole('slider', { name: 'Current frame' }).press('End');
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
  await page.getByRole('slider', { name: 'Current frame' }).press('ArrowLeft');
  await shows(page, 2);
  expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);

  // Nothing moves.
  const [{ buffer }] = files as [Upload];
  await upload(page, [0, 1, 2].map((k) => ({ name: `g${k}.png`, mimeType: 'image/png', buffer })));
  await expect(page.locator('#clip-name')).toHaveText('g0 to g2, 3 frames, 100 × 70');
  await segmentClip(page);
  await expect(page.locator('#clip-status')).toHaveText('No objects: all 3 frames are the same, pixel by pixel.');
});

test('a stroke in one frame is carried through the clip and undone; corrections are there again with the clip', async ({ page }) => {
  const files = await clipFrames(6);
  await openSegmented(page, files);
  expect(await leaves(page)).toBe(true);
  const [fourth, third] = await masksOf(page, [4, 3]);
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#objects .motion.selected .motion-name')).toHaveValue('Object 3');
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
  await chooseBrush(page);
  await drag(page, ...OVER_DISC);
  await said(page, /^Corrected: the masks of \w+ frames have changed\.$/);
  const corrected = await labelsOnCanvas(page);
  // Painted pixels are certain.
  expect(corrected[IN_DISC]).toBe(3);
  await goTo(page, 4);
  expect(new Set(await labelsOnCanvas(page))).toContain(3);

  await page.keyboard.press('Control+z');
  await said(page, /^Undone in/);
  expect(differences(await labelsOnCanvas(page), fourth!)).toBe(0);
  await goTo(page, 3);
  expect(differences(await labelsOnCanvas(page), third!)).toBe(0);
  const rows = page.locator('#objects > li');
  await expect(rows).toHaveCount(4); // the new object is selected still
  await page.getByRole('button', { name: 'Redo' }).click();
  await said(page, /^Redone in/);
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);
  await page.getByRole('button', { name: 'Undo' }).click();
  await page.locator('#tools [value=look]').check();
  await rows.nth(1).locator('.thumbnail').click();
  await expect(rows).toHaveCount(3); // an object that was not painted goes

  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(rows).toHaveCount(2);
  await enter(rows.nth(1).locator('.motion-name'), 'Box');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));

  // Another pair, and the clip again.
  await withSamples(page);
  await openSample(page, 'Parallax');
  await expect(page.locator('#clip-name')).toContainText('2 frames');
  await done(page);
  await expect(page.locator('#objects')).toBeHidden();
  await expect.poll(() => leaves(page)).toBe(true);
  await upload(page, files);
  await shows(page, 3); // where it was left
  await expect(rows).toHaveCount(2);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Box');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Object 2');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows).toHaveCount(3);
});

test('the main subject alone is one object, also on the next visit', { tag: '@soak' }, async ({ page }) => {
  const files = await clipFrames(6);
  await openClip(page, files);
  await segmentClip(page);
  const status = page.locator('#clip-status');
  await expect(status).toHaveText('2 objects in 6 frames.');
  const subject = page.getByRole('checkbox', { name: 'Main subject only' });
  await subject.check();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('One object in 6 frames.');
  const found = await clipInNode(files, { quality: 'fast', subject: true });
  const masks = await masksOf(page, [0, 3, 5]);
  [0, 3, 5].forEach((index, k) => expect(differences(masks[k]!, found[index]!)).toBe(0));
  await kept(page);
  await reopen(page, files);
  await expect(subject).toBeChecked();
  await expect(page.locator('#objects > li:not([data-mask="0"])')).toHaveCount(1);
  await subject.uncheck();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('2 objects in 6 frames.');
});

test('corrections are applied again when the clip is segmented again, which leaves the masks until it is done', async ({ page }) => {
  await openSegmented(page, await clipFrames(6));
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  const again = page.getByRole('button', { name: 'Segment the clip again' });
  // Part of the disc is painted as a new object, and the box merged with what is left of it.
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await chooseBrush(page);
  await drag(page, ...OVER_DISC);
  await said(page, /^Corrected/);
  await page.keyboard.press('2');
  await rows.nth(2).locator('summary').click();
  await mergeWith(rows.nth(2), 1);
  await expect(rows).toHaveCount(3);
  await expect(page.locator('#objects .selected')).toHaveAttribute('data-mask', '1');
  await clipDone(page);
  await enter(rows.nth(1).locator('.motion-name'), 'Disc');
  const corrected = await labelsOnCanvas(page);
  expect(new Set(corrected)).toEqual(new Set([0, 1, 3]));
  await again.click();
  await said(page, /^2 objects in 6 frames, corrected as before\.$/);
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);

  // In another quality the objects are found anew, but are the same.
  await page.getByRole('radio', { name: 'Best', exact: true }).check();
  const release = await holdBack(page, 'f02.png');
  await again.click();
  await page.locator('#clip-cancel').click();
  // The masks before stay until then, and if it is cancelled.
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);
  await release();
  await clipPhase(page, 'cancelled');
  await expect(status).toHaveText('Cancelled. 6 of 6 frames have masks.');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);
  await page.locator('#clip-segment').click();
  await said(page, /^2 objects in 6 frames, corrected as before\.$/);
  const best = await labelsOnCanvas(page);
  expect(new Set(best)).toEqual(new Set([0, 1, 3]));
  expect(best[IN_DISC]).toBe(3);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Disc');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect.poll(async () => differences(await labelsOnCanvas(page), corrected)).toBe(0);
});

test('segmenting a part again changes nothing outside it, and both take corrections', async ({ page }) => {
  const files = await clipFrames(6);
  await openSegmented(page, files);
  const rows = page.locator('#objects > li');
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await said(page, /^Corrected/);
  await goTo(page, 5);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, [0.1, 0.8], [0.2, 0.8]);
  await expect.poll(async () => (await labelsOnCanvas(page)).includes(3)).toBe(true); // the status is that of the deletion still
  await clipDone(page);
  const before = await masksOf(page, [1, 5]);
  expect(new Set(before[1])).toEqual(new Set([0, 2, 3]));

  for (const [index, key] of [[2, 'i'], [4, 'o']] as const) {
    await goTo(page, index);
    await page.keyboard.press(key);
  }
  await page.getByRole('button', { name: 'Segment frames 2–4' }).click();
  await said(page, / objects in 6 frames, corrected as before\.$/);
  const after = await masksOf(page, [1, 5, 2, 4]);
  // Corrections are carried across its borders again, so that an edge outside may move by some pixels.
  for (const k of [0, 1]) expect(differences(after[k]!, before[k]!)).toBeLessThan(0.01 * after[k]!.length);
  // The disc is deleted there too, and the box is the object that it was.
  for (const k of [2, 3]) expect([1, 2].map((id) => after[k]!.includes(id))).toEqual([false, true]);
  // A correction is carried through all frames.
  await page.locator('#tools [value=look]').check();
  await page.getByRole('button', { name: 'New object' }).click();
  await goTo(page, 3);
  await drag(page, [0.1, 0.2], [0.2, 0.2]);
  await said(page, /^Corrected/);
  const seen = await masksOf(page, [3, 1, 5]);
  expect(seen.map((labels) => labels.includes(4))).toEqual([true, true, true]);
  // The edit of an object is for the whole clip.
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await said(page, /^Corrected: the masks of 6 frames have changed\.$/);
  const last = await masksOf(page, [3, 5]);
  for (const labels of last) expect(labels).not.toContain(2);
  // All of it is there after a reload, and takes corrections.
  await kept(page);
  await reopen(page, files);
  await said(page, /^Continued/);
  (await masksOf(page, [3, 5])).forEach((labels, k) => expect(differences(labels, last[k]!)).toBe(0));
  await goTo(page, 0);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, [0.1, 0.2], [0.2, 0.2]);
  await said(page, /^Corrected/);
});
