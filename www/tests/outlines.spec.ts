//! Closed outlines: what a polygon encloses is the object in its frame, to the pixel; and an object that was deleted can be outlined anew.

import { type Page } from '@playwright/test';

import { type Place, clipFrames, differences, drag, expect, goTo, kept, labelsOnCanvas, masksOf, openSegmented, reopen, said, test } from './support.js';

const [WIDTH, HEIGHT] = [100, 70];

/** Places of the picture at which the sides of pixels meet, so that it is clear which pixels are inside. */
const corners = ([left, top, right, bottom]: Sides): Place[] => [[left, top], [right, top], [right, bottom], [left, bottom]].map(([x, y]): Place => [x! / WIDTH, y! / HEIGHT]);
/** First column and row, and those behind the last. */
type Sides = readonly [number, number, number, number];
const isIn = (p: number, [left, top, right, bottom]: Sides): boolean => p % WIDTH >= left && p % WIDTH < right && p >= top * WIDTH && p < bottom * WIDTH;

/** Draws a polygon around these pixels, and waits for its masks. */
async function outline(page: Page, sides: Sides): Promise<void> {
  await page.keyboard.press('w');
  const [first, ...others] = corners(sides) as [Place, ...Place[]];
  for (const corner of [first, ...others, first]) await drag(page, corner, corner);
  await said(page, /^Corrected: the masks of (one frame|\d frames) have changed\.$/);
}

/** Which pixels have a label. */
const of = (labels: Uint8Array, id: number): Uint8Array => labels.map((label) => Number(label === id));

test('a polygon is its object, to the pixel; what was deleted and is outlined anew is as if it had never been', async ({ page }) => {
  const files = await clipFrames(4);
  await openSegmented(page, files);
  await goTo(page, 1);
  const found = await labelsOnCanvas(page);
  // The disc is around (24, 26): the polygon cuts it, and has ground beside it.
  const [cut, around]: readonly [Sides, Sides] = [[20, 18, 50, 30], [14, 15, 60, 37]];
  const exactly = (id: number, sides: Sides) => (labels: Uint8Array): Uint8Array => labels.map((label, p) => (isIn(p, sides) ? id : label === id ? 0 : label));

  await test.step('of an object that was found', async () => {
    await page.keyboard.press('1');
    await outline(page, around);
    expect(differences(await labelsOnCanvas(page), exactly(1, around)(found))).toBe(0);
    // Another one takes its place.
    await outline(page, cut);
    const outlined = exactly(1, cut)(found);
    expect(differences(await labelsOnCanvas(page), outlined)).toBe(0);
    // A stroke lies over it, and changes nothing around.
    await page.keyboard.press('e');
    await drag(page, [0.3, 0.3], [0.35, 0.3]);
    await said(page, /^Corrected/);
    const erased = await labelsOnCanvas(page);
    expect(differences(erased, outlined)).toBeGreaterThan(20);
    expect([...erased.keys()].filter((p) => erased[p] !== outlined[p] && (erased[p] !== 0 || outlined[p] !== 1))).toEqual([]);
    await kept(page);
    await reopen(page, files);
    await goTo(page, 1);
    expect(differences(await labelsOnCanvas(page), erased)).toBe(0);
    await page.keyboard.press('Control+z');
    await said(page, /^Undone/);
    expect(differences(await labelsOnCanvas(page), outlined)).toBe(0);
    for (const _ of [cut, around]) await page.keyboard.press('Control+z');
    expect(differences(await labelsOnCanvas(page), found)).toBe(0);
  });

  await test.step('of a new one, and again after it was deleted', async () => {
    const add = page.getByRole('button', { name: 'New object' });
    await add.click();
    await outline(page, around);
    const id = Math.max(...(await labelsOnCanvas(page)));
    expect(differences(await labelsOnCanvas(page), exactly(id, around)(found))).toBe(0);
    const once = await masksOf(page, [2, 0, 1]);
    await page.keyboard.press('Control+z');
    await said(page, /^Undone/);

    await add.click();
    await outline(page, [10, 4, 80, 60]);
    await page.keyboard.press('Delete');
    await said(page, /^Corrected/);
    expect(await labelsOnCanvas(page)).not.toContain(id);
    await add.click();
    await outline(page, around);
    const again = await masksOf(page, [2, 0, 1]);
    expect(again[2]).toContain(id + 1);
    for (const [k, labels] of again.entries()) expect(differences(of(labels, id + 1), of(once[k]!, id)), `frame ${k}`).toBe(0);
  });
});
