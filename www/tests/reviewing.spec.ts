//! The review of a clip: frames are accepted one by one, the least certain first.

import type { Page } from '@playwright/test';

import { clipDone, clipFrames, done, drag, expect, goTo, openSegmented, test } from './support.js';

test('frames are accepted, the least certain next, and a correction takes back what it changes', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  const reviewed = page.locator('#reviewed');
  await expect(reviewed).toHaveText('0 of 4 accepted');
  await goTo(page, 2);
  await page.keyboard.press('y');
  await expect(reviewed).toHaveText('1 of 4 accepted');
  await expect(page.locator('#clip-status')).toHaveText('Accepted.');
  await expect(page.locator('#caption')).not.toHaveText('Frame 2');
  await done(page);
  // Whatever is left is gone through.
  for (let count = 2; count <= 4; count++) {
    await page.getByRole('button', { name: 'Accept', exact: true }).click();
    await expect(reviewed).toHaveText(`${count} of 4 accepted`);
    await done(page);
  }
  await expect(page.getByRole('button', { name: 'Accept all' })).toBeDisabled();

  // A correction changes masks, which are then to be accepted again; undone, they are the accepted ones.
  await goTo(page, 1);
  await page.keyboard.press('1');
  await page.keyboard.press('p');
  await page.getByRole('combobox', { name: 'Frames that follow a correction' }).selectOption('none');
  await drag(page, [0.05, 0.85], [0.1, 0.9]);
  await clipDone(page);
  await expect(reviewed).toHaveText('3 of 4 accepted');
  await page.keyboard.press('Control+z');
  await expect(reviewed).toHaveText('4 of 4 accepted');
  await page.keyboard.press('Control+z'); // the last that was accepted
  await expect(reviewed).toHaveText('3 of 4 accepted');
});

/** How many frames have each colour in the bar under the frames. */
function marks(page: Page): Promise<Record<string, number>> {
  return page.locator('#review-bar').evaluate((bar: HTMLCanvasElement) => {
    const { data } = bar.getContext('2d')!.getImageData(0, 0, bar.width, 1);
    const counts = { accepted: 0, changed: 0 };
    for (let p = 0; p < data.length; p += 4) if (data[p + 3] === 255) counts[data[p]! > data[p + 1]! ? 'changed' : 'accepted'] += 1;
    return counts;
  });
}

test('frames that a correction changed are marked, and N goes through them, the largest change first', async ({ page }) => {
  await openSegmented(page, await clipFrames(4));
  await goTo(page, 3);
  await page.keyboard.press('y');
  await expect(page.locator('#reviewed')).toHaveText('1 of 4 accepted');
  expect(await marks(page)).toEqual({ accepted: 1, changed: 0 });
  const next = page.locator('#next-change');
  await expect(next).toBeHidden();

  await page.getByRole('combobox', { name: 'Frames that follow a correction' }).selectOption('both');
  await goTo(page, 1);
  await page.keyboard.press('1');
  await page.keyboard.press('b');
  await drag(page, [0.05, 0.85], [0.3, 0.9]);
  await clipDone(page);
  const changed = Number(/^(\d+) changed$/.exec((await next.textContent())!)![1]);
  expect(changed).toBeGreaterThan(1);
  expect(changed).toBeLessThanOrEqual(3); // the accepted one stays
  expect(await marks(page)).toEqual({ accepted: 1, changed });
  await page.keyboard.press('v');
  const visited: string[] = [];
  for (let k = 0; k < changed; k++) {
    const before = await page.locator('#caption').textContent();
    await (k % 2 === 0 ? page.keyboard.press('n') : next.click());
    await expect(page.locator('#caption')).not.toHaveText(before!);
    visited.push((await page.locator('#caption').textContent())!);
  }
  expect(new Set(visited).size).toBe(changed);
  expect(visited).not.toContain('Frame 3');
  // Accepted, a change is done with; undone, there is none.
  await page.keyboard.press('y');
  await expect(next).toHaveText(`${changed - 1} changed`);
  expect(await marks(page)).toEqual({ accepted: 2, changed: changed - 1 });
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await clipDone(page);
  await expect(next).toBeHidden();
  expect(await marks(page)).toEqual({ accepted: 1, changed: 0 });
});
