//! Failures are reported in a sentence, and the page stays usable.

import { type Page } from '@playwright/test';

import { done, expect, labelsOnCanvas, openEmpty, square, test, upload } from './support.js';

let opened = 0;

/** The page still segments. */
async function expectToWork(page: Page): Promise<void> {
  const name = `works-${++opened}.png`; // not one that is on screen already
  await upload(page, [await square('a.png', 96, 64, 0, 0), await square(name, 96, 64, 2, 0)]);
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText(`${name}, 96 × 64`);
  await done(page);
  await expect(page.getByRole('alert')).toBeHidden();
  expect((await labelsOnCanvas(page)).length).toBe(96 * 64);
}

/** The phases that the run has from now on. */
async function phases(page: Page): Promise<() => Promise<string[]>> {
  await page.locator('#run').evaluate((run) => {
    const phases: string[] = [];
    Object.assign(window, { phases });
    new MutationObserver(() => phases.push(run.dataset.phase!)).observe(run, { attributes: true, attributeFilter: ['data-phase'] });
  });
  return () => page.evaluate(() => (window as unknown as { phases: string[] }).phases);
}

test('a request is cancelled at once and can be repeated; what cannot be read or segmented is rejected', async ({ page, context }) => {
  // The worker's file is held back, so that the request is certain to be running.
  let release = (): void => undefined;
  const held = new Promise<void>((resolve) => (release = resolve));
  await context.route('**/*worker*.js', async (route) => {
    await held;
    await route.continue().catch(() => undefined); // the worker may have been ended
  });
  await openEmpty(page);
  const [a, b] = [await square('a.png', 96, 64, 0, 0), await square('b.png', 96, 64, 2, 0)];
  await upload(page, [a, b]);
  await expect(page.locator('[data-slot=second] .slot-name')).toHaveText('b.png, 96 × 64');
  await expect(page.locator('#run')).toHaveAttribute('data-phase', 'working');
  await expect(page.getByRole('progressbar')).toBeVisible();
  await page.getByRole('button', { name: 'Cancel' }).click();
  await expect(page.locator('#status')).toHaveText('Cancelled.');
  await expect(page.locator('#motions > li')).toHaveCount(0);
  const had = await phases(page);
  release();
  await page.getByRole('button', { name: 'Segment again' }).click();
  await done(page);
  expect((await labelsOnCanvas(page)).length).toBe(96 * 64);
  await expectToWork(page); // whatever was still to come has come
  expect((await had()).filter((phase) => phase === 'done')).toHaveLength(2);

  await test.step('a broken file is reported, and the open pair stays', async () => {
    await upload(page, [{ name: 'broken.png', mimeType: 'image/png', buffer: Buffer.from('this is not an image') }, a]);
    await expect(page.getByRole('alert')).toContainText('“broken.png” is not an image that this browser can read.');
    await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
    await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('a.png, 96 × 64');
    await expect(page.locator('#motions > li')).not.toHaveCount(0);
    await expectToWork(page);
  });

  await test.step('frames that differ in size, or are too small, are rejected with the message of the package', async () => {
    await upload(page, [a, await square('b.png', 64, 96, 0, 0)]);
    await expect(page.getByRole('alert')).toContainText('The frames differ in size: 96×64 and 64×96 pixels.');
    await expect(page.locator('#notice-code')).toHaveText('frame-size-mismatch');
    await expect(page.locator('#motions > li')).toHaveCount(0);
    await expect(page.locator('#motions-empty')).toHaveText('No masks: the segmentation failed.');
    await expectToWork(page);
    await expect(page.locator('#motions-empty')).toBeHidden();
    const dot = await square('dot.png', 1, 1, 0, 0);
    await upload(page, [dot, { ...dot, name: 'dot2.png' }]);
    await expect(page.locator('#notice-code')).toHaveText('frame-size-unsupported');
    await expectToWork(page);
  });
});

test('a missing sample is reported, and files can still be opened', async ({ page, context }) => {
  await context.route('**/samples/**', (route) => route.fulfill({ status: 200, body: 'nothing' }));
  await page.goto('./');
  await expect(page.locator('#notice-code')).toHaveText('unreadable-image');
  await expect(page.locator('#invitation')).toBeVisible();
  await expectToWork(page);
});
