//! Right masks stay right: a correction of one object changes no other, locked objects and accepted frames stay, prompts are refined.

import { type Locator, type Page } from '@playwright/test';

import { type Place, axe, clipDone, clipFrames, differences, drag, expect, goTo, kept, labelsOnCanvas, masksOf, openSegmented, reachPicture, reopen, test } from './support.js';

const [WIDTH, HEIGHT, COUNT] = [120, 84, 6];
const at = (x: number, y: number): Place => [x / WIDTH, y / HEIGHT];
const pixelAt = (x: number, y: number): number => y * WIDTH + x;
/** The middle of the disc of `clipFrames` in frame 4; the box of something that was not found, and its middle. */
const [DISC_X, DISC_Y] = [40, 34];
const [AROUND, INSIDE] = [[at(62, 6), at(82, 24)], at(72, 15)] as const;

const status = (page: Page): Locator => page.locator('#clip-status');
const notice = (page: Page): Locator => page.locator('#notice-sentence');

/** The masks of all frames; then the frame shown before is shown again. */
async function allMasks(page: Page): Promise<Uint8Array[]> {
  const shown = Number(/\d+$/.exec((await page.locator('#caption').textContent())!)![0]);
  const masks = await masksOf(page, Array.from({ length: COUNT }, (_, index) => index));
  await goTo(page, shown);
  return masks;
}

/** The pixels that have changed and are not of the object `own` now, in all frames. */
function others(now: readonly Uint8Array[], before: readonly Uint8Array[], own: number): number {
  return now.reduce((sum, labels, k) => sum + labels.filter((label, p) => label !== before[k]![p] && label !== own).length, 0);
}

/** The pixels of an object that have changed, in all frames. */
function changed(now: readonly Uint8Array[], before: readonly Uint8Array[], id: number): number {
  const own = (labels: Uint8Array): Uint8Array => labels.map((label) => Number(label === id));
  return now.reduce((sum, labels, k) => sum + differences(own(labels), own(before[k]!)), 0);
}

async function undo(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(status(page)).toHaveText(/^Undone/);
}

async function dismiss(page: Page, said: string | RegExp): Promise<void> {
  await expect(notice(page)).toHaveText(said);
  await page.locator('#notice-close').click();
}

test('a box or a press takes from automatic objects what becomes the new one; nothing changes a locked object with a stroke of its own', async ({ page }) => {
  await openSegmented(page, await clipFrames(COUNT, WIDTH, HEIGHT));
  await page.locator('#tools [name=radius]').fill('3');
  await goTo(page, COUNT - 2);
  const found = await allMasks(page);
  const disc = found[COUNT - 2]![pixelAt(DISC_X, DISC_Y)]!;
  expect(disc).toBeGreaterThan(0);

  await test.step('pixels that do not become its own stay as they are, in all frames', async () => {
    for (const [from, to] of [AROUND, [INSIDE, INSIDE]] as const) {
      await page.keyboard.press('x');
      await drag(page, from, to);
      await expect(status(page)).toHaveText(/^Corrected/);
      const now = await allMasks(page);
      expect(now[COUNT - 2]).toContain(3);
      expect(others(now, found, 3)).toBe(0);
      await undo(page);
    }
  });

  await test.step('a locked one keeps every pixel, whatever is corrected', async () => {
    await page.keyboard.press(String(disc));
    await page.keyboard.press('p');
    await drag(page, at(DISC_X - 3, DISC_Y - 14), at(DISC_X + 3, DISC_Y - 14));
    await expect(status(page)).toHaveText(/^Corrected/);
    await page.keyboard.press('Shift+L');
    await expect(status(page)).toHaveText('Locked.');
    const locked = await allMasks(page);
    await page.keyboard.press('x');
    for (const [from, to] of [AROUND, [at(DISC_X - 16, DISC_Y - 18), at(DISC_X + 16, DISC_Y + 16)]] as const) {
      await drag(page, from, to);
      await clipDone(page);
    }
    expect(changed(await allMasks(page), locked, disc)).toBe(0);
    await page.getByRole('button', { name: 'New object' }).click();
    await drag(page, at(DISC_X, DISC_Y), at(DISC_X + 24, DISC_Y));
    await expect(status(page)).toHaveText(/^Corrected/);
    await clipDone(page);
    const painted = await allMasks(page);
    expect(changed(painted, locked, disc)).toBe(0);
    expect(painted[COUNT - 2]![pixelAt(DISC_X + 20, DISC_Y)]).not.toBe(locked[COUNT - 2]![pixelAt(DISC_X + 20, DISC_Y)]);
    // Nor does a correction of itself: a sentence tells so.
    const sentence = `Object ${disc} is locked, so nothing changes it. Unlock it first.`;
    await page.keyboard.press(String(disc));
    await page.keyboard.press('e');
    await drag(page, at(DISC_X, DISC_Y), at(DISC_X + 4, DISC_Y));
    await dismiss(page, sentence);
    await page.keyboard.press('Delete');
    await dismiss(page, sentence);
    await page.keyboard.press('Shift+>');
    await dismiss(page, sentence);
    const row = page.locator(`#objects > [data-mask="${disc}"]`);
    await row.locator('summary').click();
    await row.getByRole('button', { name: 'Split' }).click();
    await dismiss(page, sentence);
    await row.locator('[data-action=merge-with]').selectOption(String(3 - disc));
    await row.getByRole('button', { name: /^Merge/ }).click();
    await dismiss(page, sentence);
    expect(differences(await labelsOnCanvas(page), painted[COUNT - 2]!)).toBe(0);
  });
});

