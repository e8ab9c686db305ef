//! The page shows exactly what the package computes.

import { decodeImage } from 'veronese/codecs';

import { PAIR, chooseMotions, differences, done, expect, labelsOfDavis, labelsOnCanvas, openEmpty, openExport, pixelsOf, sample, saved, segmentedInNode, square, test, upload } from './support.js';

test('the sample pair is segmented as in Node, as well as it can be', { tag: '@soak' }, async ({ page }) => {
  await page.goto(`${PAIR}&masks=motions`);
  await done(page);
  const expected = await segmentedInNode(await sample('first'), await sample('second'), { quality: 'best' });
  await expect(page.locator('#motions > li')).toHaveCount(expected.count);
  expect(differences(await labelsOnCanvas(page), expected.labels)).toBe(0);
});

test('frames, masks and files of two uploaded files are those of Node, and are shown as is asked, swapped and with other settings too', async ({ page }) => {
  await openEmpty(page);
  // Numbers in names are compared by value. The odd size catches a wrong row length.
  const [second, first] = [await square('frame10.png', 161, 97, 3, 1), await square('frame9.png', 161, 97, 0, 0)];
  await upload(page, [second, first]);
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('frame9.png, 161 × 97');
  await done(page);
  const expected = await segmentedInNode(first, second);
  expect(differences(await labelsOnCanvas(page), expected.labels)).toBe(0);

  const frame9 = await decodeImage(first.buffer);
  const shown = await pixelsOf(page, '#frame');
  expect([shown.width, shown.height]).toEqual([frame9.width, frame9.height]);
  expect(differences(shown.data, frame9.data)).toBe(0);

  // Visibility, solo, opacity and outlines change the picture.
  const all = await labelsOnCanvas(page);
  const rows = page.locator('#motions > li');
  const row = rows.nth(1);
  expect(new Set(all)).toContain(1);

  await row.getByRole('checkbox').uncheck();
  expect(differences(await labelsOnCanvas(page), all.map((label) => (label === 1 ? 0 : label)))).toBe(0);

  await row.getByRole('button', { name: 'Show only' }).click();
  expect(differences(await labelsOnCanvas(page), all.map((label) => (label === 1 ? 1 : 0)))).toBe(0);
  await row.getByRole('button', { name: 'Show only' }).click();
  await row.getByRole('checkbox').check();
  expect(differences(await labelsOnCanvas(page), all)).toBe(0);
  // The background is not painted, so it cannot be hidden.
  await expect(rows.first().getByRole('checkbox')).toBeHidden();

  const slider = page.getByRole('slider', { name: /Opacity/ });
  await slider.fill('100');
  await expect(page.locator('#fill')).toHaveCSS('opacity', '1');
  await slider.fill('0');
  await expect(page.locator('#fill')).toHaveCSS('opacity', '0');
  await page.getByLabel('Outlines').uncheck();
  await expect(page.locator('#outlines')).toBeHidden();

  // The labels PNG holds the labels.
  await openExport(page);
  const { name, bytes } = await saved(page, page.getByRole('button', { name: 'Labels PNG' }));
  expect(name).toBe('labels.png');
  expect([...bytes.subarray(24, 26)]).toEqual([8, 3]); // 8 bits, indexed
  expect(differences(await labelsOfDavis(bytes), expected.labels)).toBe(0);
  await page.keyboard.press('Escape');

  // The second frame is shown by a switch and while a key is held.
  const frame10 = await decodeImage(second.buffer);
  const shows = async (frame: typeof frame9): Promise<number> => differences((await pixelsOf(page, '#frame')).data, frame.data);

  await page.keyboard.down('f');
  expect(await shows(frame10)).toBe(0);
  await page.keyboard.up('f');
  expect(await shows(frame9)).toBe(0);
  await page.locator('#look [value=second]').check();
  expect(await shows(frame10)).toBe(0);

  // Stabilising alternates between the first frame and the second warped back.
  await page.getByRole('button', { name: 'Stabilise on Background' }).click();
  await expect(page.locator('#caption')).toHaveText(/frame, stabilised on Background$/);
  await expect(page.getByRole('button', { name: 'Blink' })).toHaveAttribute('aria-pressed', 'true');

  // Swapping the frames segments them in the other order.
  await page.locator('#swap').click();
  await expect(page.locator('[data-slot=first] .slot-name')).toHaveText('frame10.png, 161 × 97');
  await done(page);
  expect(differences(await labelsOnCanvas(page), (await segmentedInNode(second, first)).labels)).toBe(0);

  // Settings reach the package, and the latest request wins.
  await chooseMotions(page, 2);
  await page.getByLabel('Best').check();
  await done(page);
  await openExport(page);
  const report: unknown = JSON.parse((await saved(page, page.getByRole('button', { name: 'Result JSON' }))).bytes.toString());
  expect(report).toMatchObject({ version: 1, width: 161, height: 97, settings: { motions: 2, quality: 'best', subject: false, markUnknown: false } });
  expect(report).not.toHaveProperty('labels');
  const two = await segmentedInNode(second, first, { motions: 2, quality: 'best' });
  expect(differences(await labelsOnCanvas(page), two.labels)).toBe(0);
});
