//! Inspecting a frame: the motions between it and the one beside it, and comparing both.

import { type Page } from '@playwright/test';
import { encodePng } from 'veronese/codecs';

import { type Upload, clipDone, differences, done, drag, expect, goTo, holdBack, inspect, labelsOnCanvas, openClip, openEmpty, openSegmented, said, segmentedInNode, square, test, upload } from './support.js';

/** Frames of a square that moves right and down. */
function frames(count: number): Promise<Upload[]> {
  return Promise.all(Array.from({ length: count }, (_, k) => square(`f${k}.png`, 100, 64, 3 * k, k)));
}

test('the motions between a frame and the one beside it are those of the package, with their matrices and the evidence for their number', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const files = await frames(3);
  await openSegmented(page, files);
  await goTo(page, 0);
  const objects = await labelsOnCanvas(page);
  const workers = page.workers().length;
  await inspect(page);
  const expected = await segmentedInNode(files[0]!, files[1]!);
  const rows = page.locator('#motions > li');
  await expect(rows).toHaveCount(expected.count);
  await expect(page.locator('#inspect-status')).toHaveText(new RegExp(`^${expected.count} motions from the first frame to the second`));
  await expect(rows.nth(1).locator('.words')).toHaveText('3.2 px right');
  await rows.nth(1).getByText('More', { exact: true }).click();
  for (const [notation, written] of [['JSON', JSON.stringify(expected.motions[1]!.matrix)], ['SVG / CSS', /^matrix\(/], ['OpenCV 2×3', /^\[\[/]] as const) {
    await rows.nth(1).getByRole('button', { name: notation }).click();
    await expect(page.locator('#notice')).toContainText(`Copied the motion of Motion 1 to the clipboard as ${notation}.`);
    expect(await page.evaluate(() => navigator.clipboard.readText())).toMatch(typeof written === 'string' ? new RegExp(`^${written.replaceAll(/[[\]+.]/g, '\\$&')}$`) : written);
  }
  const { candidates } = expected.evidence;
  await expect(page.locator('#evidence .score')).toHaveCount(candidates.length);
  await expect(page.locator('#evidence .number.found')).toContainText(String(expected.count));
  const [shortest] = candidates.toSorted((one, other) => one.score - other.score);
  await expect(page.locator('#evidence li', { hasText: 'shortest description' }).first()).toContainText(String(shortest!.motions));

  await test.step('they are drawn in the place of the objects, of whatever frame is gone to', async () => {
    await page.keyboard.press('g');
    await expect(page.locator('#caption')).toHaveText('Motions: frame 0');
    expect(differences(await labelsOnCanvas(page), expected.labels)).toBe(0);
    await page.keyboard.press('.');
    await page.keyboard.press('.');
    await expect(page.locator('#caption')).toHaveText('Motions: frame 2');
    await expect(page.locator('#inspect [aria-busy=false]')).toBeAttached();
    // At the end of the clip it is the frame before.
    expect(differences(await labelsOnCanvas(page), (await segmentedInNode(files[2]!, files[1]!)).labels)).toBe(0);
    await goMotions(page, 0);
  });

  await test.step('what is drawn is about the objects, and so is undo; closed, nothing is left', async () => {
    await page.keyboard.press('b');
    await expect(page.locator('#caption')).toHaveText('Frame 0');
    expect(differences(await labelsOnCanvas(page), objects)).toBe(0);
    await drag(page, [0.7, 0.2], [0.8, 0.2]);
    await said(page, /^Corrected/);
    await page.keyboard.press('g');
    await page.keyboard.press('Control+z');
    await said(page, /^Undone/);
    await expect(page.locator('#caption')).toHaveText('Frame 0');
    await page.keyboard.press('g');
    await page.locator('#inspect > summary').click();
    await expect(page.locator('#motions')).toHaveCount(0);
    await expect(page.locator('#caption')).toHaveText('Frame 0');
    expect(differences(await labelsOnCanvas(page), objects)).toBe(0);
    await expect.poll(() => page.workers().length).toBe(workers);
  });
});

/** Goes to a frame whose motions are drawn. */
async function goMotions(page: Page, index: number): Promise<void> {
  for (let at = 2; at > index; at--) await page.keyboard.press(',');
  await expect(page.locator('#caption')).toHaveText(`Motions: frame ${index}`);
  await expect(page.locator('#inspect [aria-busy=false]')).toBeAttached();
}

test('motions are not looked for while the clip is segmented; what they cannot be found of is said', async ({ page }) => {
  const files = await frames(4);
  await openClip(page, files);
  const release = await holdBack(page, 'f3.png');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await page.locator('#inspect > summary').click();
  const status = page.locator('#inspect-status');
  await expect(status).toHaveText('The motions are found when the clip rests.');
  await release();
  await clipDone(page);
  await inspect(page);
  await openEmpty(page);
  const dots = [await square('dot.png', 1, 1, 0, 0), await square('other.png', 1, 1, 0, 0)];
  await page.reload();
  await upload(page, dots);
  await done(page);
  await page.locator('#inspect > summary').click();
  await expect(status).toHaveText('The motions could not be found.');
  await expect(page.locator('#notice-code')).toHaveText('frame-size-unsupported');
});

/** A textured thing of two parts that touch, before a textured ground: between the frames one part moves by 6 pixels, the other by 4.2. */
async function parts(name: string, t: number): Promise<Upload> {
  const [width, height] = [320, 240];
  const wave = (x: number, y: number, seed: number): number => 128 + 60 * Math.sin(0.31 * x + 0.17 * y + seed) + 50 * Math.cos(0.29 * y - 0.11 * x * seed);
  const pixels = new Uint8Array(width * height * 3);
  for (let p = 0; p < width * height; p++) {
    const [x, y] = [p % width, Math.floor(p / width)];
    const inside = (left: number, top: number, across: number, down: number): boolean => x >= left && x < left + across && y >= top && y < top + down;
    const upper = inside(100 + 6 * t, 60, 90, 70);
    const lower = inside(100 + 4.2 * t, 130, 90, 50);
    const [u, seed] = upper ? [x - 6 * t, 2] : lower ? [x - 4.2 * t, 3] : [x, 1];
    for (let c = 0; c < 3; c++) pixels[3 * p + c] = wave(u + 37 * c, y, seed);
  }
  return { name, mimeType: 'image/png', buffer: Buffer.from(await encodePng(width, height, pixels)) };
}

test('a motion becomes an object of its own, which is followed', async ({ page }) => {
  await openClip(page, [await parts('first.png', 0), await parts('second.png', 1)]);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-status')).toHaveText('One object in 2 frames.'); // its parts touch
  // The key inspects, too.
  await page.keyboard.press('g');
  await inspect(page);
  const motions = await labelsOnCanvas(page);
  await page.locator('#motions > li').nth(2).getByRole('button', { name: 'Make an object' }).click();
  await expect(page.locator('#clip-status')).toHaveText('Corrected: the masks of 2 frames have changed.');
  await expect(page.locator('#objects > .selected')).toHaveAttribute('data-mask', '2');
  const objects = await labelsOnCanvas(page);
  expect([...motions.keys()].filter((p) => (motions[p] === 2) !== (objects[p] === 2)).length).toBe(0);
  await goTo(page, 1);
  // It has gone on with its own motion.
  const [left, right] = [104, 194];
  const there = await labelsOnCanvas(page);
  const covered = Array.from({ length: right - left }, (_, k) => there[155 * 320 + left + k]).filter((object) => object === 2).length;
  expect(covered / (right - left)).toBeGreaterThan(0.9);
});

test('two frames are compared: split, in turn, and in turn by themselves', async ({ page }) => {
  await openClip(page, await frames(2));
  const caption = page.locator('#caption');
  await page.locator('#inspect > summary').click();
  await page.getByLabel('Split', { exact: true }).check();
  await expect(caption).toHaveText('Frame 0 | Frame 1');
  await expect(page.locator('#other')).toBeVisible();
  const line = page.getByRole('slider', { name: 'Position of the split' });
  await line.fill('250');
  await expect(page.locator('#other')).toHaveCSS('clip-path', /25%/);
  await line.focus();
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#other')).toHaveCSS('clip-path', /25\.1%/);
  await page.keyboard.press('s');
  await expect(page.locator('#other')).toBeHidden();
  await page.keyboard.down('f');
  await expect(caption).toHaveText('Frame 1');
  await page.keyboard.up('f');
  await expect(caption).toHaveText('Frame 0');

  const blink = page.getByRole('button', { name: 'Blink' });
  const captions = await caption.evaluateHandle((caption) => {
    const captions: string[] = [];
    new MutationObserver(() => captions.push(caption.textContent)).observe(caption, { childList: true, characterData: true, subtree: true });
    return captions;
  });
  await blink.click();
  await expect.poll(() => captions.evaluate(({ length }) => length)).toBeGreaterThan(2);
  await blink.click();
  expect((await captions.jsonValue()).slice(0, 3)).toEqual(['Frame 1', 'Frame 0', 'Frame 1']);
  await expect(caption).toHaveText('Frame 0');
  // With reduced motion each press shows the other frame, and none begins to blink.
  await page.emulateMedia({ reducedMotion: 'reduce' });
  for (const frame of [1, 0, 1]) {
    await page.keyboard.press('Shift+F');
    await expect(caption).toHaveText(`Frame ${frame}`);
    await expect(blink).toHaveAttribute('aria-pressed', 'false');
  }
});
