//! The page as a first visitor meets it: it opens with a clip and segments it.

import type { Page } from '@playwright/test';

import { axe, clipDone, clipFrames, clipPhase, done, enter, expect, held, labelsOnCanvas, leaves, openExport, openSample, square, test, upload, withSmallSampleClip } from './support.js';

/** The frame that is shown first. */
const START = 32;
/** Places inside the cars in that frame, 0 to 1. */
const WHITE = [0.245, 0.52] as const;
const RED = [0.52, 0.52] as const;

/** Whether the browser has kept anything. */
async function isAnythingKept(page: Page): Promise<boolean> {
  return page.evaluate(async () => {
    const folder = await navigator.storage.getDirectory();
    for await (const _ of folder.keys()) return true;
    return false;
  });
}

/** As a first visitor sees it, until it rests. */
async function firstVisit(page: Page, width: number, height: number): Promise<void> {
  await page.goto('./');
  await expect(page.locator('#clip-name')).toHaveText(`passing-cars, 51 frames, ${width} × ${height}`);
  await expect(page.locator('#clip-first-at')).toHaveText(`#${START}`);
  await expect(page.locator('footer')).toContainText('Intel IoT DevKit sample-videos, car-detection.mp4, CC BY 4.0');
  // Masks of the frame on screen are there while the clip is being segmented, which can be watched and cancelled.
  await done(page);
  await expect.poll(async () => new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
  await expect(page.locator('#clip-progress')).toBeVisible();
  await expect(page.locator('#clip-detail')).toContainText('of 51 frames');
  await expect(page.locator('#clip-cancel')).toBeEnabled();
  // The frames come with what is found, which cannot be worked on yet.
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await expect(page.locator('#caption')).not.toHaveText(`Frame ${START}`);
  await expect(page.locator('#objects')).toHaveAttribute('inert');
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await clipDone(page);
  await expect(page.locator('#objects')).not.toHaveAttribute('inert');
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 51 frames.');
  // It plays, and ends where it began.
  await expect(page.locator('#play')).toHaveAccessibleName('Pause');
  await expect(page.locator('#caption')).not.toHaveText(`Frame ${START}`);
  await expect(page.locator('#caption')).toHaveText(`Frame ${START}`);
  await expect(page.locator('#play')).toHaveAccessibleName('Play');
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await expect(page.locator('#status')).toHaveText('2 objects in this frame.');
  const labels = await labelsOnCanvas(page);
  expect([WHITE, RED].map(([x, y]) => labels[width * Math.floor(y * height) + Math.floor(x * width)])).toEqual([1, 2]);
}

test('the page opens with a clip, shows what is found, and keeps nothing of it; work on it is kept', async ({ page }) => {
  await withSmallSampleClip(page);
  await firstVisit(page, 64, 36);
  expect(await axe(page)).toEqual([]);
  // Nothing was done that would have to be kept, or asked about.
  expect(await leaves(page)).toBe(true);
  expect(await isAnythingKept(page)).toBe(false);
  const name = page.locator('#objects .motion-name').first();
  await enter(name, 'White car');
  await page.getByRole('button', { name: 'Accept all' }).click();
  await expect(page.locator('#reviewed')).toHaveText('51 of 51 accepted');
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText(/^Your work is kept in this browser/);
  await page.reload();
  await expect(page.locator('#clip-status')).toHaveText('Continued: 2 objects in 51 frames.');
  await expect(name).toHaveValue('White car');
  await expect(page.locator('#reviewed')).toHaveText('51 of 51 accepted');
});

test('the same clip at its own size', { tag: '@soak' }, async ({ page }) => {
  await firstVisit(page, 512, 288);
});

test('whoever touches the page or opens something first is not shown the clip; nothing of projects is loaded', async ({ page }) => {
  const asked: string[] = [];
  page.on('request', (request) => asked.push(request.url()));
  await withSmallSampleClip(page);
  const release = await held(page, 'slow.png');
  await page.goto('./');
  await page.locator('#clip-progress').waitFor();
  await page.keyboard.press('v');
  await clipDone(page);
  await expect(page.locator('#caption')).toHaveText(`Frame ${START}`);
  await page.keyboard.press('.');
  await expect(page.locator('#caption')).toHaveText(`Frame ${START + 1}`);
  await expect(page.locator('#play')).toHaveAccessibleName('Play');
  await done(page);
  expect(await leaves(page)).toBe(true);
  expect(asked.filter((url) => /shelf-|projects-/.test(url))).toEqual([]);

  await test.step('files that are being read while frames are shown, and while they play, are opened', async () => {
    const opened = async (): Promise<void> => {
      await release();
      await expect(page.locator('.slot-name')).toHaveText(['other.png, 96 × 64', 'slow.png, 96 × 64']);
      await done(page);
    };
    const files = [await square('other.png', 96, 64, 0, 0), await square('slow.png', 96, 64, 2, 0)];
    await page.reload();
    await page.locator('#clip-progress').waitFor();
    await upload(page, files);
    await clipDone(page);
    await opened();
    await page.reload();
    await upload(page, await clipFrames(4, 96, 64));
    await expect(page.locator('#clip-name')).toContainText('4 frames');
    await page.getByRole('button', { name: 'Speed' }).click();
    await page.getByRole('button', { name: 'Speed' }).click();
    await page.getByRole('button', { name: 'Play', exact: true }).click();
    await upload(page, files);
    await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();
    await opened();
  });
});

test('a link to a sample opens it, and one to the first is the page itself; another sample replaces it, and it comes back; cancelled, it is continued', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await withSmallSampleClip(page);
  await page.goto('./#sample=parallax&quality=fast');
  await done(page);
  await expect(page.locator('#clip-name')).toHaveText('parallax, 2 frames, 400 × 300');
  await page.evaluate(() => (location.hash = '#sample=passing-cars&quality=fast'));
  await expect(page.locator('#clip-name')).toHaveText('passing-cars, 51 frames, 64 × 36');
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await openSample(page, 'Parallax');
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('first.png, 400 × 300');
  await done(page);
  await expect(page.locator('#clip-name')).toHaveText('parallax, 2 frames, 400 × 300');
  await openSample(page, 'Passing cars');
  await expect(page.locator('#clip-first-at')).toHaveText(`#${START}`);
  await page.locator('#clip-cancel').click();
  await clipPhase(page, 'cancelled');
  await page.locator('#clip-segment').click();
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 51 frames.');
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await page.locator('#look [value=groups]').check();
  await done(page);
  await openExport(page);
  await page.getByRole('button', { name: 'Copy link' }).click();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/\/#quality=fast$/);
});

