//! A machine without a camera: trying to use one closes nothing.

import config from '../playwright.config.js';
import { video } from './video.js';
import { done, expect, openEmpty, test, upload } from './support.js';

const { launchOptions } = config.use!;
test.use({ launchOptions: { ...launchOptions, args: launchOptions!.args!.filter((arg) => !arg.startsWith('--use-fake')) } });

test('a clip stays open if there is no camera', async ({ page, context }) => {
  await context.grantPermissions(['camera']);
  await openEmpty(page);
  await upload(page, [await video(page, 4, 'webm', 'vp8')]);
  await expect(page.locator('#clip-name')).toHaveText('clip.webm, 4 frames, 192 × 128');
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
