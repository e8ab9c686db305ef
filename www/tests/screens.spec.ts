//! Pictures of the page in its states, in `out/screens/`, for people to look at. Each waits for the state it shows.

import { done, expect, open, sample, screen, square, test, upload } from './support.js';

test('desktop', async ({ page }) => {
  await open(page, 'groups');
  await page.screenshot({ path: screen('desktop') });
  await page.screenshot({ path: screen('desktop-whole'), fullPage: true });
});

test('dark', async ({ page }) => {
  await page.emulateMedia({ colorScheme: 'dark' });
  await open(page, 'groups');
  await page.screenshot({ path: screen('dark') });
});

test('phone', async ({ page }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await open(page, 'groups');
  await page.screenshot({ path: screen('phone'), fullPage: true });
});

test('error', async ({ page }) => {
  await open(page, 'groups');
  await upload(page, [await sample('first'), await square('second.png', 640, 480, 0, 0)]);
  await expect(page.getByRole('alert')).toBeVisible();
  await page.screenshot({ path: screen('error') });
});

test('progress', async ({ page, context }) => {
  // Held back until the picture is taken.
  let release = (): void => undefined;
  const held = new Promise<void>((resolve) => (release = resolve));
  await context.route('**/*worker*.js', async (route) => {
    await held;
    await route.continue().catch(() => undefined);
  });
  await page.goto('./');
  await expect(page.getByRole('progressbar')).toBeVisible();
  await page.screenshot({ path: screen('progress') });
  release();
  await done(page);
});
