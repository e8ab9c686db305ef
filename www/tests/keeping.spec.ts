//! Right masks stay right: locked objects and accepted frames stay, whatever is corrected, and a prompt is refined.

import { type Locator, type Page } from '@playwright/test';

import { type Place, clipDone, clipFrames, differences, drag, expect, goTo, kept, labelsOnCanvas, masksOf, openSegmented, reachPicture, reopen, said, test } from './support.js';

const [WIDTH, HEIGHT, COUNT] = [100, 70, 4];
const at = (x: number, y: number): Place => [x / WIDTH, y / HEIGHT];
const pixelAt = (x: number, y: number): number => y * WIDTH + x;
/** The middle of the disc of `clipFrames` in frame 2. */
const [DISC_X, DISC_Y] = [28, 27];

const status = (page: Page): Locator => page.locator('#clip-status');

async function undo(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Undo' }).click();
  await said(page, /^Undone/);
}

async function dismiss(page: Page, said: string): Promise<void> {
  await expect(page.locator('#notice-sentence')).toHaveText(said);
  await page.locator('#notice-close').click();
}

test('a locked object keeps every pixel, whatever is corrected; what is about itself says so', async ({ page }) => {
  await openSegmented(page, await clipFrames(COUNT));
  await page.locator('#tools [name=radius]').fill('3');
  await goTo(page, 2);
  const id = (await labelsOnCanvas(page))[pixelAt(DISC_X, DISC_Y)]!;
  const disc = async (): Promise<Uint8Array[]> => (await masksOf(page, [0, 2])).map((labels) => labels.map((label) => Number(label === id)));
  const before = await disc();
  await page.keyboard.press(String(id));
  await page.keyboard.press('Shift+L');
  await expect(status(page)).toHaveText('Locked.');
  await page.keyboard.press('x');
  await expect(page.locator('#strokes .brush')).toBeAttached(); // so that the correction begins with the end of the box
  await drag(page, at(DISC_X - 14, DISC_Y - 14), at(DISC_X + 14, DISC_Y + 14));
  await clipDone(page);
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, at(DISC_X, DISC_Y), at(DISC_X + 20, DISC_Y));
  await said(page, /^Corrected/);
  expect((await disc()).map((labels, k) => differences(labels, before[k]!))).toEqual([0, 0]);
  const painted = await labelsOnCanvas(page);
  expect(painted[pixelAt(DISC_X + 18, DISC_Y)]).toBeGreaterThan(2);

  // Nor does a correction of itself.
  const sentence = `Object ${id} is locked, so nothing changes it. Unlock it first.`;
  await page.keyboard.press(String(id));
  await page.keyboard.press('e');
  await drag(page, at(DISC_X, DISC_Y), at(DISC_X + 4, DISC_Y));
  await dismiss(page, sentence);
  for (const key of ['Delete', 'Shift+>']) {
    await page.keyboard.press(key);
    await dismiss(page, sentence);
  }
  const row = page.locator(`#objects > [data-mask="${id}"]`);
  await row.locator('summary').click();
  await row.getByRole('button', { name: 'Split' }).click();
  await dismiss(page, sentence);
  await row.locator('[data-action=merge-with]').selectOption(String(3 - id));
  await row.getByRole('button', { name: /^Merge/ }).click();
  await dismiss(page, sentence);
  expect(differences(await labelsOnCanvas(page), painted)).toBe(0);
});

test('accepted frames stay accepted and as they are when something is corrected elsewhere; a stroke in one of them changes that one', async ({ page }) => {
  const files = await clipFrames(COUNT);
  await openSegmented(page, files);
  await page.locator('#tools [name=radius]').fill('3');
  const reviewed = page.locator('#reviewed');
  for (const index of [0, 3]) {
    await goTo(page, index);
    await page.getByRole('button', { name: 'Accept', exact: true }).click();
  }
  const before = await masksOf(page, [0, 3, 1]);
  await page.getByLabel('Frames that follow a correction').selectOption('forward');
  await page.getByRole('button', { name: 'New object' }).click();
  await drag(page, at(23, 24), at(39, 24));
  // Only those are told that a correction may reach.
  await said(page, /^Corrected: .* One accepted frame stays as it is\.$/);
  await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
  expect(differences(await labelsOnCanvas(page), before[2]!)).toBeGreaterThan(0);
  const changes = async (): Promise<number[]> => (await masksOf(page, [0, 3])).map((labels, k) => differences(labels, before[k]!));
  expect(await changes()).toEqual([0, 0]);

  await test.step('it is so after the clip is segmented again, and after a reload', async () => {
    await page.getByRole('button', { name: 'Segment the clip again' }).click();
    await said(page, /corrected as before/);
    await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
    expect(await changes()).toEqual([0, 0]);
    await kept(page);
    await reopen(page, files);
    await expect(reviewed).toHaveText(`2 of ${COUNT} accepted`);
  });

  await test.step('a stroke in an accepted frame', async () => {
    await goTo(page, 3);
    await page.keyboard.press('1');
    await page.keyboard.press('p');
    await drag(page, at(84, 7), at(92, 7));
    await said(page, /^Corrected/);
    await expect(reviewed).toHaveText(`1 of ${COUNT} accepted`);
    const painted = await labelsOnCanvas(page);
    const changed = [...painted.keys()].filter((p) => painted[p] !== before[1]![p]);
    expect(changed.length).toBeGreaterThan(0);
    expect(changed.every((p) => painted[p] === 1)).toBe(true);
  });
});

