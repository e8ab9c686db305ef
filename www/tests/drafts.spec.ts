//! Drafts: while the best masks of a clip are being found, its frames show those of quality *fast*.

import { type Page } from '@playwright/test';

import { axe, cancelWhen, clipDone, clipFrames, clipPhase, drag, expect, goTo, holdBack, labelsOnCanvas, openClip, openExport, test, withProcessors } from './support.js';

/** How many rows of pixels the lanes have at a frame. */
function heightOfLanes(page: Page, index: number, count: number): Promise<number> {
  return page.locator('#lanes').evaluate((lanes: HTMLCanvasElement, at) => {
    const { data } = lanes.getContext('2d')!.getImageData(Math.floor(at * lanes.width), 0, 1, lanes.height);
    return data.filter((value, k) => k % 4 === 3 && value > 0).length;
  }, (index + 0.5) / count);
}

test('frames show drafts until the masks are there: they are marked and played, and corrections and exports wait', async ({ page }) => {
  await openClip(page, await clipFrames(6), { quality: 'best' });
  const release = await holdBack(page, 'f05.png');
  const [status, draft] = [page.locator('#clip-status'), page.locator('#draft')];
  await expect(draft).toBeHidden();
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(status).toHaveText('Segmenting… Drafts for now.');
  await expect(page.locator('#clip-detail')).toHaveText(/^5 of 6 frames/);
  for (const index of [2, 0]) {
    await goTo(page, index);
    await expect(page.getByRole('img', { name: `Frame ${index} Draft` })).toBeVisible();
    expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
  }
  const thin = await heightOfLanes(page, 0, 6);
  expect(await axe(page)).toEqual([]);

  await page.locator('#lane-names button').first().click();
  await expect(page.locator('#objects > li')).toHaveCount(3);
  await expect(page.locator('#objects > .selected')).toHaveCount(1);
  await page.keyboard.press('p');
  await drag(page, [0.1, 0.1], [0.3, 0.1]);
  const notice = page.locator('#notice-sentence');
  const sentence = 'These masks are drafts. They can be changed and exported when the clip is segmented.';
  await expect(notice).toHaveText(sentence);
  await page.keyboard.press('v');
  await page.locator('#notice-close').click();
  await openExport(page);
  await page.getByRole('button', { name: 'Save clip' }).click();
  await expect(notice).toHaveText(sentence);
  await page.locator('#notice-close').click();
  // Escape would cancel the run as well.
  await page.locator('#export').evaluate((panel: HTMLElement) => panel.hidePopover());
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 3');

  await release();
  await clipDone(page);
  await expect(draft).toBeHidden();
  expect(await heightOfLanes(page, 0, 6)).toBeGreaterThan(2 * thin);
  await expect(page.getByRole('button', { name: 'Play', exact: true })).toBeVisible(); // it went on to the end
  for (const index of [0, 5]) {
    await goTo(page, index);
    expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
  }
});

test('whoever cancels has the masks that were found, and no drafts', async ({ page }) => {
  await withProcessors(page, 2);
  await openClip(page, await clipFrames(6), { quality: 'best' });
  const release = await holdBack(page, 'f03.png');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-detail')).toHaveText(/^[23] of 6/);
  await page.locator('#clip-cancel').click();
  await release();
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText(/^Cancelled\. [2-5] of 6 frames have masks\.$/);
  await goTo(page, 5);
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
  await expect(page.locator('#draft')).toBeHidden();
  await page.getByRole('button', { name: 'Continue' }).click();
  await clipDone(page);
  await goTo(page, 5);
  expect(new Set(await labelsOnCanvas(page)).size).toBeGreaterThan(1);
});

test('when masks come no object of a draft stays selected, also if the run is stopped then', { tag: '@soak' }, async ({ page }) => {
  await withProcessors(page, 2);
  await openClip(page, await clipFrames(8), { quality: 'best' });
  const release = await holdBack(page, 'f07.png');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-status')).toHaveText('Segmenting… Drafts for now.');
  await page.locator('#lane-names button').first().click();
  await expect(page.locator('#objects > .selected')).toHaveCount(1);
  await cancelWhen(page, /^Masks of/);
  await release();
  // All pairs are solved: it has all masks.
  await clipDone(page);
  await expect(page.locator('#draft')).toBeHidden();
  await expect(page.locator('#objects > .selected')).toHaveCount(0);
});