test('the looks of the page', async ({ page }) => {
  await page.goto('./#sample=parallax&quality=fast&masks=groups');
  await done(page);

  await test.step('the samples are moving pictures, still where nothing should move and out of view', async () => {
    const states = (): Promise<string[]> =>
      page.evaluate(() => [...document.querySelectorAll('#samples img')].map((image) => image.getAnimations()[0]?.playState ?? 'none'));
    const [cars, , parallax] = await page.locator('#samples button').all();
    await expect(parallax!).toHaveAttribute('aria-current', 'true');
    await expect(cars!).toHaveAttribute('aria-current', 'false');
    await expect.poll(states).toEqual(['running', 'running', 'running']);
    await page.locator('#welcome summary').first().click();
    await expect.poll(states).not.toContain('running');
    await page.locator('#welcome summary').first().click();
    await expect.poll(states).toEqual(['running', 'running', 'running']);
    // Beside other frames they rest until they are pointed at.
    await upload(page, [await square('one.png', 96, 64, 0, 0), await square('two.png', 96, 64, 4, 1)]);
    await done(page);
    await expect(parallax!).toHaveAttribute('aria-current', 'false');
    await expect.poll(states).toEqual(['paused', 'paused', 'paused']);
    await cars!.hover();
    await expect.poll(states).toEqual(['running', 'paused', 'paused']);
    // One picture after another is in the window, and each lies in it as a whole.
    const seen = await cars!.locator('img').evaluate(async (image: HTMLImageElement) => {
      await image.decode();
      const [animation] = image.getAnimations();
      animation!.pause();
      const { left, width } = image.parentElement!.getBoundingClientRect();
      const count = Number(animation!.effect!.getComputedTiming().duration) / 140;
      const places = Array.from({ length: Math.round(count) }, (_, k) => {
        animation!.currentTime = 140 * k + 70;
        return (left - image.getBoundingClientRect().left) / width;
      });
      return { places, shape: image.naturalWidth / image.naturalHeight };
    });
    expect(seen.places).toHaveLength(14);
    for (const [k, place] of seen.places.entries()) expect(place).toBeCloseTo(k, 3);
    expect(seen.shape).toBeCloseTo(14 * 1.5, 5);
    await page.emulateMedia({ reducedMotion: 'reduce' });
    await expect.poll(states).toEqual(['none', 'none', 'none']);
  });

  await test.step('the name has its typeface at once, and is as wide in any other', async () => {
    const { loaded, asked, left } = await page.evaluate(async () => {
      await document.fonts.ready;
      const before = document.querySelector('#status')!.getBoundingClientRect().left;
      const name = document.querySelector('h1')!;
      name.style.fontFamily = 'monospace';
      const asked = document.querySelector('link[as=font]')?.getAttribute('href') ?? '';
      return { loaded: document.fonts.check('700 26px Wordmark', 'Veronese'), asked, left: [before, document.querySelector('#status')!.getBoundingClientRect().left] };
    });
    expect(loaded).toBe(true);
    expect(asked).toMatch(/cormorant-garamond-.*\.woff2$/);
    expect(left[1]).toBe(left[0]);
  });
});