test('a prompt is refined by presses that add and remove, with mouse and keyboard; undo, redo and a reload keep it a prompt', async ({ page }) => {
  const files = await clipFrames(COUNT);
  await openSegmented(page, files);
  await goTo(page, 2);
  const marks = page.locator('#strokes .prompt');
  const add = page.getByRole('radio', { name: 'Add' });
  const remove = page.getByRole('radio', { name: 'Remove' });
  const press = async (x: number, y: number, how: { modifiers?: ('Alt' | 'Shift')[]; button?: 'right' } = {}): Promise<void> => {
    const count = await marks.count();
    const box = (await page.locator('.layers').boundingBox())!;
    await page.locator('.layers').click({ position: { x: ((x + 0.5) / WIDTH) * box.width, y: ((y + 0.5) / HEIGHT) * box.height }, ...how });
    await expect(marks).toHaveCount(count + 1);
    await clipDone(page);
  };
  const own = Math.max(...(await labelsOnCanvas(page))) + 1;
  const areOwn = async (...places: (readonly [number, number])[]): Promise<boolean[]> => {
    const labels = await labelsOnCanvas(page);
    return places.map(([x, y]) => labels[pixelAt(x, y)] === own);
  };

  await page.keyboard.press('x');
  await expect(add).toBeDisabled();
  await drag(page, at(DISC_X - 13, DISC_Y - 13), at(DISC_X + 13, DISC_Y + 13));
  await said(page, /^Corrected/);
  await clipDone(page);
  expect(await areOwn([DISC_X, DISC_Y])).toEqual([true]);
  await expect(marks).toHaveCount(1); // the box
  await expect(add).toBeEnabled();
  await expect(page.getByRole('radio', { name: 'New', exact: true })).toBeChecked();
  const boxed = await labelsOnCanvas(page);

  await test.step('Alt removes, Shift adds, and each press is one step', async () => {
    await press(DISC_X - 7, DISC_Y, { modifiers: ['Alt'] });
    await expect(page.locator('#strokes .prompt.minus')).toHaveCount(1);
    await press(DISC_X + 8, DISC_Y, { modifiers: ['Shift'] });
    expect(await areOwn([DISC_X - 7, DISC_Y], [DISC_X + 8, DISC_Y])).toEqual([false, true]);
    await expect(page.locator('#objects > li.selected')).toHaveAttribute('data-mask', String(own));
    const pressed = await labelsOnCanvas(page);
    for (const left of [2, 1]) {
      await undo(page);
      await expect(marks).toHaveCount(left);
    }
    expect(differences(await labelsOnCanvas(page), boxed)).toBe(0);
    for (let k = 0; k < 2; k++) await page.keyboard.press('Control+y');
    await expect(marks).toHaveCount(3);
    expect(differences(await labelsOnCanvas(page), pressed)).toBe(0);
  });

  await test.step('after a reload it is a prompt still, and the right button and the keyboard refine it', async () => {
    await kept(page);
    await reopen(page, files);
    await said(page, /^Continued/);
    const before = await labelsOnCanvas(page);
    await page.locator(`#objects > [data-mask="${own}"] .thumbnail`).click();
    await page.keyboard.press('x');
    await expect(marks).toHaveCount(3);
    await press(DISC_X + 3, DISC_Y - 5, { button: 'right' });
    expect(await areOwn([DISC_X + 3, DISC_Y - 5])).toEqual([false]);
    await page.keyboard.press('x');
    await expect(add).toBeChecked();
    await reachPicture(page);
    const brush = await page.locator('.brush').evaluate((circle) => ['cx', 'cy'].map((name) => Math.round(Number(circle.getAttribute(name)))));
    for (let k = brush[1]!; k < DISC_Y; k++) await page.keyboard.press('Shift+ArrowDown');
    await page.keyboard.press('Space');
    await page.keyboard.press('Space');
    await expect(marks).toHaveCount(5);
    await clipDone(page);
    await undo(page);
    await undo(page);
    expect(differences(await labelsOnCanvas(page), before)).toBe(0);
    // Where the object has no prompt a press makes a new object, and there is nothing to remove from.
    await goTo(page, 1);
    await expect(marks).toHaveCount(0);
    await expect(remove).toBeDisabled();
    const box = (await page.locator('.layers').boundingBox())!;
    await page.locator('.layers').click({ position: { x: box.width / 2, y: box.height / 2 }, modifiers: ['Alt'] });
    await dismiss(page, 'Clicks refine an object that a box or a press made in this frame. Select it first.');
  });
});
