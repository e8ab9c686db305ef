// Shared by the tests of figures.

import { test as base, expect } from '@playwright/test';

import { watch } from '../site.mjs';

export { expect };

/** A test that fails if its page complains. */
export const test = base.extend({
  page: async ({ page }, use) => {
    const { problems } = watch(page);
    await use(page);
    expect(problems).toEqual([]);
  },
});

/** Opens the explainer at a figure and waits until it is computed. Nothing moves by itself unless `motion` is asked for. */
export async function open(page, name, { motion = false } = {}) {
  await page.emulateMedia({ reducedMotion: motion ? 'no-preference' : 'reduce' });
  await page.goto(`method/#${name}`);
  const figure = page.locator(`figure#${name}`);
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute('data-ready', '');
  const reading = figure.locator('.reading');
  await expect(reading).not.toBeEmpty();
  return { figure, reading };
}

/** Drags a point by pixels of the screen. */
export async function drag(page, point, [dx, dy]) {
  await point.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await point.locator('.dot').boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + dx, y + height / 2 + dy, { steps: 6 });
  await page.mouse.up();
}

/** The numbers of a reading that a pattern's groups hold, once it has them. */
export async function numbers(reading, pattern) {
  await expect(reading).toContainText(pattern);
  const [, ...groups] = (await reading.textContent()).match(pattern);
  return groups.map((text) => Number(text.replace('−', '-')));
}

/** Does something, and waits until the reading is another. */
export async function changes(reading, work) {
  const before = await reading.textContent();
  await work();
  await expect(reading).not.toHaveText(before);
}
