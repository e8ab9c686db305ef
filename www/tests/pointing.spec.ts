//! The box tool of clips: a box around something, or a press on it, makes a new object at once.

import { type Page } from '@playwright/test';

import { type Place, clipDone, clipFrames, differences, drag, expect, goTo, labelsOnCanvas, openSegmented, reachPicture, said, test } from './support.js';

const [WIDTH, HEIGHT, RADIUS] = [100, 70, 0.16 * 70];

/** Where the disc of `clipFrames` is in a frame. */
const isDisc = (p: number, frame: number): boolean =>
  Math.hypot((p % WIDTH) - 0.2 * WIDTH - 4 * frame, Math.floor(p / WIDTH) - 0.36 * HEIGHT - frame) < RADIUS;

/** How well a mask agrees with it. */
function overlap(labels: Uint8Array, own: number, frame: number): number {
  let [both, either] = [0, 0];
  for (const [p, label] of labels.entries()) {
    const [is, was] = [label === own, isDisc(p, frame)];
    if (is && was) both++;
    if (is || was) either++;
  }
  return both / either;
}

const tool = (page: Page) => page.getByRole('radio', { name: 'Box: a new object' });
/** The corners of a box around the disc in frame 2, and its middle, in pixels. */
const [LEFT, TOP, RIGHT, BOTTOM] = [14, 13, 42, 41];
const at = (x: number, y: number): Place => [x / WIDTH, y / HEIGHT];
const AROUND = [at(LEFT, TOP), at(RIGHT, BOTTOM)] as const;
const MIDDLE = at(28, 27);

test('a box, a press and the keyboard make a new object in all frames, and undo takes it back', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  await goTo(page, 2);
  const before = await labelsOnCanvas(page);
  const own = Math.max(...before) + 1;
  const objects = page.locator('#objects > li');
  const count = await objects.count();
  await reachPicture(page);
  await page.keyboard.press('x');
  await expect(tool(page)).toBeChecked();
  await expect(page.locator('#tool-help')).toContainText('it becomes a new object');
  await drag(page, ...AROUND);
  await said(page, /^Corrected/);
  const after = await labelsOnCanvas(page);
  expect(overlap(after, own, 2)).toBeGreaterThan(0.85);
  const inside = (p: number): boolean => {
    const [x, y] = [p % WIDTH, Math.floor(p / WIDTH)];
    return x >= LEFT - 1 && x <= RIGHT + 1 && y >= TOP - 1 && y <= BOTTOM + 1;
  };
  expect(after.every((label, p) => label !== own || inside(p))).toBe(true);
  await goTo(page, 3);
  expect(overlap(await labelsOnCanvas(page), own, 3)).toBeGreaterThan(0.8);
  await page.getByRole('button', { name: 'Undo' }).click();
  await said(page, /^Undone/);
  await goTo(page, 2);
  expect(differences(await labelsOnCanvas(page), before)).toBe(0);
  await page.getByRole('button', { name: 'Redo' }).click();
  expect(differences(await labelsOnCanvas(page), after)).toBe(0);
  expect(await objects.count()).toBeGreaterThanOrEqual(count);

  await test.step('a press points to an object as well', async () => {
    await page.getByRole('button', { name: 'Undo' }).click();
    await said(page, /^Undone/);
    await drag(page, MIDDLE, MIDDLE);
    await said(page, /^Corrected/);
    expect(overlap(await labelsOnCanvas(page), own, 2)).toBeGreaterThan(0.8);
    await page.keyboard.press('Control+z');
    await said(page, /^Undone/);
  });

  await test.step('so does the keyboard: to a corner of the box, then to the other', async () => {
    await reachPicture(page);
    // By 8 pixels, and with Shift by one.
    const step = async (key: string, by: number): Promise<void> => {
      for (let k = 0; k < Math.floor(by / 8); k++) await page.keyboard.press(key);
      for (let k = 0; k < by % 8; k++) await page.keyboard.press(`Shift+${key}`);
    };
    await page.mouse.move(0, 0);
    const from = await page.locator('.brush').evaluate((circle) => ['cx', 'cy'].map((name) => Math.round(Number(circle.getAttribute(name)))));
    await step('ArrowLeft', from[0]! - LEFT);
    await step('ArrowUp', from[1]! - TOP);
    await page.keyboard.press('Space');
    await step('ArrowRight', RIGHT - LEFT);
    await step('ArrowDown', BOTTOM - TOP);
    await page.keyboard.press('Space');
    await said(page, /^Corrected/);
    expect(overlap(await labelsOnCanvas(page), own, 2)).toBeGreaterThan(0.85);

    // A box that is given up is none.
    const now = await labelsOnCanvas(page);
    await page.keyboard.press('Space');
    await step('ArrowLeft', 20);
    await page.keyboard.press('Escape');
    await expect(page.locator('.stroke.now')).toHaveAttribute('d', '');
    expect(differences(await labelsOnCanvas(page), now)).toBe(0);
    await page.keyboard.press('Control+z');
    await said(page, /^Undone/);
  });
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true });

  test('the tools are large enough, and a finger draws a box; two fingers draw none', async ({ page }) => {
    await openSegmented(page, await clipFrames(4));
    await goTo(page, 2);
    for (const label of await page.locator('#tools fieldset label').all()) {
      const { width, height } = (await label.boundingBox())!;
      expect(Math.min(width, height)).toBeGreaterThanOrEqual(44);
    }
    const own = Math.max(...(await labelsOnCanvas(page))) + 1;
    await tool(page).check();
    await page.locator('.layers').scrollIntoViewIfNeeded();
    const box = (await page.locator('.layers').boundingBox())!;
    const finger = ([x, y]: Place, id = 0): { x: number; y: number; id: number } => ({ x: box.x + x * box.width, y: box.y + y * box.height, id });
    const cdp = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', ...touchPoints: { x: number; y: number; id: number }[]): Promise<unknown> =>
      cdp.send('Input.dispatchTouchEvent', { type, touchPoints });
    await touch('touchStart', finger(AROUND[0]));
    await touch('touchMove', finger(MIDDLE));
    await touch('touchStart', finger(MIDDLE), finger([0.8, 0.8], 1));
    await touch('touchEnd');
    await expect(page.locator('.stroke.now')).toHaveAttribute('d', '');
    await expect(page.locator('#clip-status')).not.toHaveText(/^Corrected/);
    await page.locator('#zoom-fit').dispatchEvent('click');
    await touch('touchStart', finger(AROUND[0]));
    await touch('touchMove', finger(MIDDLE));
    await touch('touchMove', finger(AROUND[1]));
    await touch('touchEnd');
    await said(page, /^Corrected/);
    expect(overlap(await labelsOnCanvas(page), own, 2)).toBeGreaterThan(0.8);

    // A finger removes what does not belong.
    await clipDone(page);
    const remove = page.getByRole('radio', { name: 'Remove' });
    expect((await remove.locator('..').boundingBox())!.height).toBeGreaterThanOrEqual(44);
    await remove.check({ force: true });
    const [x, y] = [32, 27];
    expect((await labelsOnCanvas(page))[y * WIDTH + x]).toBe(own);
    await page.touchscreen.tap(finger(at(x + 0.5, y + 0.5)).x, finger(at(x + 0.5, y + 0.5)).y);
    await expect(page.locator('#strokes .prompt')).toHaveCount(2);
    await clipDone(page);
    expect((await labelsOnCanvas(page))[y * WIDTH + x]).not.toBe(own);
  });
});

