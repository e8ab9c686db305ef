//! Zoom, split view, blinking, arrows, residual, motions, evidence.

import { type Page } from '@playwright/test';

import { MOTIONS_IN_SAMPLE, chooseMotions, done, drag, expect, labelsOnCanvas, motionsChosen, open, pixelsOf, test } from './support.js';

async function zoomShown(page: Page): Promise<number> {
  return Number((await page.locator('#zoom-value').textContent())!.replace(/[^\d.]/g, ''));
}

test('the picture is zoomed and panned, split, drawn over and blinked', async ({ page }) => {
  await open(page);
  const box = (await page.locator('.layers').boundingBox())!;
  const whole = await zoomShown(page);
  const place = async (): Promise<{ x: number; y: number; width: number }> => (await page.locator('#frame').boundingBox())!;

  // The point under the pointer stays there.
  const [x, y] = [box.x + 0.25 * box.width, box.y + 0.6 * box.height];
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -300);
  await expect.poll(() => zoomShown(page)).toBeGreaterThan(whole);
  const large = await place();
  expect((x - large.x) / large.width).toBeCloseTo(0.25, 2);

  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 4 });
  await page.mouse.up();
  expect((await place()).x).toBeCloseTo(large.x + 60, 0);

  await page.locator('#zoom-fit').click();
  expect(await zoomShown(page)).toBe(whole);
  await page.locator('#zoom-in').click();
  expect(Math.abs((await zoomShown(page)) - 1.5 * whole)).toBeLessThanOrEqual(1);
  await page.keyboard.press('0');
  expect(await zoomShown(page)).toBe(whole);
  for (let k = 0; k < 8; k++) await page.keyboard.press('+');
  await expect(page.locator('#grid')).toBeVisible();
  await expect(page.locator('#stage')).toHaveClass(/squares/);
  await page.locator('.layers').focus(); // elsewhere arrows step
  const before = await place();
  await page.keyboard.press('ArrowRight');
  expect((await place()).x).toBeLessThan(before.x);
  await page.keyboard.press('-');
  expect((await place()).width).toBeLessThan(before.width);

  await page.keyboard.press('0');

  // The split view shows both frames, and its line moves.
  await page.locator('#look [value=split]').check();
  await expect(page.locator('#other')).toBeVisible();
  const line = page.getByRole('slider', { name: 'Position of the split' });
  await line.fill('250');
  await expect(page.locator('#other')).toHaveCSS('clip-path', /25%/);
  await line.focus();
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#other')).toHaveCSS('clip-path', /25\.1%/);
  await page.keyboard.press('s');
  await expect(page.locator('#other')).toBeHidden();

  // Arrows and the residual are drawn.
  await page.getByLabel('Arrows').check();
  await expect(page.locator('#arrows path.arrow')).not.toHaveCount(0);
  expect(await page.locator('#arrows path.arrow').nth(1).getAttribute('d')).toMatch(/^M[\d.]+ [\d.]+L/);
  await expect(page.locator('#magnified')).toHaveText(/^arrows ×\d/);
  await page.getByLabel('Residual').check();
  // The motions explain most pixels, which are painted dark.
  const dark = async (): Promise<number> => {
    const { data, width, height } = await pixelsOf(page, '#residual');
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i]! < 128 && data[i + 3] === 255) count += 1;
    return count / (width * height);
  };
  await expect.poll(dark).toBeGreaterThan(0.8);

  // The zoom button shows the picture at 100 %.
  await page.setViewportSize({ width: 600, height: 800 });
  await expect.poll(() => zoomShown(page)).toBeLessThan(100);
  await page.locator('#zoom-value').click();
  expect(await zoomShown(page)).toBe(100);
  expect((await page.locator('#frame').boundingBox())!.width).toBeCloseTo(768, 0);

  // Blinking alternates between the frames, but not with reduced motion.
  const caption = page.locator('#caption');
  const captions = await caption.evaluateHandle((caption) => {
    const captions: string[] = [];
    new MutationObserver(() => captions.push(caption.textContent)).observe(caption, { childList: true, characterData: true, subtree: true });
    return captions;
  });
  await page.getByRole('button', { name: 'Blink' }).click();
  await expect.poll(() => captions.evaluate(({ length }) => length)).toBeGreaterThan(2);
  await page.getByRole('button', { name: 'Blink' }).click();
  expect((await captions.jsonValue()).slice(0, 3)).toEqual(['Second frame', 'First frame', 'Second frame']);
  await expect(caption).toHaveText('First frame');

  // With reduced motion each press shows the other frame, and none begins to blink.
  await page.emulateMedia({ reducedMotion: 'reduce' });
  for (const frame of ['Second', 'First', 'Second']) {
    await page.keyboard.press('Shift+F');
    await expect(caption).toHaveText(`${frame} frame`);
    await expect(page.getByRole('button', { name: 'Blink' })).toHaveAttribute('aria-pressed', 'false');
  }
});

