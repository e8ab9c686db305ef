//! The page as a first visitor meets it: it opens with a clip and segments it.

import type { Page } from '@playwright/test';

import { axe, clipDone, clipPhase, done, expect, labelsOnCanvas, open, openExport, openSampleClip, square, test, upload, withSmallSampleClip } from './support.js';

/** The frame that is shown first. */
const START = 32;
/** Pixels inside the cars in that frame. */
const WHITE = { x: 125, y: 150 };
const RED = { x: 265, y: 150 };

/** Whether the browser has kept anything. */
async function isAnythingKept(page: Page): Promise<boolean> {
  return page.evaluate(async () => {
    const folder = await navigator.storage.getDirectory();
    for await (const _ of folder.keys()) return true;
    return false;
  });
}

test('the page opens with a clip and finds its two cars', async ({ page }) => {
  await page.goto('./');
  await expect(page.locator('#clip-name')).toHaveText('passing-cars, 51 frames, 512 × 288');
  await expect(page.locator('#clip-first-at')).toHaveText(`#${START}`);
  await expect(page.locator('footer')).toContainText('Intel IoT DevKit sample-videos, car-detection.mp4, CC BY 4.0');
  // Masks of the frame on screen are there while the clip is being segmented, which can be watched and cancelled.
  await done(page);
  expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
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
  expect([WHITE, RED].map(({ x, y }) => labels[512 * y + x])).toEqual([1, 2]);
  expect(await axe(page)).toEqual([]);
  // Nothing was done that would have to be kept, or asked about.
  await page.waitForTimeout(1000);
  expect(await isAnythingKept(page)).toBe(false);
});

test('whoever touches the page first is not shown the clip; nothing of projects is loaded', async ({ page }) => {
  const asked: string[] = [];
  page.on('request', (request) => asked.push(request.url()));
  await withSmallSampleClip(page);
  await page.goto('./');
  await page.locator('#clip-progress').waitFor();
  await page.keyboard.press('v');
  await clipDone(page);
  await page.waitForTimeout(1000); // what is kept is written soon
  await expect(page.locator('#caption')).toHaveText(`Frame ${START}`);
  await expect(page.locator('#play')).toHaveAccessibleName('Play');
  expect(asked.filter((url) => /shelf-|projects-/.test(url))).toEqual([]);
});

test('work on the clip is kept, and the next visit continues with it', async ({ page }) => {
  await withSmallSampleClip(page);
  await openSampleClip(page);
  const name = page.locator('#objects .motion-name').first();
  await name.fill('White car');
  await name.press('Enter');
  await page.getByRole('button', { name: 'Accept all' }).click();
  await expect(page.locator('#reviewed')).toHaveText('51 of 51 accepted');
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText(/^Your work is kept in this browser/);
  await page.reload();
  await expect(page.locator('#clip-status')).toHaveText('Continued: 2 objects in 51 frames.');
  await expect(name).toHaveValue('White car');
  await expect(page.locator('#reviewed')).toHaveText('51 of 51 accepted');
});

test('another sample replaces the clip while it is segmented, and the clip comes back; cancelled, it is continued', async ({ page }) => {
  await withSmallSampleClip(page);
  await page.goto('./#quality=fast');
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await page.getByRole('button', { name: 'Two cars' }).click();
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('first.png, 768 × 432');
  await done(page);
  await expect(page.locator('#timeline')).toBeHidden();
  await page.getByRole('button', { name: 'Passing cars' }).click();
  await expect(page.locator('#clip-first-at')).toHaveText(`#${START}`);
  await page.locator('#clip-cancel').click();
  await clipPhase(page, 'cancelled');
  await page.locator('#clip-segment').click();
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText('2 objects in 51 frames.');
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
});

test('a link to a pair opens no clip, and one to the clip is the page itself', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await withSmallSampleClip(page);
  await page.goto('./#sample=parallax&quality=fast');
  await done(page);
  await expect(page.locator('#timeline')).toBeHidden();
  await page.evaluate(() => (location.hash = '#sample=passing-cars&quality=fast'));
  await expect(page.locator('#clip-name')).toHaveText('passing-cars, 51 frames, 128 × 72');
  await clipDone(page);
  await page.locator('#look [value=groups]').check();
  await done(page);
  await openExport(page);
  await page.getByRole('button', { name: 'Copy link' }).click();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/\/#quality=fast$/);
});

test('the samples are moving pictures, still where nothing should move and out of view', async ({ page }) => {
  const states = (): Promise<string[]> =>
    page.evaluate(() => [...document.querySelectorAll('#samples img')].map((image) => image.getAnimations()[0]?.playState ?? 'none'));
  await page.goto('./#sample=parallax&quality=fast');
  await done(page);
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

test('the name has its typeface at once, and is as wide in any other', async ({ page }) => {
  await open(page, 'groups');
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

test('text has three sizes, and figures one width', async ({ page }) => {
  await open(page, 'groups');
  await page.locator('#settings details').evaluate((details) => void ((details as HTMLDetailsElement).open = true));
  await page.locator('#motions details').nth(1).evaluate((details) => void ((details as HTMLDetailsElement).open = true));
  await openExport(page);
  await expect(page.getByRole('button', { name: 'Save project' })).toBeEnabled();
  const odd = await page.evaluate(() => {
    const said = [...document.body.querySelectorAll<HTMLElement>('*')].filter(
      (part) => part.matches('input[type=text], input[type=number], select') || [...part.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent!.trim() !== ''),
    );
    return said
      .filter((part) => part.localName !== 'h1' && part.checkVisibility())
      .map((part) => ({ part, style: getComputedStyle(part) }))
      .filter(({ style }) => !['12px', '13px', '16px'].includes(style.fontSize) || (style.fontVariantNumeric !== 'tabular-nums' && !style.fontFamily.includes('monospace')))
      .map(({ part, style }) => `${part.localName}#${part.id}.${part.className} ${style.fontSize} ${style.fontVariantNumeric}`);
  });
  expect(odd).toEqual([]);
});