test('a press on something that was not found offers a new object there, which further presses refine', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  await goTo(page, 2);
  const offer = page.getByRole('button', { name: 'New object here' });
  await expect(offer).toBeHidden();
  await drag(page, MIDDLE, MIDDLE);
  await expect(page.locator('#objects > .selected')).toHaveCount(1);
  await expect(offer).toBeHidden(); // it was found
  await page.keyboard.press('Delete');
  await expect(page.locator('#objects > li')).toHaveCount(2);
  await clipDone(page);
  await drag(page, MIDDLE, MIDDLE);
  await expect(offer).toBeVisible();
  // Another tool or another frame takes it back.
  await page.keyboard.press('b');
  await expect(offer).toBeHidden();
  await page.keyboard.press('v');
  await drag(page, at(2, 66), at(2, 66)); // the background is selected no more
  await drag(page, MIDDLE, MIDDLE);
  await offer.click();
  await said(page, /^Corrected/);
  await expect(page.locator('#objects > li')).toHaveCount(3);
  const own = Math.max(...(await labelsOnCanvas(page)));
  expect(overlap(await labelsOnCanvas(page), own, 2)).toBeGreaterThan(0.8);
  await expect(page.locator('[name=pointing][value=add]')).toBeChecked();
  const marks = page.locator('#strokes .prompt');
  await expect(marks).toHaveCount(1);
  await page.keyboard.down('Alt');
  await drag(page, at(67, 62), at(67, 62));
  await page.keyboard.up('Alt');
  await expect(page.locator('#strokes .prompt.minus')).toHaveCount(1);
  await clipDone(page);
  await expect(page.locator('#objects > li')).toHaveCount(3);
});
