//! Screenshots of the page in various states, in all sizes, light and dark, written to `out/screens/` to be looked at.

import { type Page } from '@playwright/test';

import { PAIR, clipDone, clipFrames, done, expect, goTo, inspect, openClip, openExport, sample, screen, square, test, upload } from '../tests/support.js';

const SIZES = [[1440, 900], [1280, 720], [390, 844]] as const;
const SCHEMES = ['light', 'dark'] as const;
const ALL = SIZES.flatMap(([width, height]) => SCHEMES.map((colorScheme) => ({ width, height, colorScheme })));

for (const { width, height, colorScheme } of ALL) {
  const shot = async (page: Page, state: string, fullPage = false): Promise<void> => {
    await page.waitForTimeout(300); // transitions and thumbnails
    expect(await page.evaluate(() => matchMedia('(prefers-color-scheme: dark)').matches)).toBe(colorScheme === 'dark');
    await page.screenshot({ path: screen(`${state}-${width}-${colorScheme}`), fullPage });
  };

  test.describe(`${width}, ${colorScheme}`, () => {
    test.use({ viewport: { width, height }, colorScheme, hasTouch: width < 640, isMobile: width < 640 });

    test('the first page', async ({ page }) => {
      await page.goto('./');
      await done(page);
      await page.screenshot({ path: screen(`start-working-${width}-${colorScheme}`) });
      await clipDone(page);
      await page.keyboard.press('v'); // it does not play
      await goTo(page, 32);
      await shot(page, 'start');
      await shot(page, 'start-whole', true);
    });

    test('a pair', async ({ page }) => {
      await page.goto(PAIR);
      await clipDone(page);
      await shot(page, 'pair');
      await shot(page, 'pair-whole', true);
      await inspect(page);
      await page.locator('#inspect [value=split]').check({ force: true });
      await page.locator('.stage').scrollIntoViewIfNeeded();
      await shot(page, 'split');
      await page.locator('#inspect [name=motions]').check({ force: true });
      await page.locator('#motions .more summary').nth(1).click();
      await page.locator('#settings details summary').click();
      await page.evaluate(() => window.scrollTo(0, 0));
      await shot(page, 'motions', true);
      await page.locator('#tools [value=brush]').check({ force: true });
      const box = (await page.locator('.layers').boundingBox())!;
      await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.3 * box.height);
      await page.mouse.down();
      await page.mouse.move(box.x + 0.26 * box.width, box.y + 0.7 * box.height, { steps: 8 });
      await shot(page, 'brush');
      await page.mouse.up();
      await clipDone(page);
      await page.keyboard.press('?');
      await shot(page, 'keys');
      await page.keyboard.press('Escape');
      await upload(page, [await sample('first'), await square('second.png', 640, 480, 0, 0)]);
      await expect(page.getByRole('alert')).toBeVisible();
      await shot(page, 'error');
    });

    test('a clip', async ({ page }) => {
      await openClip(page, await clipFrames(8, 480, 300));
      await shot(page, 'clip-opened', true);
      await page.locator('#clip-segment').click();
      await expect(page.locator('#clip-detail')).toContainText('of 8 frames');
      await page.screenshot({ path: screen(`clip-segmenting-${width}-${colorScheme}`) });
      await clipDone(page);
      await page.getByRole('slider', { name: 'In point' }).press('ArrowRight');
      await page.getByRole('slider', { name: 'Out point' }).press('ArrowLeft');
      await page.locator('#objects li').nth(1).locator('.motion-head').click();
      await page.locator('#tools [value=brush]').check({ force: true });
      await page.locator('.stage').scrollIntoViewIfNeeded();
      await shot(page, 'clip-segmented');
      await shot(page, 'clip-segmented-whole', true);
      if (ALL[0]!.width === width && ALL[0]!.colorScheme === colorScheme) await showExport(page);
    });
  });
}

test('the host page', async ({ page }) => {
  await page.goto('./embed.html');
  await expect(page.locator('#host-status')).toHaveText(/in 33 frames/);
  for (const { width, height, colorScheme } of ALL) {
    await page.setViewportSize({ width, height });
    await page.emulateMedia({ colorScheme });
    await page.screenshot({ path: screen(`embed-${width}-${colorScheme}`), fullPage: true });
  }
});

test('progress', async ({ page, context }) => {
  // The worker is held back until the screenshot is taken.
  let release = (): void => undefined;
  const held = new Promise<void>((resolve) => (release = resolve));
  await context.route('**/*worker*.js', async (route) => {
    await held;
    await route.continue().catch(() => undefined);
  });
  await page.goto(`${PAIR}&quality=fast`);
  await expect(page.getByRole('progressbar')).toBeVisible();
  await page.screenshot({ path: screen('progress') });
  release();
  await clipDone(page);
});

/** The panel of exports of the clip that is open, in all sizes, light and dark. */
async function showExport(page: Page): Promise<void> {
  await page.getByRole('slider', { name: 'Current frame' }).press('PageDown');
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    for (const colorScheme of SCHEMES) {
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
}
