//! Screenshots of the page in various states, written to `out/screens/` for review.

import { type Page } from '@playwright/test';

import { clipFrames, done, expect, openExport, sample, screen, square, test, upload } from './support.js';

/** Opens the page with its defaults. */
async function openBest(page: Page): Promise<void> {
  await page.goto('./');
  await done(page);
}

test('desktop', async ({ page }) => {
  await openBest(page);
  await page.screenshot({ path: screen('desktop') });
  await page.screenshot({ path: screen('desktop-whole'), fullPage: true });
});

test('dark', async ({ page }) => {
  await page.emulateMedia({ colorScheme: 'dark' });
  await openBest(page);
  await page.screenshot({ path: screen('dark') });
});

test('split, with arrows', async ({ page }) => {
  await openBest(page);
  await page.locator('#look [value=split]').check();
  await page.getByLabel('Arrows').check();
  await page.screenshot({ path: screen('split') });
});

test('residual, enlarged', async ({ page }) => {
  await openBest(page);
  await page.getByLabel('Residual').check();
  await page.getByLabel('Opacity').fill('0');
  await page.locator('#zoom-in').click();
  await page.waitForTimeout(200);
  await page.screenshot({ path: screen('residual') });
});

test('brush', async ({ page }) => {
  await openBest(page);
  await page.locator('#tools [value=brush]').check();
  const box = (await page.locator('.layers').boundingBox())!;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.26 * box.width, box.y + 0.7 * box.height, { steps: 8 });
  await page.screenshot({ path: screen('brush') });
  await page.mouse.up();
  await done(page);
});

test('folder of frames', async ({ page }) => {
  await page.emulateMedia({ colorScheme: 'dark' });
  await openBest(page);
  await upload(page, await Promise.all([0, 1, 2, 3, 4, 5].map((k) => square(`frame${k}.png`, 320, 180, 3 * k, k))));
  await done(page);
  await page.locator('#timeline').scrollIntoViewIfNeeded();
  await page.waitForTimeout(300);
  await page.screenshot({ path: screen('clip'), fullPage: true });
});

test('keys', async ({ page }) => {
  await openBest(page);
  await page.keyboard.press('?');
  await page.screenshot({ path: screen('keys') });
});

for (const [width, height] of [[1440, 900], [1280, 720], [390, 844]] as const) {
  for (const colorScheme of ['light', 'dark'] as const) {
    test(`host page, ${width}, ${colorScheme}`, async ({ page }) => {
      await page.setViewportSize({ width, height });
      await page.emulateMedia({ colorScheme });
      await page.goto('./embed.html');
      await page.locator('#cancel').waitFor();
      await page.screenshot({ path: screen(`embed-${width}-${colorScheme}-busy`) });
      await expect(page.locator('#host-status')).toHaveText(/in 9 frames/, { timeout: 40_000 });
      await page.getByRole('listbox').focus();
      await page.keyboard.press('ArrowDown');
      await page.keyboard.press('ArrowRight');
      await expect(page.locator('#position')).toHaveText('Frame 2 of 9');
      await page.screenshot({ path: screen(`embed-${width}-${colorScheme}`), fullPage: true });
      await page.getByRole('button', { name: 'Save' }).click();
      await page.screenshot({ path: screen(`embed-${width}-${colorScheme}-saved`) });
    });
  }
}

test('phone', async ({ page }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await openBest(page);
  await page.screenshot({ path: screen('phone'), fullPage: true });
});

test('error', async ({ page }) => {
  await openBest(page);
  await upload(page, [await sample('first'), await square('second.png', 640, 480, 0, 0)]);
  await expect(page.getByRole('alert')).toBeVisible();
  await page.screenshot({ path: screen('error') });
});

test('progress', async ({ page, context }) => {
  // The worker is held back until the screenshot is taken.
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

test('export of a clip', async ({ page }) => {
  await page.goto('./#quality=fast');
  await done(page);
  await upload(page, await clipFrames(12, 480, 300));
  await expect(page.locator('#clip-name')).toContainText('12 frames');
  await done(page);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'done', { timeout: 45_000 });
  await page.getByRole('slider', { name: 'Current frame' }).press('PageDown');
  for (const [width, height] of [[1440, 900], [1280, 720], [390, 844]] as const) {
    await page.setViewportSize({ width, height });
    for (const colorScheme of ['light', 'dark'] as const) {
      await page.emulateMedia({ colorScheme });
      await openExport(page);
      await page.getByLabel('Format of the clip').selectOption({ label: colorScheme === 'light' ? 'DAVIS' : width === 1280 ? 'CVAT, tracks' : 'Video, transparent' });
      await expect(page.locator('#clip-preview li')).not.toHaveCount(0);
      const all = page.locator('#project details');
      if (colorScheme === 'dark') await all.evaluate((details: HTMLDetailsElement) => (details.open = true));
      await page.waitForTimeout(300);
      await page.screenshot({ path: screen(`export-${width}-${colorScheme}`) });
      await page.locator('#export').evaluate((panel) => panel.scrollTo(0, panel.scrollHeight));
      await page.screenshot({ path: screen(`project-${width}-${colorScheme}`) });
    }
  }
});
