//! The review of a clip: frames are accepted one by one, the least certain first.

import { axe, clipDone, clipFrames, done, drag, expect, goTo, openSegmented, test } from './support.js';

test('frames are accepted, the least certain next, and a correction takes back what it changes', async ({ page }) => {
  await openSegmented(page, await clipFrames(4, 100, 70));
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
  expect(await axe(page)).toEqual([]);

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
