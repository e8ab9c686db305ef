//! Stepping through a clip does not shift the layout.

import { type Page } from '@playwright/test';

import { video } from './video.js';
import { done, expect, openEmpty, test, upload } from './support.js';

/** Sums layout shifts from now on, including those after user input, which browsers exclude from their score. */
async function watchShifts(page: Page): Promise<() => Promise<number>> {
  await page.evaluate(() => {
    const shifts = { sum: 0, what: [] as string[] };
    Object.assign(window, { shifts });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as (PerformanceEntry & { value: number; sources: { node: Node | null }[] })[]) {
        shifts.sum += entry.value;
        for (const { node } of entry.sources) shifts.what.push(node instanceof Element ? `${node.localName}#${node.id}.${node.className}` : String(node?.nodeName));
      }
    }).observe({ type: 'layout-shift' });
  });
  return async () => {
    await page.waitForTimeout(200); // entries are delivered after the frame
    const { sum, what } = await page.evaluate(() => (window as unknown as { shifts: { sum: number; what: string[] } }).shifts);
    console.log(`layout shift ${sum.toFixed(3)}: ${what.join(', ')}`);
    return sum;
  };
}

for (const [screen, width, height] of [['desktop', 1280, 860], ['phone', 390, 780]] as const) {
  test(`three steps through a clip and choosing a tool shift nothing, ${screen}`, async ({ page }) => {
    await page.setViewportSize({ width, height });
    await openEmpty(page, 'groups', 'best'); // a preview, then the result
    await upload(page, [await video(page, 8, 'webm', 'vp8')]);
    await expect(page.locator('#clip-name')).toContainText('clip.webm');
    await done(page);
    // With the timeline in view, and whatever is below it.
    if (screen === 'phone') await page.locator('#clip-second').scrollIntoViewIfNeeded();
    const shift = await watchShifts(page);
    for (let k = 1; k <= 3; k++) {
      await page.getByRole('button', { name: 'Step both forward' }).click();
      await expect(page.locator('[data-slot=first] .slot-name')).toContainText(`#${k},`);
      await done(page);
    }
    expect(await shift()).toBeLessThanOrEqual(0.01);
    await page.evaluate(() => scrollTo(0, 0));
    const places = (): Promise<number[]> =>
      page.evaluate(() => [...document.querySelectorAll('.layers, #tools label, #tools button, #run, #look, .pair')].map((part) => part.getBoundingClientRect().top + part.getBoundingClientRect().left));
    const before = await places();
    for (const tool of ['brush', 'eraser', 'look']) {
      await page.locator(`#tools [value=${tool}]`).check();
      expect(await places()).toEqual(before);
    }
  });
}
