//! Whole clips: objects that keep their numbers, segmented in the background; moving through the frames.

import { type Page } from '@playwright/test';
import { encodeColourPng } from 'veronese/codecs';

import { PALETTE } from '../src/drawing/palette.js';
import { video } from './video.js';
import { type Upload, cancelWhen, clipDone, clipFrames, clipInNode, clipPhase, differences, done, drag, enter, expect, goTo, hide, holdBack, kept, labelsOnCanvas, leaves, masksOf, mergeWith, openClip, openEmpty, openSample, openSegmented, reopen, savedClip, segmentClip, smallFrames, square, test, upload, withProcessors, withSamples } from './support.js';

/** Larger ones for strokes, with a stroke over the disc in frame 3 and a pixel under it, and a brush for them. */
const [WIDTH, HEIGHT] = [120, 84];
const largerFrames = (count: number): Promise<Upload[]> => clipFrames(count, WIDTH, HEIGHT);
const OVER_DISC = [[30 / WIDTH, 29 / HEIGHT], [41 / WIDTH, 38 / HEIGHT]] as const;
const IN_DISC = 33 * WIDTH + 36;

async function chooseBrush(page: Page): Promise<void> {
  await page.locator('#tools [name=radius]').fill('4');
}

/** Waits until a frame is on screen with its masks. */
async function shows(page: Page, index: number): Promise<void> {
  await expect(page.locator('#caption')).toHaveText(`Frame ${index}`);
  await done(page);
}

