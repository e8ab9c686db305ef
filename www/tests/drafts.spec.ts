//! Drafts: while the best masks of a clip are being found, its frames show those of quality *fast*.

import { type Page } from '@playwright/test';

import { axe, cancelWhen, clipDone, clipFrames, clipInNode, clipPhase, differences, drag, expect, goTo, holdBack, labelsOnCanvas, masksOf, openClip, openExport, smallFrames, test, withProcessors } from './support.js';

/** How many rows of pixels the lanes have at a frame. */
function heightOfLanes(page: Page, index: number, count: number): Promise<number> {
  return page.locator('#lanes').evaluate((lanes: HTMLCanvasElement, at) => {
    const { data } = lanes.getContext('2d')!.getImageData(Math.floor(at * lanes.width), 0, 1, lanes.height);
    return data.filter((value, k) => k % 4 === 3 && value > 0).length;
  }, (index + 0.5) / count);
}

test('frames show drafts until the masks are there: they are marked and played, and corrections and exports wait', async ({ page }) => {
  const files = await clipFrames(7);
  const [drafts, found] = [await clipInNode(files, { quality: 'fast', lookAhead: 2 }), await clipInNode(files, { quality: 'best' })];
  await openClip(page, files, { quality: 'best' });
  const release = await holdBack(page, 'f06.png');
  const [status, draft] = [page.locator('#clip-status'), page.locator('#draft')];
  await expect(draft).toBeHidden();
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(status).toHaveText('Segmenting… Drafts for now.');
  await expect(page.locator('#clip-detail')).toHaveText(/^6 of 7 frames/);
  for (const index of [3, 0]) {
    await goTo(page, index);
    await expect(page.getByRole('img', { name: `Frame ${index} Draft` })).toBeVisible();
    expect(differences(await labelsOnCanvas(page), drafts[index]!)).toBe(0);
  }
  const thin = await heightOfLanes(page, 0, 7);
  expect(await axe(page)).toEqual([]);

  await page.locator('#lane-names button').first().click();
  await page.keyboard.press('p');
  await drag(page, [0.1, 0.1], [0.3, 0.1]);
  const notice = page.locator('#notice-sentence');
  await expect(notice).toHaveText('These masks are drafts. They can be changed and exported when the clip is segmented.');
  await page.keyboard.press('v');
  await page.locator('#notice-close').click();
  await openExport(page);
  await page.getByRole('button', { name: 'Save clip' }).click();
  await expect(notice).toHaveText('These masks are drafts. They can be changed and exported when the clip is segmented.');
  await page.locator('#notice-close').click();
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await expect(page.locator('#caption')).toHaveText('Frame 4');

  await release();
  await clipDone(page);
  await expect(draft).toBeHidden();
  expect(await heightOfLanes(page, 0, 7)).toBeGreaterThan(2 * thin);
  const masks = await masksOf(page, [...found.keys()]);
  expect(masks.map((labels, index) => differences(labels, found[index]!))).toEqual(found.map(() => 0));
});

test('whoever cancels has the masks that were found, and no drafts', async ({ page }) => {
  const files = await smallFrames(8);
  await withProcessors(page, 2);
  await openClip(page, files, { quality: 'best' });
  await cancelWhen(page, /^[2-6] of 8/);
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#clip-status')).toHaveText(/^Cancelled\. [2-7] of 8 frames have masks\.$/);
  await goTo(page, 7);
  await expect(page.locator('#status')).toHaveText('This frame has no masks yet.');
  await expect(page.locator('#draft')).toBeHidden();
  await page.getByRole('button', { name: 'Continue' }).click();
  await clipDone(page);
  const found = await clipInNode(files, { quality: 'best' });
  for (const index of [0, 7]) {
    await goTo(page, index);
    expect(differences(await labelsOnCanvas(page), found[index]!)).toBe(0);
  }
});

test('a run that is stopped while masks come leaves no object of a draft selected', async ({ page }) => {
  await withProcessors(page, 2);
  await openClip(page, await clipFrames(8), { quality: 'best' });
  const release = await holdBack(page, 'f07.png');
  await page.getByRole('button', { name: 'Segment the clip' }).click();
  await expect(page.locator('#clip-status')).toHaveText('Segmenting… Drafts for now.');
  await page.locator('#lane-names button').first().click();
  await expect(page.locator('#objects > .selected')).toHaveCount(1);
  await cancelWhen(page, /^Masks of/);
  await release();
  await clipPhase(page, 'cancelled');
  await expect(page.locator('#draft')).toBeHidden();
  await expect(page.locator('#objects > .selected')).toHaveCount(0);
});
