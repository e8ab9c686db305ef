//! Long work says how far it is, also in a tab that nobody looks at.

import { cancelWhen, clipDone, clipPhase, drag, expect, hide, holdBack, openClip, openSegmented, clipFrames, test } from './support.js';

test('the title of the tab says how far a clip is and, in the background, that it is done', async ({ page }) => {
  const own = 'Veronese: masks of what moves';
  await openClip(page, await clipFrames(8));
  await expect(page).toHaveTitle(own);
  const titles = await page.evaluateHandle(() => {
    const titles: string[] = [];
    new MutationObserver(() => titles.push(document.title)).observe(document.querySelector('title')!, { childList: true });
    return titles;
  });
  await hide(page);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipDone(page);
  await expect(page).toHaveTitle(`✓ f00 to f07 · ${own}`);
  expect((await titles.jsonValue()).filter((title) => /^\d+\u00a0% f00 to f07 · /.test(title)).length).toBeGreaterThan(1);
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'visible', configurable: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await expect(page).toHaveTitle(own);

  const release = await holdBack(page, 'f02.png');
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await page.locator('#clip-cancel').click();
  await release();
  await clipPhase(page, 'cancelled');
  await expect(page).toHaveTitle(own);
});

test('a correction says how far it is and how long it takes, goes on in the background, and can be cancelled', async ({ page }) => {
  const own = 'Veronese: masks of what moves';
  await openSegmented(page, await clipFrames(12));
  await page.locator('#objects li').nth(1).locator('.motion-head').click();
  await page.locator('#tools [value=brush]').check();
  await expect(page.locator('#strokes .brush')).toBeAttached();
  const told = await page.evaluateHandle(() => {
    const told = { titles: new Set<string>(), shares: new Set<number>() };
    new MutationObserver(() => {
      told.titles.add(document.title);
      told.shares.add(document.querySelector<HTMLProgressElement>('#clip-progress')!.value);
    }).observe(document, { childList: true, subtree: true, characterData: true });
    return told;
  });
  // As browsers treat a page that nobody sees: it is not drawn, and timers go off once a second.
  await page.evaluate(() => {
    const soon = window.setTimeout.bind(window);
    window.requestAnimationFrame = () => 0;
    Object.assign(window, { setTimeout: (what: () => void, ms = 0) => soon(what, Math.max(1000, ms)) });
  });
  const release = await holdBack(page, 'f09.png');
  await drag(page, [0.3, 0.3], [0.4, 0.4]);
  await hide(page);
  await expect(page.locator('#clip-detail')).toHaveText(/^\d+ of 12 frames, about \d+\s+s left$/);
  await release();
  await clipDone(page);
  await expect(page.locator('#clip-status')).toHaveText(/^Corrected/);
  await expect(page).toHaveTitle(`✓ f00 to f11 · ${own}`);
  const { titles, shares } = await told.evaluate(({ titles, shares }) => ({ titles: [...titles], shares: [...shares] }));
  expect(titles.some((title) => /^\d+\u00a0% f00 to f11 · /.test(title))).toBe(true);
  expect(Math.max(...shares)).toBe(1);

  await cancelWhen(page, /^[2-9] of 12 frames/);
  await drag(page, [0.6, 0.6], [0.7, 0.7]);
  await expect(page.locator('#clip-status')).toHaveText('Undone.');
});
