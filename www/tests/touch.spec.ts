//! Touch input, dispatched by the browser: which gestures the picture handles and which are left to the page.

import { type Page } from '@playwright/test';

import { clipDone, clipFrames, expect, openSegmented, test } from './support.js';

test.use({ viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true });

type Point = readonly [number, number];

type Path = readonly [Point, Point];

/** Puts fingers down and moves them in steps along their paths. Returns a function that dispatches the next event. */
async function press(page: Page, ...paths: Path[]): Promise<(type: 'touchStart' | 'touchEnd' | 'touchCancel', ...more: Point[]) => Promise<void>> {
  const cdp = await page.context().newCDPSession(page);
  const steps = 12;
  const at = (k: number): { x: number; y: number; id: number }[] =>
    paths.map(([[x, y], [u, v]], id) => ({ x: x + ((u - x) * k) / steps, y: y + ((v - y) * k) / steps, id }));
  await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
  for (let k = 1; k <= steps; k++) await cdp.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(k) });
  return async (type, ...more) => {
    const touchPoints = type === 'touchStart' ? [...at(steps), ...more.map(([x, y], k) => ({ x, y, id: paths.length + k }))] : [];
    await cdp.send('Input.dispatchTouchEvent', { type, touchPoints });
  };
}

/** Puts fingers down, moves and lifts them, and waits until the page scrolls no more: a finger that is lifted may leave it scrolling. */
async function fingers(page: Page, ...paths: Path[]): Promise<void> {
  const scrolling = await page.evaluateHandle(() => {
    const scrolling = { now: false };
    document.addEventListener('scroll', () => (scrolling.now = true), { once: true });
    document.addEventListener('scrollend', () => (scrolling.now = false), { once: true });
    return scrolling;
  });
  const then = await press(page, ...paths);
  await then('touchEnd');
  // Events of scrolling come with the next frame.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  await expect.poll(() => scrolling.evaluate(({ now }) => now)).toBe(false);
}

interface Seen {
  /** Zoom of the page. */
  page: number;
  scrolled: number;
  /** Zoom of the picture, and its position in the view, screen pixels. */
  zoom: number;
  left: number;
  top: number;
}

async function seen(page: Page): Promise<Seen> {
  return page.evaluate(() => {
    const [whole, picture] = ['.layers', '#frame'].map((selector) => document.querySelector(selector)!.getBoundingClientRect()) as [DOMRect, DOMRect];
    return {
      page: visualViewport!.scale,
      scrolled: window.scrollY,
      zoom: picture.width / whole.width,
      left: picture.left - whole.left,
      top: picture.top - whole.top,
    };
  });
}

/** Converts points of the picture, 0…1, to the screen. */
async function placeOf(page: Page): Promise<(u: number, v: number) => Point> {
  const box = (await page.locator('.layers').boundingBox())!;
  return (u, v) => [box.x + u * box.width, box.y + v * box.height];
}

/** Shows the whole picture again, at the top of the page. */
async function whole(page: Page): Promise<void> {
  await page.locator('#zoom-fit').tap();
  await page.evaluate(() => window.scrollTo(0, 0));
}

