//! Strokes, merges, undo and redo change the masks as described.

import { type Page } from '@playwright/test';

import { PALETTE } from '../src/drawing/palette.js';
import { type Place, PAIR, clipDone, differences, drag, expect, labelsOnCanvas, test } from './support.js';

const row = (page: Page, id: number) => page.locator(`#objects > [data-mask="${id}"]`);

/** Draws a stroke and waits for its masks. */
async function stroke(page: Page, from: Place, to: Place): Promise<void> {
  await drag(page, from, to);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected: the masks of (one frame|2 frames) have changed\.$/);
}

test('masks of two cars, corrected with brush, eraser and the list', async ({ page }) => {
  await page.goto(`${PAIR}&quality=fast`);
  await clipDone(page);
  const status = page.locator('#clip-status');
  const rows = page.locator('#objects > li');
  await expect(rows).toHaveCount(3);

  await test.step('strokes of brush and eraser, with the pointer or the keyboard, change a mask, and undo removes them', async () => {
    const found = await labelsOnCanvas(page);
    // With the keyboard, from the centre.
    await page.keyboard.press('1');
    await page.keyboard.press('p');
    await page.locator('.layers').focus();
    for (let k = 0; k < 20; k++) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Space');
    for (let k = 0; k < 6; k++) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Space');
    await expect(status).toHaveText(/^Corrected/);
    const drawn = await labelsOnCanvas(page);
    // 20 steps of 8 pixels (the radius) to the right of the centre, then 6 more.
    for (let x = 384 + 160; x <= 384 + 208; x++) expect(drawn[216 * 768 + x]).toBe(1);
    expect(differences(drawn, found)).toBeGreaterThan(0);
    await page.locator('#undo').click();
    await expect(page.locator('#undo')).toBeDisabled();
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);

    // With the pointer.
    const at = (x: number, y: number): number => Math.floor(y * 432) * 768 + Math.floor(x * 768);
    const ground = at(0.75, 0.5);
    expect(found[ground]).toBe(0);

    await page.keyboard.press('p');
    await expect(page.locator('#tools [value=brush]')).toBeChecked();
    await page.keyboard.press('1');
    await stroke(page, [0.7, 0.5], [0.8, 0.5]);
    const painted = await labelsOnCanvas(page);
    for (let x = 0.7; x <= 0.8; x += 0.01) expect(painted[at(x, 0.5)]).toBe(1);
    // Far away almost nothing has changed.
    expect(differences(painted.slice(0, 768 * 60), found.slice(0, 768 * 60))).toBeLessThan(50);

    await page.locator('#undo').click();
    await expect(status).toHaveText(/^Undone in/);
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
    await page.keyboard.press('Control+Shift+z');
    await expect(status).toHaveText(/^Redone in/);
    expect(differences(await labelsOnCanvas(page), painted)).toBe(0);
    await page.keyboard.press('Control+z');
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
    await expect(page.locator('#undo')).toBeDisabled();

    // The eraser removes pixels.
    const inside = Math.floor(0.35 * 432) * 768 + Math.floor(0.22 * 768);
    const mask = found[inside]!;
    expect(mask).toBeGreaterThan(0);
    await page.locator('#tools [value=eraser]').check();
    await page.keyboard.press(String(mask));
    await stroke(page, [0.2, 0.35], [0.25, 0.35]);
    const erased = await labelsOnCanvas(page);
    for (let x = 0.2; x <= 0.25; x += 0.01) expect(erased[Math.floor(0.35 * 432) * 768 + Math.floor(x * 768)]).not.toBe(mask);
    await page.locator('#undo').click();
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
  });

  await test.step('choosing an object to merge with does not merge, and the merged object is selected', async () => {
    const found = await labelsOnCanvas(page);
    await page.locator('#tools [value=brush]').check();
    await page.keyboard.press('2');
    await row(page, 2).getByText('More', { exact: true }).click();
    const choice = row(page, 2).locator('[data-action=merge-with]');
    await expect(row(page, 2).getByRole('button', { name: 'Merge' })).toBeDisabled();
    await choice.focus();
    await page.keyboard.press('ArrowDown');
    await expect(choice).toHaveValue('1');
    await expect(rows).toHaveCount(3);
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await expect(rows).toHaveCount(2);
    await expect(page.locator('#objects .selected')).toHaveAttribute('data-mask', '1');
    await expect(page.locator('#objects .selected summary')).toBeFocused();
    await expect.poll(() => page.locator('#strokes').evaluate((strokes) => strokes.style.getPropertyValue('--colour'))).toBe(`rgb(${PALETTE[1]!.join(' ')})`);
    await expect(status).toHaveText(/^Corrected/);
    expect(differences(await labelsOnCanvas(page), found.map((mask) => (mask === 2 ? 1 : mask)))).toBe(0);
  });
});