test('masks are groups by default, and single motions on request, and can be copied and selected', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  await open(page, 'groups');
  const rows = page.locator('#motions > li');
  const groups = await labelsOnCanvas(page);
  await expect(rows).toHaveCount(new Set(groups).size);
  await page.keyboard.press('g');
  const motions = await labelsOnCanvas(page);
  await expect(rows).toHaveCount(new Set(motions).size);
  expect(new Set(motions).size).toBeGreaterThanOrEqual(MOTIONS_IN_SAMPLE);
  // A motion is in one group.
  expect(new Set(Array.from(motions, (motion, p) => `${motion} in ${groups[p]}`)).size).toBe(new Set(motions).size);

  // A motion is copied in three notations.
  const row = rows.nth(1);
  await row.getByText('More', { exact: true }).click();
  await row.getByRole('button', { name: 'JSON' }).click();
  await expect(page.locator('#notice')).toContainText('clipboard');
  expect(JSON.parse(await page.evaluate(() => navigator.clipboard.readText()))).toHaveLength(6);
  await row.getByRole('button', { name: 'SVG / CSS' }).click();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^matrix\((-?[\d.e-]+, ){5}-?[\d.e-]+\)$/);
  await row.getByRole('button', { name: 'OpenCV' }).click();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^\[\[/);
  await page.keyboard.press('g');
  await expect(rows).toHaveCount(new Set(groups).size);

  // A click on the picture selects the mask there.
  const { width, height } = await pixelsOf(page, '#fill');
  const clicked = page.locator(`#motions > li[data-mask="${groups[Math.floor(0.4 * height) * width + Math.floor(0.2 * width)]}"]`);
  await rows.first().locator('.motion-words').click();
  await expect(clicked).not.toHaveClass(/selected/);
  await drag(page, [0.2, 0.4], [0.2, 0.4]);
  await expect(clicked).toHaveClass(/selected/);
});

test('the number of motions can be forced in the evidence plot, which does not claim to decide', async ({ page }) => {
  await open(page);
  const rows = page.locator('#motions > li');
  const scores = page.locator('#evidence .score');
  const candidates = await scores.count();
  expect(candidates).toBeGreaterThan(2);
  await chooseMotions(page, 2);
  await done(page);
  await motionsChosen(page, 2);
  await expect(rows).toHaveCount(2);
  await expect(scores).toHaveCount(candidates); // the automatic scores stay
  await page.getByRole('button', { name: 'Automatic' }).click();
  await done(page);
  await motionsChosen(page, 'Automatic');
  expect(page.workers()).toHaveLength(2); // of the pair, however many requests there were, and of the clip

  // Nor when the number found has not the shortest description.
  for (const swapped of [false, true]) {
    if (swapped) await page.locator('#swap').click();
    await done(page);
    const count = await rows.count();
    await expect(page.locator('#evidence .number.found')).toHaveText(String(count));
    const shortest = Number(await page.getByRole('button', { name: /^Use \d motions for this pair: shortest description$/ }).textContent());
    const sentence = page.locator('#evidence-choice');
    if (shortest === count) await expect(sentence).toBeHidden();
    else await expect(sentence).toHaveText(`Automatic took ${count}, though ${shortest} has the shortest description: these lengths are a check made afterwards, and do not decide.`);
  }
});
