//! Stepping through a clip does not shift the layout.

import { type Page } from '@playwright/test';

import { video } from './video.js';
import { done, expect, openEmpty, openSampleClip, shown, test, upload, withSmallSampleClip } from './support.js';

/** Sums layout shifts from now on, including those after user input, which browsers exclude from their score. */
async function watchShifts(page: Page): Promise<() => Promise<number>> {
  await page.evaluate(() => {
    const shifts = { sum: 0, what: [] as string[] };
    const add = (entries: PerformanceEntryList): void => {
      for (const entry of entries as (PerformanceEntry & { value: number; sources: { node: Node | null }[] })[]) {
        shifts.sum += entry.value;
        for (const { node } of entry.sources) shifts.what.push(node instanceof Element ? `${node.localName}#${node.id}.${node.className}` : String(node?.nodeName));
      }
    };
    const observer = new PerformanceObserver((list) => add(list.getEntries()));
    observer.observe({ type: 'layout-shift' });
    Object.assign(window, { shifts, observer, add });
  });
  return () =>
    page.evaluate(async () => {
      // Of the frame that is on its way as well: entries are there after it.
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      const { shifts, observer, add } = window as unknown as { shifts: { sum: number; what: string[] }; observer: PerformanceObserver; add: (entries: PerformanceEntryList) => void };
      add(observer.takeRecords());
      observer.disconnect();
      console.log(`layout shift ${shifts.sum.toFixed(3)}: ${shifts.what.join(', ')}`);
      return shifts.sum;
    });
}

test('three steps through a clip and choosing a tool shift nothing, on a desktop and on a phone', async ({ page }) => {
  await openEmpty(page, 'groups', 'best'); // a preview, then the result
  await upload(page, [await video(page, 8, 'webm', 'vp8')]);
  await expect(page.locator('#clip-name')).toContainText('clip.webm');
  await done(page);
  for (const [from, width, height] of [[0, 1280, 860], [3, 390, 780]] as const) {
    await page.setViewportSize({ width, height });
    // With the timeline in view, and whatever is below it.
    if (width < 640) await page.locator('#clip-second').scrollIntoViewIfNeeded();
    const shift = await watchShifts(page);
    for (let k = from + 1; k <= from + 3; k++) {
      await page.getByRole('button', { name: 'Step both forward' }).click();
      await shown(page, 'first', `#${k},`);
    }
    expect(await shift(), `${width} × ${height}`).toBeLessThanOrEqual(0.01);
    await page.evaluate(() => scrollTo(0, 0));
    const places = (): Promise<number[]> =>
      page.evaluate(() => [...document.querySelectorAll('.layers, #tools label, #tools button, #run, #look, .pair')].map((part) => part.getBoundingClientRect().top + part.getBoundingClientRect().left));
    const before = await places();
    for (const tool of ['brush', 'eraser', 'look']) {
      await page.locator(`#tools [value=${tool}]`).check();
      expect(await places()).toEqual(before);
    }
  }
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('the page keeps its layout while it opens, and while the clip is segmented', async ({ page }) => {
    await withSmallSampleClip(page);
    await page.addInitScript(() => {
      const shifts: number[] = [];
      new PerformanceObserver((list) => shifts.push(...list.getEntries().map((entry) => (entry as PerformanceEntry & { value: number }).value))).observe({ type: 'layout-shift' });
      Object.assign(window, { shifts });
    });
    await openSampleClip(page);
    const shifts = await page.evaluate(() => (window as unknown as { shifts: number[] }).shifts);
    expect(shifts.reduce((sum, shift) => sum + shift, 0)).toBeLessThanOrEqual(0.05);
  });
});