test('accepted frames stay accepted and as they are when something is corrected elsewhere; a stroke in one of them changes that one', async ({ page }) => {
  await openSegmented(page, await clipFrames(COUNT, WIDTH, HEIGHT));
  await page.locator('#tools [name=radius]').fill('4');
  const reviewed = page.locator('#reviewed');
  for (const index of [1, 4]) {
    await goTo(page, index);
    await page.getByRole('button', { name: 'Accept', exact: true }).click();
  }
  await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
  await goTo(page, 2);
  const before = await allMasks(page);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, at(32, 30), at(52, 30));
  await expect(status(page)).toHaveText(/^Corrected: .* 2 accepted frames stay as they are\.$/);
  await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
  const now = await allMasks(page);
  expect([1, 4].map((index) => differences(now[index]!, before[index]!))).toEqual([0, 0]);
  expect(differences(now[2]!, before[2]!)).toBeGreaterThan(0);

  await test.step('only those are told that a correction may reach', async () => {
    await undo(page);
    await page.getByLabel('Frames that follow a correction').selectOption('forward');
    await drag(page, at(32, 30), at(52, 30));
    await expect(status(page)).toHaveText(/^Corrected: .* One accepted frame stays as it is\.$/);
    await page.getByLabel('Frames that follow a correction').selectOption('both');
  });

  await test.step('it is so after the clip is segmented again, and after a reload', async () => {
    await page.getByRole('button', { name: 'Segment the clip again' }).click();
    await expect(status(page)).toHaveText(/corrected as before/);
    await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
    const again = await allMasks(page);
    expect([1, 4].map((index) => differences(again[index]!, before[index]!))).toEqual([0, 0]);
    await kept(page);
    await reopen(page, await clipFrames(COUNT, WIDTH, HEIGHT));
    await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
  });

  await test.step('a stroke in an accepted frame', async () => {
    await goTo(page, 4);
    const here = await labelsOnCanvas(page);
    await page.keyboard.press('1');
    await page.keyboard.press('p');
    await drag(page, at(100, 8), at(110, 8));
    await expect(status(page)).toHaveText(/^Corrected/);
    await expect(reviewed).toHaveText(`1 of ${COUNT} accepted`);
    const painted = await labelsOnCanvas(page);
    expect(painted.filter((label, p) => label !== here[p]).every((label) => label === 1)).toBe(true);
  });
});