test('fingers zoom, pan, scroll and draw, and strokes stay whoever ends them', async ({ page }) => {
  await openSegmented(page, await clipFrames(2, 192, 108));
  const at = await placeOf(page);
  await fingers(page, [at(0.45, 0.5), at(0.2, 0.5)], [at(0.55, 0.5), at(0.8, 0.5)]);
  const large = await seen(page);
  expect(large.page).toBe(1);
  expect(large.zoom).toBeGreaterThan(3);

  const [x, y] = at(0.4, 0.4);
  await fingers(page, [[x, y], [x + 24, y + 16]], [[x + 80, y], [x + 104, y + 16]]);
  const moved = await seen(page);
  expect(moved.page).toBe(1);
  expect(moved.scrolled).toBe(0);
  expect(moved.zoom).toBeCloseTo(large.zoom, 1);
  expect(moved.left - large.left).toBeCloseTo(24, -1);
  expect(moved.top - large.top).toBeCloseTo(16, -1);

  await test.step('one finger scrolls the page, and pans the picture once it is enlarged', async () => {
    await whole(page);
    const at = await placeOf(page);
    const [x, y] = at(0.5, 0.8);
    await fingers(page, [[x, y], [x, y - 120]]);
    const scrolled = await seen(page);
    expect(scrolled.scrolled).toBeGreaterThan(60);
    expect(scrolled.zoom).toBe(1);

    await page.evaluate(() => window.scrollTo(0, 0));
    for (let k = 0; k < 3; k++) await page.locator('#zoom-in').tap();
    const large = await seen(page);
    await fingers(page, [at(0.5, 0.5), at(0.4, 0.4)]);
    const moved = await seen(page);
    expect(moved.scrolled).toBe(0);
    expect(moved.left).toBeLessThan(large.left - 20);
    expect(moved.top).toBeLessThan(large.top - 10);
  });

  await test.step('with the brush one finger draws and two zoom', async () => {
    await whole(page);
    await page.getByLabel('Brush', { exact: true }).check({ force: true });
    const at = await placeOf(page);
    await fingers(page, [at(0.45, 0.5), at(0.2, 0.5)], [at(0.55, 0.5), at(0.8, 0.5)]);
    const large = await seen(page);
    expect(large.page).toBe(1);
    expect(large.zoom).toBeGreaterThan(3);
    await expect(page.locator('#undo')).toBeDisabled(); // no stroke was drawn

    await fingers(page, [at(0.4, 0.4), at(0.6, 0.6)]);
    await expect(page.locator('#undo')).toBeEnabled();
    await clipDone(page);
    const after = await seen(page);
    expect([after.zoom, after.left, after.scrolled]).toEqual([large.zoom, large.left, 0]);
  });

  await test.step('a stroke stays when a second finger or the browser ends it', async () => {
    const undone = async (): Promise<void> => {
      await clipDone(page);
      await page.locator('#undo').tap();
      await expect(page.locator('#undo')).toBeDisabled();
    };
    await undone();
    await whole(page);
    const at = await placeOf(page);
    const second = await press(page, [at(0.4, 0.4), at(0.6, 0.6)]);
    await second('touchStart', at(0.8, 0.4));
    await second('touchEnd');
    await expect(page.locator('#undo')).toBeEnabled();
    await undone();

    const cancelled = await press(page, [at(0.4, 0.6), at(0.6, 0.4)]);
    await cancelled('touchCancel');
    await expect(page.locator('#undo')).toBeEnabled();
    await undone();

    // A finger that has not moved has drawn nothing.
    const still = await press(page, [at(0.5, 0.5), at(0.5, 0.5)]);
    await still('touchCancel');
    await expect(page.locator('#strokes .now')).toHaveAttribute('d', '');
    await expect(page.locator('#undo')).toBeDisabled();
  });

  await test.step('two fingers beside the picture do not zoom the page', async () => {
    await page.locator('#tools [value=look]').check({ force: true });
    await page.setViewportSize({ width: 780, height: 300 }); // landscape: the picture does not fill the width of its stage
    const stage = (await page.locator('#stage').boundingBox())!;
    const layers = (await page.locator('.layers').boundingBox())!;
    expect(layers.x - stage.x).toBeGreaterThan(60);
    const [x, y] = [(stage.x + layers.x) / 2, stage.y + stage.height / 2];
    await fingers(page, [[x, y - 10], [x, y - 60]], [[x, y + 10], [x, y + 60]]);
    expect((await seen(page)).page).toBe(1);
  });
});

test('a finger finds both handles of the timeline, and drags these; it selects several objects', async ({ page }) => {
  await openSegmented(page, await clipFrames(6));
  await page.locator('#track').evaluate((track) => track.scrollIntoView({ block: 'center' }));
  const [from, to] = [page.getByRole('slider', { name: 'In point' }), page.getByRole('slider', { name: 'Out point' })];
  const track = (await page.locator('#track').boundingBox())!;
  const drag = async (handle: typeof from, index: number): Promise<void> => {
    // It follows the finger, wherever it was taken.
    const { x, y, width, height } = (await handle.boundingBox())!;
    const by = ((index - Number(await handle.getAttribute('aria-valuenow'))) * track.width) / 6;
    await fingers(page, [[x + width / 2, y + height / 2], [x + width / 2 + by, y + height / 2]]);
    await expect(handle).toHaveAttribute('aria-valuenow', String(index));
  };
  // With the handles far apart, and with a single frame between them.
  for (const [first, last] of [[0, 5], [2, 2]] as const) {
    if (last < 5) await drag(to, last);
    if (first > 0) await drag(from, first);
    for (const handle of [from, to]) {
      const { x, y, width, height } = (await handle.boundingBox())!;
      expect(Math.min(width, height)).toBeGreaterThanOrEqual(44);
      const hit = await handle.evaluate(
        (handle, points) => points.map(([x, y]) => document.elementFromPoint(x!, y!) === handle),
        [[x + 2, y + 2], [x + width - 2, y + height - 2], [x + width / 2, y + height / 2]],
      );
      expect(hit).toEqual([true, true, true]);
    }
  }

  const bar = page.getByRole('group', { name: 'Selected objects' });
  const select = page.getByRole('button', { name: 'Select', exact: true });
  await select.tap();
  await expect(bar).toBeVisible();
  for (const id of [1, 2]) await page.getByRole('checkbox', { name: `Select Object ${id}` }).tap();
  await expect(bar.getByRole('status')).toHaveText('2 selected');
  for (const control of await bar.locator('button, input').all()) expect((await control.boundingBox())!.height).toBeGreaterThanOrEqual(44);
  await bar.getByRole('button', { name: 'Delete' }).tap();
  await expect(page.locator('#objects > li')).toHaveCount(1);
  await expect(bar).toBeHidden();
  await expect(select).toHaveAttribute('aria-pressed', 'false');
});
