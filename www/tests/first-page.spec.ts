//! The page as a first visitor meets it: it opens with a clip and segments it.

import type { Page } from '@playwright/test';

import { SMALL_SAMPLE, clipDone, clipFrames, clipPhase, done, enter, expect, held, holdBack, labelsOnCanvas, leaves, opened, openExport, openSample, said, square, test, upload, withSmallSampleClip } from './support.js';

/** Places inside the cars in the frame that is shown first, 0 to 1. */
const WHITE = [0.245, 0.52] as const;
const RED = [0.52, 0.52] as const;

const { count: COUNT, start: START } = SMALL_SAMPLE;
/** A frame after that, without which the clip is not done. */
const LATE = '10.webp';
/** The frame without which no pair is solved, so that there is nothing to show. */
const SECOND = '01.webp';

/** Whether the browser has kept anything. */
async function isAnythingKept(page: Page): Promise<boolean> {
  return page.evaluate(async () => {
    const folder = await navigator.storage.getDirectory();
    for await (const _ of folder.keys()) return true;
    return false;
  });
}

/** As a first visitor sees it, until it rests. */
async function firstVisit(page: Page, [width, height]: readonly [number, number], { count, start, late }: { count: number; start: number; late: string }): Promise<void> {
  const release = await held(page, late);
  // The frames that the page has shown: which of those that are solved at once is the last one, nobody knows.
  await page.addInitScript(() => {
    const shown = new Set<string>();
    Object.assign(window, { shown });
    new MutationObserver(() => shown.add(document.querySelector('#caption')?.textContent ?? '')).observe(document, { childList: true, characterData: true, subtree: true });
  });
  await page.goto('./');
  await expect(page.locator('#clip-name')).toHaveText(`passing-cars, ${count} frames, ${width} × ${height}`);
  await expect(page.locator('footer')).toContainText('Intel IoT DevKit sample-videos, car-detection.mp4, CC BY 4.0');
  // The frames come with what is found while the clip is being segmented, which can be watched and cancelled. It cannot be worked on yet.
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await expect.poll(async () => new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
  const shown = (): Promise<string[]> => page.evaluate(() => [...(window as unknown as { shown: Set<string> }).shown].filter((caption) => caption !== ''));
  await expect.poll(async () => (await shown()).length).toBeGreaterThan(1);
  expect((await shown())[0]).toBe(`Frame ${start}`);
  await expect(page.locator('#objects')).toHaveAttribute('inert');
  await expect(page.locator('#clip-progress')).toBeVisible();
  await expect(page.locator('#clip-detail')).toContainText(`of ${count} frames`);
  await expect(page.locator('#clip-cancel')).toBeEnabled();
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  // Then it plays twice, and ends where it began.
  const played = await page.evaluateHandle(() => {
    const [caption, play] = ['#caption', '#play'].map((part) => document.querySelector(part)!) as [Element, Element];
    const played = { frames: new Set<string>(), times: 0 };
    new MutationObserver((changes) => {
      if (play.getAttribute('aria-label') === 'Pause') played.frames.add(caption.textContent);
      else if (changes.some(({ target }) => target === play)) played.times += 1;
    }).observe(document.body, { childList: true, characterData: true, subtree: true, attributeFilter: ['aria-label'] });
    return played;
  });
  await release();
  await clipDone(page);
  await expect(page.locator('#objects')).not.toHaveAttribute('inert');
  await expect(page.locator('#clip-status')).toHaveText(`2 objects in ${count} frames.`);
  await expect.poll(() => played.evaluate(({ times }) => times)).toBe(2);
  for (let k = 1; k < count; k++) expect(await played.evaluate(({ frames }) => [...frames])).toContain(`Frame ${k}`);
  await expect(page.locator('#caption')).toHaveText(`Frame ${start}`);
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await expect(page.locator('#status')).toHaveText('2 objects in this frame.');
  const labels = await labelsOnCanvas(page);
  expect([WHITE, RED].map(([x, y]) => labels[width * Math.floor(y * height) + Math.floor(x * width)])).toEqual([1, 2]);
}

test('the page opens with a clip, shows what is found, and keeps nothing of it; work on it is kept', async ({ page }) => {
  await withSmallSampleClip(page);
  await firstVisit(page, [64, 36], { count: COUNT, start: START, late: LATE });
  // Nothing was done that would have to be kept, or asked about.
  expect(await leaves(page)).toBe(true);
  expect(await isAnythingKept(page)).toBe(false);
  const name = page.locator('#objects .motion-name').nth(1);
  await enter(name, 'White car');
  await page.getByRole('button', { name: 'Accept all' }).click();
  await expect(page.locator('#reviewed')).toHaveText(`${COUNT} of ${COUNT} accepted`);
  await openExport(page);
  await expect(page.locator('#project-status')).toHaveText(/^Your work is kept in this browser/);
  await page.reload();
  // The frame that came late to the first visit.
  await page.evaluate((name) => (window as unknown as Record<string, () => void>)[`release ${name}`]!(), LATE);
  await said(page, new RegExp(`^Continued: 2 objects in ${COUNT} frames\\.$`));
  await expect(name).toHaveValue('White car');
  await expect(page.locator('#reviewed')).toHaveText(`${COUNT} of ${COUNT} accepted`);
});

test('the same clip at its own size', { tag: '@soak' }, async ({ page }) => {
  await firstVisit(page, [512, 288], { count: 51, start: 32, late: '36.webp' });
});

test('whoever touches the page or opens something first is not shown the clip; nothing of projects is loaded', async ({ page }) => {
  const asked: string[] = [];
  page.on('request', (request) => asked.push(request.url()));
  await withSmallSampleClip(page);
  const goOn = await held(page, SECOND);
  const release = await held(page, 'slow.png');
  await page.goto('./');
  await page.locator('#clip-progress').waitFor();
  await page.keyboard.press('v');
  await goOn();
  await clipDone(page);
  await expect(page.locator('#caption')).toHaveText(`Frame ${START}`);
  await page.keyboard.press('.');
  await expect(page.locator('#caption')).toHaveText(`Frame ${START + 1}`);
  await expect(page.locator('#play')).toHaveAccessibleName('Play');
  await done(page);
  expect(await leaves(page)).toBe(true);
  expect(asked.filter((url) => /shelf-|projects-/.test(url))).toEqual([]);

  await test.step('files that are being read while frames are shown, and while they play, are opened', async () => {
    const files = [await square('other.png', 96, 64, 0, 0), await square('slow.png', 96, 64, 2, 0)];
    await page.reload();
    await page.locator('#clip-progress').waitFor();
    await upload(page, files);
    await goOn();
    await clipDone(page);
    await release();
    await opened(page, 'other and slow, 2 frames, 96 × 64');
    await upload(page, await clipFrames(4, 96, 64));
    await opened(page, '4 frames');
    const again = await holdBack(page, 'slow.png');
    await page.getByRole('button', { name: 'Speed' }).click();
    await page.getByRole('button', { name: 'Speed' }).click();
    await page.getByRole('button', { name: 'Play', exact: true }).click();
    await upload(page, files);
    await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible();
    await again();
    await opened(page, 'other and slow, 2 frames, 96 × 64');
  });
});

test('a link to a sample opens it, and one to the first is the page itself; another sample replaces it, and it comes back; cancelled, it is continued', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await withSmallSampleClip(page);
  const release = await held(page, LATE);
  await page.goto('./#sample=parallax&quality=fast');
  await opened(page, 'parallax, 2 frames, 400 × 300');
  await page.evaluate(() => (location.hash = '#sample=passing-cars&quality=fast'));
  await expect(page.locator('#clip-name')).toHaveText(`passing-cars, ${COUNT} frames, 64 × 36`);
  await expect(page.locator('#clip-run')).toHaveAttribute('data-phase', 'working');
  await openSample(page, 'Parallax');
  await opened(page, 'parallax, 2 frames, 400 × 300');
  await openSample(page, 'Passing cars');
  await opened(page, 'passing-cars');
  await expect(page.locator('#caption')).toHaveText(`Frame ${START}`);
  await page.locator('#clip-cancel').click();
  await release();
  await clipPhase(page, 'cancelled');
  await page.locator('#clip-segment').click();
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText(`2 objects in ${COUNT} frames.`);
  await expect(page.locator('#objects > li')).toHaveCount(3); // and the background
  await openExport(page);
  await page.getByRole('button', { name: 'Copy link' }).click();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/\/#quality=fast$/);
});

test('the looks of the page', async ({ page }) => {
  await page.goto('./#sample=parallax&quality=fast&segment=asked');
  await opened(page, 'parallax');

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
    await upload(page, await clipFrames(2, 96, 64));
    await opened(page, 'f00 and f01');
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