test('a prompt is refined by presses that add and remove, with mouse and keyboard; undo, redo and a reload keep it a prompt', async ({ page }) => {
  const files = await clipFrames(COUNT, WIDTH, HEIGHT);
  await openSegmented(page, files);
  await goTo(page, 4);
  const marks = page.locator('#strokes .prompt');
  const add = page.getByRole('radio', { name: 'Add' });
  const remove = page.getByRole('radio', { name: 'Remove' });
  const press = async (x: number, y: number, how: { modifiers?: ('Alt' | 'Shift')[]; button?: 'right' } = {}): Promise<void> => {
    const box = (await page.locator('.layers').boundingBox())!;
    await page.locator('.layers').click({ position: { x: ((x + 0.5) / WIDTH) * box.width, y: ((y + 0.5) / HEIGHT) * box.height }, ...how });
    await expect(status(page)).toHaveText(/^Corrected|^Carrying/);
    await clipDone(page);
  };
  const own = Math.max(...(await labelsOnCanvas(page))) + 1;
  const isOwn = async (x: number, y: number): Promise<boolean> => (await labelsOnCanvas(page))[pixelAt(x, y)] === own;

  await page.keyboard.press('x');
  await expect(add).toBeDisabled();
  await drag(page, at(DISC_X - 16, DISC_Y - 16), at(DISC_X + 16, DISC_Y + 16));
  await expect(status(page)).toHaveText(/^Corrected/);
  await clipDone(page);
  expect(await isOwn(DISC_X, DISC_Y)).toBe(true);
  await expect(marks).toHaveCount(1); // the box
  await expect(add).toBeEnabled();
  await expect(page.getByRole('radio', { name: 'New', exact: true })).toBeChecked();
  const boxed = await labelsOnCanvas(page);

  await test.step('Alt and the right button remove, Shift adds, and each press is one step', async () => {
    await press(DISC_X - 8, DISC_Y, { modifiers: ['Alt'] });
    expect(await isOwn(DISC_X - 8, DISC_Y)).toBe(false);
    await expect(page.locator('#strokes .prompt.minus')).toHaveCount(1);
    await press(DISC_X, DISC_Y + 8, { button: 'right' });
    expect([await isOwn(DISC_X - 8, DISC_Y), await isOwn(DISC_X, DISC_Y + 8)]).toEqual([false, false]);
    await press(DISC_X + 9, DISC_Y, { modifiers: ['Shift'] });
    expect([await isOwn(DISC_X + 9, DISC_Y), await isOwn(DISC_X, DISC_Y + 8)]).toEqual([true, false]);
    await expect(marks).toHaveCount(4);
    await expect(page.locator('#objects > li.selected')).toHaveAttribute('data-mask', String(own));
    expect(await page.locator('#objects > li').count()).toBeLessThanOrEqual(own + 1);
    const three = await labelsOnCanvas(page);
    for (const left of [3, 2, 1]) {
      await undo(page);
      await expect(marks).toHaveCount(left);
    }
    expect(differences(await labelsOnCanvas(page), boxed)).toBe(0);
    for (let k = 0; k < 3; k++) await page.keyboard.press('Control+y');
    await expect(marks).toHaveCount(4);
    expect(differences(await labelsOnCanvas(page), three)).toBe(0);
    expect(await axe(page)).toEqual([]);
  });

  await test.step('after a reload it is a prompt still, and the switch and the keyboard refine it', async () => {
    await kept(page);
    await reopen(page, files);
    await expect(status(page)).toHaveText(/^Continued/);
    await goTo(page, 4);
    const before = await labelsOnCanvas(page);
    await page.locator(`#objects > [data-mask="${own}"] .thumbnail`).click();
    await page.keyboard.press('x');
    await expect(marks).toHaveCount(4);
    await remove.check({ force: true });
    await press(DISC_X + 4, DISC_Y - 6);
    expect(await isOwn(DISC_X + 4, DISC_Y - 6)).toBe(false);
    await page.keyboard.press('x'); // a new one again
    await page.keyboard.press('x');
    await expect(add).toBeChecked();
    await reachPicture(page);
    const brush = await page.locator('.brush').evaluate((circle) => ['cx', 'cy'].map((name) => Math.round(Number(circle.getAttribute(name)))));
    for (let k = brush[1]!; k < DISC_Y; k++) await page.keyboard.press('Shift+ArrowDown');
    await page.keyboard.press('Space');
    await page.keyboard.press('Space');
    await expect(marks).toHaveCount(6);
    await clipDone(page);
    await undo(page);
    await undo(page);
    expect(differences(await labelsOnCanvas(page), before)).toBe(0);
    // Where the object has no prompt a press makes a new object, and there is nothing to remove from.
    await goTo(page, 3);
    await expect(marks).toHaveCount(0);
    await expect(remove).toBeDisabled();
    const box = (await page.locator('.layers').boundingBox())!;
    await page.locator('.layers').click({ position: { x: box.width / 2, y: box.height / 2 }, modifiers: ['Alt'] });
    await dismiss(page, 'Clicks refine an object that a box or a press made in this frame. Select it first.');
  });
});