test('the objects of a clip keep number, name and colour in all frames, also when its first run is cancelled at once', async ({ page }) => {
  const files = await smallFrames(6);
  const found = await clipInNode(files);
  // Three workers find the same.
  await withProcessors(page, 4);
  await openClip(page, files);
  await expect(page.locator('#kind-objects')).toBeHidden();
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
  // The second frame keeps its distance, and has masks of its own.
  await expect(page.locator('#clip-second-at')).toHaveText('#4');
  await page.locator('#look [name=frame][value=second]').check();
  await expect(page.locator('#caption')).toHaveText('Frame 4');
  expect(differences(await labelsOnCanvas(page), found[4]!)).toBe(0);
  await page.locator('#look [name=frame][value=first]').check();

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

  // The pair is still there.
  await page.locator('#look [value=groups]').check();
  await expect(page.locator('#motions > li')).toHaveCount(3);
  await done(page);
  await page.locator('#look [value=objects]').check();
  await shows(page, 4);
  await expect(names.nth(1)).toHaveValue('Ball');

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

test('a video is segmented as a whole, and gives exactly the requested frames meanwhile; it may have one frame', async ({ page }) => {
  await openEmpty(page, 'groups');
  await openClip(page, [await video(page, 6, 'webm', 'vp8')], { count: 6 });
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  const track = page.getByRole('slider', { name: 'Current frame' });
  for (const [key, index] of [['ArrowRight', 1], ['ArrowRight', 2], ['Home', 0]] as const) {
    await track.press(key);
    await expect(page.locator('[data-slot=first] .slot-name')).toContainText(`#${index},`);
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
  const files = await smallFrames(8);
  const found = await clipInNode(files);
  // More workers would have begun all frames.
  await withProcessors(page, 2);
  await openClip(page, files);
  await cancelWhen(page, /^[2-7] of 8/);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipPhase(page, 'cancelled');
  const count = Number(/^Cancelled\. (\d+) of 8 frames have masks\.$/.exec((await page.locator('#clip-status').textContent()) ?? '')?.[1]);
  expect(count).toBeGreaterThan(1);
  expect(count).toBeLessThan(8);
  await expect(page.getByRole('button', { name: 'Continue' })).toBeFocused();
  // The same masks as of a clip that ends there.
  const shorter = await clipInNode(files.slice(0, count));
  await shows(page, 0);
  expect(differences(await labelsOnCanvas(page), shorter[0]!)).toBe(0);
  await goTo(page, count - 1);
  expect(differences(await labelsOnCanvas(page), shorter[count - 1]!)).toBe(0);
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
  expect(Number(/^(\d+) of/.exec((await page.locator('#clip-detail').textContent()) ?? '')?.[1])).toBeGreaterThanOrEqual(count);
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
  await goTo(page, 0);
  expect(differences(await labelsOnCanvas(page), found[0]!)).toBe(0);
});

test('only the frames from the in point to the out point are segmented and exported', async ({ page }) => {
  const files = await largerFrames(7);
  const found = await clipInNode(files.slice(2, 5));
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
    expect(differences(await labelsOnCanvas(page), found[index - 2]!)).toBe(0);
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
  const files = await smallFrames(4);
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
  await expect(page.locator('#clip-name')).toHaveText('g0-g2.png, 3 frames, 100 × 70');
  await expect(page.locator('#status')).toHaveText('Both frames are the same, pixel by pixel: nothing moves.');
  await segmentClip(page);
  await expect(page.locator('#clip-status')).toHaveText('No objects: all 3 frames are the same, pixel by pixel.');
  // All moves as one piece: the pair and the clip say so.
  const moved = (k: number): Uint8Array => Uint8Array.from({ length: 3 * 100 * 70 }, (_, i) => 128 + 60 * Math.sin(0.31 * ((Math.floor(i / 3) % 100) + 2 * k)) + 50 * Math.cos(0.4 * Math.floor(i / 300)));
  await upload(page, await Promise.all([0, 1, 2].map(async (k) => ({ name: `h${k}.png`, mimeType: 'image/png', buffer: Buffer.from(await encodeColourPng(100, 70, moved(k))) }))));
  await expect(page.locator('#clip-name')).toHaveText('h0-h2.png, 3 frames, 100 × 70');
  const why = 'The whole picture follows one motion, of up to 2\\.\\d pixels: nothing is seen to move by itself\\.';
  await expect(page.locator('#status')).toHaveText(new RegExp(`^(No objects|One motion) found in [^.]+\\. ${why}$`));
  await segmentClip(page);
  await expect(page.locator('#clip-status')).toHaveText(new RegExp(`^No objects in 3 frames\\. ${why}$`));
  await upload(page, files.slice(0, 3));
  await expect(page.locator('#clip-name')).toHaveText('f00-f02.png, 3 frames, 100 × 70');
  await done(page);
  await expect(page.locator('#status')).toHaveText(/^2 objects found/);
});

test('a stroke in one frame is carried through the clip and undone; objects are merged and deleted in all of it, and the corrections are restored with it', async ({ page }) => {
  const files = await largerFrames(5);
  const found = await clipInNode(files);
  await openSegmented(page, files);
  expect(await leaves(page)).toBe(true);
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await expect(page.locator('#objects .motion.selected .motion-name')).toHaveValue('Object 3');
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
  await chooseBrush(page);
  await drag(page, ...OVER_DISC);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of \w+ frames have changed\.$/);
  const corrected = await labelsOnCanvas(page);
  // Painted pixels are certain.
  expect(corrected[IN_DISC]).toBe(3);
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
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.locator('#clip-status')).toHaveText(/^Undone in/);
  await page.locator('#tools [value=look]').check();
  await page.locator('#objects > li').nth(1).locator('.thumbnail').click();
  await expect(page.locator('#objects > li')).toHaveCount(3); // an object that was not painted goes

  const merged = await clipInNode(files, { quality: 'fast', edits: { merge: [[1, 2]] } });
  const rows = page.locator('#objects > li');
  await rows.nth(2).locator('summary').click();
  await mergeWith(rows.nth(2), 1);
  await expect(rows).toHaveCount(2);
  await expect(page.locator('#clip-status')).toHaveText('Corrected: the masks of 5 frames have changed.');
  for (const index of [0, 4]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), merged[index]!)).toBe(0);
  }
  // It is kept as a project.
  await kept(page);

  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows).toHaveCount(3);
  await kept(page); // that it is undone is kept as well
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
  await shows(page, 0);
  await expect(rows).toHaveCount(2);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Box');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 2]));
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Object 2');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(rows).toHaveCount(3);
});

