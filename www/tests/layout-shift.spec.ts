//! Nothing jumps while a film is gone through: what is listed stays where it is until it is replaced.

import { type Page } from '@playwright/test';

import { film } from './film.js';
import { done, expect, test, upload } from './support.js';

/** Counts the layout shifts from here on; also those right after a key, which browsers forgive. */
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
    await page.waitForTimeout(200); // entries are handed over after the frame
    const { sum, what } = await page.evaluate(() => (window as unknown as { shifts: { sum: number; what: string[] } }).shifts);
    console.log(`layout shift ${sum.toFixed(3)}: ${what.join(', ')}`);
    return sum;
  };
}

for (const [screen, width, height] of [['desktop', 1280, 860], ['phone', 390, 780]] as const) {
  test(`three steps of a film move nothing, ${screen}`, async ({ page }) => {
    await page.setViewportSize({ width, height });
    await page.goto('./'); // as visitors have it: a preview, then the best
    await done(page);
    await upload(page, [await film(page, 8, 'webm', 'vp8')]);
    await expect(page.locator('#film-name')).toContainText('film.webm');
    await done(page);
    // As somebody who steps has the page: the timeline in sight, and with it whatever is below.
    if (screen === 'phone') await page.locator('.film-both').scrollIntoViewIfNeeded();
    const shift = await watchShifts(page);
    for (let k = 1; k <= 3; k++) {
      await page.getByRole('button', { name: 'Step both forward' }).click();
      await expect(page.locator('[data-slot=first] .slot-name')).toContainText(`#${k},`);
      await done(page);
    }
    expect(await shift()).toBeLessThanOrEqual(0.01);
  });
}
