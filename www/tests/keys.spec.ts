//! Keys do what they do in other programs, wherever the mouse was pressed last.

import type { Locator, Page } from '@playwright/test';

import { expect, openEmpty, openSegmented, clipFrames, test } from './support.js';

const at = (page: Page): Locator => page.locator('#caption');

test('arrows step frames, with Shift ten; Space plays; B, E, V and brackets are about tools, which arrows never change', async ({ page }) => {
  await openSegmented(page, await clipFrames(12));
  const tool = page.locator('#tools [name=tool]:checked');
  await page.getByRole('slider', { name: 'Current frame' }).press('Home');
  await page.keyboard.press('ArrowRight');
  await expect(at(page)).toHaveText('Frame 1');
  await page.keyboard.press('Shift+ArrowRight');
  await expect(at(page)).toHaveText('Frame 11');
  await page.keyboard.press('Shift+ArrowLeft');
  await expect(at(page)).toHaveText('Frame 1');
  await page.keyboard.press('ArrowLeft');
  await expect(at(page)).toHaveText('Frame 0');

  await test.step('after a press on a tool, on the picture, on a row, on a button', async () => {
    await page.getByRole('radio', { name: 'Brush' }).click();
    await page.keyboard.press('ArrowRight');
    await expect(at(page)).toHaveText('Frame 1');
    await expect(tool).toHaveValue('brush');
    await page.keyboard.press('v');
    await expect(tool).toHaveValue('look');
    await page.locator('.layers').click({ position: { x: 5, y: 5 } });
    await page.keyboard.press('ArrowRight');
    await expect(at(page)).toHaveText('Frame 2');
    await page.keyboard.press('b');
    await expect(tool).toHaveValue('brush');
    await page.locator('#objects .motion-name').nth(1).click({ position: { x: 12, y: 10 } });
    await page.keyboard.press('ArrowRight');
    await expect(at(page)).toHaveText('Frame 3');
    await page.keyboard.press('e');
    await expect(tool).toHaveValue('eraser');
    await page.getByRole('button', { name: 'Speed' }).click();
    await page.keyboard.press('ArrowLeft');
    await expect(at(page)).toHaveText('Frame 2');
  });

  await test.step('the size of the brush', async () => {
    const size = page.locator('#tools [name=radius]');
    const before = Number(await size.inputValue());
    await page.keyboard.press(']');
    expect(Number(await size.inputValue())).toBeGreaterThan(before);
    await page.keyboard.press('[');
    await page.keyboard.press('[');
    expect(Number(await size.inputValue())).toBeLessThan(before);
  });

  await test.step('Space plays to the end', async () => {
    const speed = await page.getByRole('button', { name: 'Speed' }).textContent();
    await page.keyboard.press('Space');
    await expect(at(page)).toHaveText('Frame 11');
    await expect(page.locator('#play')).toHaveAccessibleName('Play');
    // The button that was pressed last was not pressed again.
    await expect(page.getByRole('button', { name: 'Speed' })).toHaveText(speed!);
    // One that Tab reaches is.
    await page.keyboard.press('Shift+Tab');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Space');
    await expect(page.getByRole('button', { name: 'Speed' })).not.toHaveText(speed!);
  });

  await test.step('the picture that Tab reaches takes arrows for its brush', async () => {
    await page.keyboard.press('b');
    await page.locator('.layers').focus();
    await page.keyboard.press('ArrowLeft');
    await expect(page.locator('#strokes .brush')).not.toHaveAttribute('r', '0');
    await expect(at(page)).toHaveText('Frame 11');
  });
});

test('a click selects a name, a double click or F2 renames, Escape leaves it', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const rows = page.locator('#objects > li');
  const name = rows.nth(1).locator('.motion-name');
  await name.click({ position: { x: 12, y: 10 } });
  await expect(rows.nth(1)).toHaveClass(/selected/);
  await page.keyboard.press('e');
  await expect(name).toHaveValue('Object 1');
  await expect(page.locator('#tools [name=tool]:checked')).toHaveValue('eraser');
  await name.dblclick({ position: { x: 12, y: 10 } });
  await page.keyboard.type('Disc');
  await page.keyboard.press('Enter');
  await expect(name).toHaveValue('Disc');
  // The row moves up when it is pressed, because that of the other object shows no actions any more.
  await rows.nth(2).locator('.motion-name').dblclick({ position: { x: 12, y: 10 } });
  await page.keyboard.type('Cube');
  await page.keyboard.press('Enter');
  await expect(rows.nth(2).locator('.motion-name')).toHaveValue('Cube');
  await expect(rows.nth(2)).toHaveClass(/selected/);
  await page.keyboard.press('2');
  await page.keyboard.press('F2');
  await page.keyboard.type('Box');
  await page.keyboard.press('Tab');
  await expect(rows.nth(2).locator('.motion-name')).toHaveValue('Box');
  await page.keyboard.press('F2');
  await page.keyboard.type('Ball');
  await page.keyboard.press('Escape');
  await expect(rows.nth(2).locator('.motion-name')).toHaveValue('Box');
  await expect(name).toHaveValue('Disc');
  // A name that is empty is the default, also where it was that before.
  for (let k = 0; k < 2; k++) {
    await name.dblclick({ position: { x: 12, y: 10 } });
    await page.keyboard.press('Backspace');
    await page.keyboard.press('Enter');
    await expect(name).toHaveValue('Object 1');
  }
});

test('the list of keys is in groups, and nothing in it overlaps', async ({ page }) => {
  await openEmpty(page);
  for (const [width, height] of [[1280, 720], [640, 360], [360, 640]] as const) {
    await page.setViewportSize({ width, height });
    await page.keyboard.press('?');
    const dialog = page.getByRole('dialog', { name: 'Keyboard shortcuts' });
    await expect(dialog.getByRole('heading', { level: 3 })).toHaveText(['Frames', 'Review', 'Tools', 'Masks', 'What is shown', 'With the picture focused by Tab']);
    const overlapping = await dialog.evaluate((root) => {
      const parts = [...root.querySelectorAll('h3, kbd, dd')].map((part) => ({ text: part.textContent, box: part.getBoundingClientRect() }));
      const meet = (one: DOMRect, other: DOMRect): boolean => one.left < other.right - 1 && other.left < one.right - 1 && one.top < other.bottom - 1 && other.top < one.bottom - 1;
      return parts.flatMap(({ text, box }, k) => parts.slice(k + 1).filter((other) => meet(box, other.box)).map((other) => `${text} / ${other.text}`));
    });
    expect(overlapping).toEqual([]);
    expect(await dialog.evaluate((root) => root.scrollWidth - root.clientWidth)).toBeLessThanOrEqual(0);
    await page.keyboard.press('Escape');
  }
});
