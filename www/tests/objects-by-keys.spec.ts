//! A clip is corrected by keyboard: its objects, its corrected frames, the size of the brush.

import { clipDone, clipFrames, done, drag, expect, goTo, openSegmented, said, test } from './support.js';

test('objects are selected and deleted, corrected frames are found, and a correction spreads where it is told to', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const rows = page.locator('#objects > li');
  await expect(rows).toHaveCount(3); // and the background
  await page.keyboard.press('2');
  await expect(rows.nth(2)).toHaveClass(/selected/);
  await page.keyboard.press('1');
  await expect(rows.nth(1)).toHaveClass(/selected/);
  await page.keyboard.press('9'); // there is none
  await expect(rows.nth(1)).toHaveClass(/selected/);

  // A correction spreads as far as is chosen.
  const status = page.locator('#clip-status');
  await goTo(page, 2);
  await page.keyboard.press('1');
  await page.keyboard.press('p');
  const follow = page.getByRole('combobox', { name: 'Frames that follow a correction' });
  await follow.selectOption('none');
  await drag(page, [0.05, 0.85], [0.1, 0.9]);
  await expect(status).toHaveText('Corrected: the masks of one frame have changed.');
  await goTo(page, 1);
  await follow.selectOption('forward');
  await page.keyboard.press('2');
  await drag(page, [0.3, 0.42], [0.4, 0.42]);
  await said(page, /^Corrected: the masks of (2|3) frames have changed\.$/);

  await goTo(page, 3);
  await page.keyboard.press('Shift+C');
  await expect(page.locator('#caption')).toHaveText('Frame 2');
  await page.keyboard.press('Shift+C');
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await page.keyboard.press('Shift+C'); // there is none before
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await page.keyboard.press('c');
  await expect(page.locator('#caption')).toHaveText('Frame 2');
  await done(page);

  await page.keyboard.press('2');
  await page.keyboard.press('Delete');
  await expect(rows).toHaveCount(2);
  await clipDone(page);
  // The one lane that is left is beside its name, in the upper of the two that have room.
  const halves = await page.locator('#lanes').evaluate((canvas: HTMLCanvasElement) => {
    const half = Math.floor(canvas.height / 2);
    return [0, half].map((top) => canvas.getContext('2d')!.getImageData(0, top, canvas.width, half).data.some((value) => value > 0));
  });
  expect(halves).toEqual([true, false]);
  for (let k = 0; k < 3; k++) await page.keyboard.press('Control+z');
  await expect(rows).toHaveCount(3);
  await expect(status).toHaveText('Undone in one frame.');
  await expect(page.locator('#undo')).toBeDisabled();

  await test.step('with Shift the wheel changes the size of the brush, and nothing else', async () => {
    await page.locator('#tools [value=look]').check();
    const size = page.locator('#tools [name=radius]');
    const box = (await page.locator('.layers').boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.keyboard.down('Shift');
    await page.mouse.wheel(0, -100);
    await expect(size).toHaveValue('8');
    await page.keyboard.up('Shift');
    await page.locator('#tools [value=brush]').check();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    const zoom = await page.locator('#zoom-value').textContent();
    await page.keyboard.down('Shift');
    await page.mouse.wheel(0, -100);
    await expect(size).toHaveValue('9');
    for (let k = 0; k < 9; k++) await page.mouse.wheel(0, 100);
    await expect(size).toHaveValue('2');
    await page.keyboard.up('Shift');
    await expect(page.locator('#zoom-value')).toHaveText(zoom!);
  });
});

test('several objects are selected by mouse and keyboard, and what is done with them is one step', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const rows = page.locator('#objects > li');
  const row = (id: number) => page.locator(`#objects > [data-mask="${id}"]`);
  const boxes = page.getByRole('checkbox', { name: /^Select / });
  const bar = page.getByRole('group', { name: 'Selected objects' });
  const told = bar.getByRole('status');
  const undo = page.locator('#undo');
  await expect(boxes).toHaveCount(0);
  await expect(bar).toBeHidden();

  await row(1).locator('.thumbnail').click();
  await row(2).locator('.thumbnail').click({ modifiers: ['ControlOrMeta'] });
  await expect(told).toHaveText('2 selected');
  await expect(page.getByRole('checkbox', { name: 'Select Object 1' })).toBeChecked();
  await expect(page.getByRole('checkbox', { name: 'Select Object 2' })).toBeChecked();
  await expect(page.locator('#select-several')).toHaveAttribute('aria-pressed', 'true');

  // Locks and classes of all, each in one step.
  const lock = bar.getByRole('button', { name: 'Lock' });
  await lock.click();
  await expect(lock).toHaveAttribute('aria-pressed', 'true');
  await undo.click();
  await expect(lock).toHaveAttribute('aria-pressed', 'false');
  await page.keyboard.press('t');
  await page.keyboard.type('toy');
  await page.keyboard.press('Enter');
  const names = page.locator('#objects .motion-name');
  await expect(names.nth(1)).toHaveValue('toy 1');
  await expect(names.nth(2)).toHaveValue('toy 2');
  await undo.click();
  await expect(names.nth(1)).toHaveValue('Object 1');
  await expect(names.nth(2)).toHaveValue('Object 2');
  await expect(undo).toBeDisabled();

  // Export ticks these alone.
  await row(1).getByRole('checkbox').click();
  await expect(told).toHaveText('1 selected');
  await bar.getByRole('button', { name: 'Export' }).click();
  await expect(page.locator('#export')).toBeVisible();
  await expect(bar).toBeHidden();
  await page.keyboard.press('Escape');
  await expect(page.getByLabel('Show Object 1')).not.toBeChecked();
  await expect(page.getByLabel('Show Object 2')).toBeChecked();

  // A plain press selects one again; from there Shift and the arrow keys extend.
  await row(1).locator('.thumbnail').click();
  await expect(row(1)).toHaveClass(/selected/);
  await page.keyboard.press('Shift+ArrowDown');
  await expect(told).toHaveText('2 selected');
  await expect(page.getByRole('checkbox', { name: 'Select Object 2' })).toBeFocused();
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Space');
  await expect(told).toHaveText('1 selected');
  await page.keyboard.press('ControlOrMeta+a');
  await expect(told).toHaveText('2 selected');
  await bar.getByRole('button', { name: 'Merge' }).click();
  await expect(rows).toHaveCount(2);
  await expect(rows.nth(1).locator('summary')).toBeFocused();
  await expect(bar).toBeHidden();
  await clipDone(page);
  await undo.click();
  await expect(rows).toHaveCount(3);

  await row(2).locator('.thumbnail').click();
  await expect(row(2)).toHaveClass(/selected/);
  await row(1).locator('.thumbnail').click({ modifiers: ['Shift'] });
  await expect(told).toHaveText('2 selected');
  await page.keyboard.press('Delete');
  await expect(rows).toHaveCount(1);
  await expect(told).toHaveText('0 selected');
  await clipDone(page);
  await page.keyboard.press('ControlOrMeta+z');
  await expect(rows).toHaveCount(3);
  await expect(undo).toBeDisabled();
});