test('the main subject alone is one object, also on the next visit', async ({ page }) => {
  const files = await smallFrames(6);
  await openSegmented(page, files);
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
  const files = await largerFrames(5);
  await openSegmented(page, files);
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  // The box is deleted, part of the disc painted as a new object, and merged with what is left of it.
  await rows.nth(2).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await expect(rows).toHaveCount(2);
  await goTo(page, 3);
  await page.getByRole('button', { name: 'New object' }).click();
  await chooseBrush(page);
  await drag(page, ...OVER_DISC);
  await expect.poll(async () => (await labelsOnCanvas(page))[IN_DISC]).toBe(3); // the status is that of the deletion still
  await clipDone(page);
  await enter(rows.nth(1).locator('.motion-name'), 'Disc');
  const corrected = await labelsOnCanvas(page);
  expect(new Set(corrected)).toEqual(new Set([0, 1, 3]));
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('2 objects in 5 frames, corrected as before.');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);

  // In another quality the objects are found anew, but are the same.
  await page.getByRole('radio', { name: 'Best', exact: true }).check();
  // Cancelled early, it leaves the masks that there were.
  await cancelWhen(page);
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await clipPhase(page, 'cancelled');
  await expect(status).toHaveText('Cancelled. 5 of 5 frames have masks.');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0);
  await page.locator('#clip-segment').click();
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  expect(differences(await labelsOnCanvas(page), corrected)).toBe(0); // the masks before stay until then
  await clipPhase(page, 'done');
  await expect(status).toHaveText('2 objects in 5 frames, corrected as before.');
  const best = await labelsOnCanvas(page);
  expect(new Set(best)).toEqual(new Set([0, 1, 3]));
  expect(best[IN_DISC]).toBe(3);
  await expect(rows.nth(1).locator('.motion-name')).toHaveValue('Disc');
  // Merged objects stay merged, and are selected.
  await rows.nth(2).locator('summary').click();
  await mergeWith(rows.nth(2), 1);
  await expect(rows).toHaveCount(2);
  await expect(status).toHaveText(/^Corrected/);
  await expect(page.locator('#objects .selected')).toHaveAttribute('data-mask', '1');
  await expect.poll(() => page.locator('#strokes').evaluate((strokes) => strokes.style.getPropertyValue('--colour'))).toBe(`rgb(${PALETTE[1]!.join(' ')})`);
  await page.getByRole('radio', { name: 'Fast', exact: true }).check();
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await expect(status).toHaveText('One object in 5 frames, corrected as before.');
  expect(new Set(await labelsOnCanvas(page))).toEqual(new Set([0, 1]));
  await page.getByRole('button', { name: 'Undo' }).click();
  expect(differences(await labelsOnCanvas(page), best)).toBeGreaterThan(0);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect.poll(async () => differences(await labelsOnCanvas(page), best)).toBe(0);
});

test('segmenting a part again changes nothing outside it, and both take corrections', async ({ page }) => {
  const files = await largerFrames(6);
  await openSegmented(page, files);
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 1' }).click();
  await expect(status).toHaveText(/^Corrected/);
  await goTo(page, 5);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, [0.1, 0.8], [0.2, 0.8]);
  await expect.poll(async () => (await labelsOnCanvas(page)).includes(3)).toBe(true); // the status is that of the deletion still
  await clipDone(page);
  const before = await masksOf(page, [0, 1, 2, 3, 4, 5]);
  expect(new Set(before[5])).toEqual(new Set([0, 2, 3]));

  await goTo(page, 2);
  await page.keyboard.press('i');
  await goTo(page, 4);
  await page.keyboard.press('o');
  await page.getByRole('button', { name: 'Segment frames 2–4' }).click();
  await expect(status).toHaveText(/ objects in 6 frames, corrected as before\.$/);
  // The disc is deleted there too, and the box is the object that it was.
  for (const [index, now] of (await masksOf(page, [0, 1, 2, 3, 4, 5])).entries()) {
    if (index < 2 || index > 4) expect(differences(now, before[index]!)).toBe(0);
    else expect(new Set(now)).toEqual(new Set([0, 2]));
  }
  // A correction is carried through the frames that were segmented with its own, and no others.
  await page.locator('#tools [value=look]').check();
  await page.getByRole('button', { name: 'New object' }).click();
  await goTo(page, 3);
  await drag(page, [0.1, 0.2], [0.2, 0.2]);
  await expect(status).toHaveText(/^Corrected/);
  const seen = [...(await masksOf(page, [0, 1, 2, 3, 4, 5])).entries()].flatMap(([index, labels]) => (labels.includes(4) ? [index] : []));
  expect(seen).toContain(3);
  expect(seen.filter((index) => index < 2 || index > 4)).toEqual([]);
  // The edit of an object is for the whole clip.
  await rows.nth(1).locator('summary').click();
  await page.getByRole('button', { name: 'Delete Object 2' }).click();
  await expect(status).toHaveText('Corrected: the masks of 6 frames have changed.');
  for (const labels of await masksOf(page, [0, 3, 5])) expect(labels).not.toContain(2);
  // All of it is there after a reload.
  const last = await labelsOnCanvas(page);
  await kept(page);
  await reopen(page, files);
  await expect(status).toHaveText(/^Continued/);
  await goTo(page, 5);
  expect(differences(await labelsOnCanvas(page), last)).toBe(0);
  await goTo(page, 0);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, [0.1, 0.2], [0.2, 0.2]);
  await expect(status).toHaveText(/^Corrected/);
});
