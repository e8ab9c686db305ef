//! Strokes, merges, undo and redo change the masks as described.

import { type Page } from '@playwright/test';

import { PALETTE } from '../src/drawing/palette.js';
import { type Place, clipFrames, differences, drag, expect, labelsOnCanvas, mergeWith, openSegmented, said, test } from './support.js';

const [WIDTH, HEIGHT] = [100, 70];

const row = (page: Page, id: number) => page.locator(`#objects > [data-mask="${id}"]`);

/** Pixels of a row of the picture, from one to another. */
const span = (labels: Uint8Array, y: number, [from, to]: readonly [number, number]): Set<number> => new Set(labels.subarray(y * WIDTH + from, y * WIDTH + to + 1));

/** Draws a stroke along a row, from the centre of a pixel to that of another, and waits for its masks. */
async function stroke(page: Page, y: number, ends: readonly [number, number]): Promise<void> {
  const [from, to] = ends.map((x): Place => [(x + 0.5) / WIDTH, (y + 0.5) / HEIGHT]) as [Place, Place];
  await drag(page, from, to);
  await said(page, /^Corrected: the masks of (one frame|\d frames) have changed\.$/);
}

test('masks are corrected with brush, eraser and the list', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const rows = page.locator('#objects > li');
  await expect(rows).toHaveCount(3);
  const undo = page.locator('#undo');

  await test.step('strokes of brush and eraser, with the pointer or the keyboard, change a mask, and undo removes them', async () => {
    const found = await labelsOnCanvas(page);
    // With the keyboard, from the centre: a step of 8 pixels (the radius) to the right, then 2 more.
    await page.keyboard.press('1');
    await page.keyboard.press('p');
    await page.locator('.layers').focus();
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Space');
    for (let k = 0; k < 2; k++) await page.keyboard.press('ArrowRight');
    await page.keyboard.press('Space');
    await said(page, /^Corrected/);
    const drawn = await labelsOnCanvas(page);
    expect(span(drawn, 35, [58, 74])).toEqual(new Set([1]));
    expect(differences(drawn, found)).toBeGreaterThan(0);
    await undo.click();
    await expect(undo).toBeDisabled();
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);

    // With the pointer.
    expect(span(found, 16, [50, 66])).toEqual(new Set([0]));
    await stroke(page, 16, [50, 66]);
    const painted = await labelsOnCanvas(page);
    expect(span(painted, 16, [50, 66])).toEqual(new Set([1]));
    // Far away almost nothing has changed.
    expect(differences(painted.slice(58 * WIDTH), found.slice(58 * WIDTH))).toBeLessThan(20);

    await undo.click();
    await said(page, /^Undone in/);
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
    await page.keyboard.press('Control+Shift+z');
    await said(page, /^Redone in/);
    expect(differences(await labelsOnCanvas(page), painted)).toBe(0);
    await page.keyboard.press('Control+z');
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
    await expect(undo).toBeDisabled();

    // The eraser removes pixels.
    expect(span(found, 25, [16, 24])).toEqual(new Set([1]));
    await page.locator('#tools [value=eraser]').check();
    await stroke(page, 25, [16, 24]);
    expect(span(await labelsOnCanvas(page), 25, [16, 24])).not.toContain(1);
    await undo.click();
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
    await said(page, /^Corrected/);
    expect(differences(await labelsOnCanvas(page), found.map((mask) => (mask === 2 ? 1 : mask)))).toBe(0);

    // One that comes back is not chosen any more.
    await undo.click();
    await expect(rows).toHaveCount(3);
    await row(page, 1).getByText('More', { exact: true }).click();
    await mergeWith(row(page, 1), 2);
    await expect(rows).toHaveCount(2);
    await said(page, /^Corrected/);
    await undo.click();
    await expect(rows).toHaveCount(3);
    await expect(row(page, 1).locator('[data-action=merge-with]')).toHaveValue('');
    await expect(row(page, 1).getByRole('button', { name: 'Merge' })).toBeDisabled();
  });
});
