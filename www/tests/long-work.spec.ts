//! Long work says how far it is, also in a tab that nobody looks at.

import { cancelWhen, clipDone, clipPhase, expect, hide, openClip, smallFrames, test } from './support.js';

test('the title of the tab says how far a clip is and, in the background, that it is done', async ({ page }) => {
  const own = 'Veronese: masks of what moves';
  await openClip(page, await smallFrames(8));
  await expect(page).toHaveTitle(own);
  const titles = await page.evaluateHandle(() => {
    const titles: string[] = [];
    new MutationObserver(() => titles.push(document.title)).observe(document.querySelector('title')!, { childList: true });
    return titles;
  });
  await hide(page);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipDone(page);
  await expect(page).toHaveTitle(`✓ f00-f07.png · ${own}`);
  expect((await titles.jsonValue()).filter((title) => /^\d+\u00a0% f00-f07\.png · /.test(title)).length).toBeGreaterThan(1);
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'visible', configurable: true });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await expect(page).toHaveTitle(own);

  await cancelWhen(page);
  await page.getByRole('button', { name: 'Segment the clip again' }).click();
  await clipPhase(page, 'cancelled');
  await expect(page).toHaveTitle(own);
});
