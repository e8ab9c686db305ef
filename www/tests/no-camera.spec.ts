//! A machine without a camera: asking for it costs nothing that is open.

import config from '../playwright.config.js';
import { film } from './film.js';
import { done, expect, open, test, upload } from './support.js';

const { launchOptions } = config.use!;
test.use({ launchOptions: { ...launchOptions, args: launchOptions!.args!.filter((arg) => !arg.startsWith('--use-fake')) } });

test('without a camera the film stays open', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await open(page);
  await upload(page, [await film(page, 4, 'webm', 'vp8')]);
  await expect(page.locator('#film-name')).toHaveText('film.webm, 4 frames, 192 × 128');
  await done(page);
  await page.getByRole('button', { name: 'Camera' }).click();
  await expect(page.locator('#notice-code')).toHaveText('no-camera');
  await expect(page.locator('#timeline')).toBeVisible();
  await expect(page.locator('#run')).toHaveAttribute('data-phase', 'done');
  await expect(page.locator('#motions > li').first()).toBeVisible();
  await page.getByRole('button', { name: 'Step both forward' }).click();
  await expect(page.locator('[data-slot=first] .slot-name')).toContainText('#1,');
  await done(page);
  await expect(page.getByRole('alert')).toBeHidden();
});
