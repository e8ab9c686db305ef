//! The controls are in reach: with a clip on a laptop without scrolling, and on a phone while scrolling.

import { type Page } from '@playwright/test';

import { type Upload, clipFrames, done, expect, openSegmented, test, upload, withSmallSampleClip } from './support.js';

async function openSegmentedClip(page: Page, named: (k: number) => string = (k) => `f${k}.png`): Promise<Upload[]> {
  const files = (await clipFrames(4)).map((frame, k) => ({ ...frame, name: named(k) }));
  await openSegmented(page, files);
  await page.evaluate(() => scrollTo(0, 0));
  return files;
}

test('brushing, stepping and exporting a clip need no scrolling at 1280 × 720, and its whole name can be read', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  const name = 'crossing at the market, camera 3';
  const frames = await openSegmentedClip(page, (k) => `${name} ${k}.png`);
  for (const selector of ['.layers', '#tools', '#track', '#lane-names', '.transport', '#clip-segment', '#open-export', '#add-object']) {
    await expect(page.locator(selector)).toBeInViewport({ ratio: 1 });
  }
  await page.locator('#tools [value=brush]').check();
  await expect(page.locator('#track')).toBeInViewport({ ratio: 1 });

  const label = page.locator('#clip-name > span').first();
  await expect(label).toHaveText(`${name} 0 to ${name} 3`);
  await expect(page.locator('#clip-name')).toHaveAttribute('title', /camera 3 3, 4 frames, 100\s×\s70$/);
  const [told, row] = await page.evaluate(() => ['#clip-name', '#clip-run'].map((part) => document.querySelector(part)!.getBoundingClientRect().height));
  expect(told).toBeLessThanOrEqual(32);
  expect(row).toBeLessThanOrEqual(32);
  await upload(page, frames.map((frame, k) => ({ ...frame, name: `market ${k}.png` })));
  await expect(label).toHaveText('market 0 to market 3');
  expect(await label.evaluate((part) => part.scrollWidth <= part.clientWidth)).toBe(true);
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

  test('the picture stays in view, targets are large enough for fingers, and where a correction spreads is chosen under the thumb', async ({ page }) => {
    await openSegmentedClip(page);
    const narrow = await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth);
    expect(narrow).toBe(true);
    const small = await page.evaluate(() => {
      const targets = document.querySelectorAll<HTMLElement>('.masthead .button, .segmented label, .step, .lane-name, #tools .button, #clip-run .button, #objects .button, #track');
      const seen = [...targets].filter((target) => target.checkVisibility());
      const side = (target: HTMLElement): number => Math.min(target.offsetHeight, target.matches('.step') ? target.offsetWidth : Infinity);
      return seen.filter((target) => side(target) < 44).map((target) => `${target.className} ${target.textContent}`);
    });
    expect(small).toEqual([]);
    await page.locator('#objects').evaluate((list) => list.scrollIntoView({ block: 'center' }));
    await expect(page.locator('#frame')).toBeInViewport({ ratio: 1 });
    await expect(page.locator('#open-export')).toBeInViewport({ ratio: 1 });

    // While a tool that corrects is chosen.
    const spread = page.getByLabel('Frames that follow a correction');
    await expect(spread).toBeHidden();
    await page.locator('#tools [value=brush]').check({ force: true });
    const box = (await spread.boundingBox())!;
    expect(box.height).toBeGreaterThanOrEqual(44);
    expect(box.y).toBeGreaterThan(844 / 2);
    await expect(spread).toBeInViewport({ ratio: 1 });
    await spread.selectOption('none');
    await expect(spread).toHaveValue('none');
    await page.locator('#tools [value=look]').check({ force: true });
    await expect(spread).toBeHidden();
  });
});

test('a sample that is clicked is in view, on a laptop and on a phone', async ({ page }) => {
  await withSmallSampleClip(page);
  await page.goto('./#segment=asked');
  const samples = page.locator('#samples button');
  for (const [width, height] of [[1280, 720], [390, 844]] as const) {
    await page.setViewportSize({ width, height });
    for (const sample of [samples.last(), samples.first()]) {
      await sample.scrollIntoViewIfNeeded();
      await sample.click();
      await done(page);
      const [header, picture] = await page.evaluate(() => ['.masthead', '.layers'].map((part) => document.querySelector(part)!.getBoundingClientRect().toJSON() as DOMRect));
      expect(picture!.top).toBeGreaterThanOrEqual(header!.bottom);
      expect(picture!.bottom).toBeLessThanOrEqual(height);
    }
  }
});

for (const hasTouch of [false, true]) {
  test.describe(`low and wide, ${hasTouch ? 'a phone on its side' : 'a page at 200 %'}`, () => {
    test.use({ viewport: { width: 640, height: 360 }, hasTouch, isMobile: hasTouch });

    test('nothing lies over the picture, all is in reach, and what went wrong covers no button', { tag: hasTouch ? [] : '@soak' }, async ({ page }) => {
      await openSegmentedClip(page);
      for (const tool of ['look', 'brush']) {
        await page.locator(`#tools [value=${tool}]`).check({ force: true });
        const places = await page.evaluate(() => ['.masthead', '.layers', '#timeline', '#tools', '.panel'].map((part) => ({ part, ...(document.querySelector(part)!.getBoundingClientRect().toJSON() as DOMRect) })));
        const over = places.flatMap((a, k) => places.slice(k + 1).filter((b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1).map((b) => `${a.part} ${b.part}`));
        expect(over).toEqual([]);
        for (const { part, bottom, right } of places) expect([part, bottom <= 361 && right <= 641]).toEqual([part, true]);
      }
      await expect(page.locator('#track')).toBeInViewport({ ratio: 0.5 });
      await expect(page.locator('#objects')).toBeInViewport();
      for (const part of ['#accept', '.lane-name >> nth=1', '#settings', '[name=radius]', '#undo', '#objects li >> nth=1']) {
        await page.locator(part).scrollIntoViewIfNeeded();
        await expect(page.locator(part)).toBeInViewport();
      }
      expect(await page.evaluate(() => [document.documentElement.scrollWidth, scrollY])).toEqual([640, 0]);

      await upload(page, [{ name: `${'a long name '.repeat(18)}.png`, mimeType: 'image/png', buffer: Buffer.from('none') }]);
      await expect(page.locator('#notice')).toBeVisible();
      const covered = await page.evaluate(() => {
        const at = (button: HTMLElement): Element | null => {
          const { left, top, width, height } = button.getBoundingClientRect();
          return document.elementFromPoint(left + width / 2, top + height / 2);
        };
        const notice = document.querySelector<HTMLElement>('#notice')!;
        const under = [...document.querySelectorAll<HTMLElement>('button, label')].filter((button) => notice.contains(at(button)) && !notice.contains(button));
        notice.style.display = 'none';
        return under.filter((button) => button.contains(at(button))).map((button) => button.textContent);
      });
      expect(covered).toEqual([]);
    });
  });
}
