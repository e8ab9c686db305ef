//! The circle and the trace of the brush are under the pointer, whatever is open and however it is enlarged; and it need not be waited for.

import { type Page } from '@playwright/test';

import { clipFrames, differences, expect, labelsOnCanvas, openSegmented, said, test, unwatched } from './support.js';

const WIDTH = 100;

/** Differences that rounding to whole pixels of the screen explains. */
const NEAR = 1.5;

/** Opens a clip with its masks, and takes the brush. */
async function clipWithBrush(page: Page): Promise<void> {
  await openSegmented(page, await clipFrames(4));
  await page.locator('#tools [value=brush]').locator('..').click();
  await expect(page.locator('#tools [value=brush]')).toBeChecked();
  await page.locator('.layers').scrollIntoViewIfNeeded();
}

/** The middle of what is drawn, on the screen. */
async function middleOf(page: Page, selector: string): Promise<{ x: number; y: number }> {
  return page.locator(selector).evaluate((shape) => {
    const { x, y, width, height } = (shape as SVGGraphicsElement).getBBox(); // without the thickness of its line
    const middle = new DOMPoint(x + width / 2, y + height / 2).matrixTransform((shape as SVGGraphicsElement).getScreenCTM()!);
    return { x: middle.x, y: middle.y };
  });
}

async function isAt(page: Page, selector: string, x: number, y: number): Promise<void> {
  await expect(async () => {
    const middle = await middleOf(page, selector);
    expect(Math.hypot(middle.x - x, middle.y - y), `${selector} at ${middle.x}, ${middle.y}, not ${x}, ${y}`).toBeLessThan(NEAR);
  }).toPass();
}

/** Moves the pointer to places of the view, 0 to 1, and paints from one to the other. */
async function paintsUnderPointer(page: Page): Promise<void> {
  const box = (await page.locator('.layers').boundingBox())!;
  const [from, to] = [[0.7, 0.3], [0.3, 0.6]].map(([u, v]) => [box.x + u! * box.width, box.y + v! * box.height] as const) as [readonly [number, number], readonly [number, number]];
  for (const [x, y] of [from, to]) {
    await page.mouse.move(x, y);
    await isAt(page, '#strokes .brush', x, y);
  }
  // As wide as what it paints.
  const [drawn, meant] = await page.evaluate(() => {
    const circle = document.querySelector<SVGCircleElement>('#strokes .brush')!;
    const radius = document.querySelector<HTMLInputElement>('[name=radius]')!.valueAsNumber;
    const frame = document.querySelector<HTMLCanvasElement>('#frame')!;
    return [circle.r.baseVal.value * circle.getScreenCTM()!.a, (radius * frame.getBoundingClientRect().width) / frame.width];
  });
  expect(drawn / meant).toBeCloseTo(1, 2);
  await page.mouse.down();
  await page.mouse.move(...from, { steps: 4 });
  await isAt(page, '#strokes .stroke.now', (from[0] + to[0]) / 2, (from[1] + to[1]) / 2);
  await isAt(page, '#strokes .brush', ...from);
  await page.keyboard.press('Escape');
  await page.mouse.up();
}

test('in a clip the circle and the trace are under the pointer, enlarged too', async ({ page }) => {
  await clipWithBrush(page);
  await paintsUnderPointer(page);
  for (let k = 0; k < 5; k++) await page.locator('#zoom-in').click();
  await paintsUnderPointer(page);
});

test('keys wait for what draws as pointers do, and are not about the clip meanwhile', async ({ page }) => {
  let come = (): void => undefined;
  const coming = new Promise<void>((resolve) => (come = resolve));
  await page.route('**/assets/brush-*.js', (route) => coming.then(() => route.continue()));
  await openSegmented(page, await clipFrames(4));
  const rows = page.locator('#objects > li');
  const found = await labelsOnCanvas(page);
  await page.keyboard.press('1');
  await page.keyboard.press('b');
  await page.locator('.layers').focus();
  // One that is given up, and another.
  for (const key of ['ArrowUp', 'Space', 'ArrowRight', 'Escape', 'ArrowDown', 'Space', 'ArrowRight', 'Backspace', 'ArrowRight', 'Space']) await page.keyboard.press(key);
  await expect(page.locator('#caption')).toHaveText('Frame 0');
  await expect(page.locator('#play')).toHaveAccessibleName('Play');
  await expect(rows).toHaveCount(3);
  expect(differences(await labelsOnCanvas(page), found)).toBe(0);
  come();
  await said(page, /^Corrected/);
  // From the centre in steps of the radius.
  const drawn = await labelsOnCanvas(page);
  const at = (x: number, y: number): number => drawn[y * WIDTH + x]!;
  expect([58, 66, 74].map((x) => at(x, 35))).toEqual([1, 1, 1]);
  expect([50, 54].map((x) => at(x, 23))).toEqual([0, 0]);
  await expect(page.locator('#caption')).toHaveText('Frame 0');
  await expect(page.locator('#undo')).toBeEnabled();
  await page.locator('#undo').click();
  await expect(page.locator('#undo')).toBeDisabled();
  // Nor are they once it is there.
  await page.locator('.layers').focus();
  for (const key of ['Space', 'ArrowRight', 'Backspace']) await page.keyboard.press(key);
  await expect(page.locator('#strokes .stroke.now')).not.toHaveAttribute('d', '');
  await page.keyboard.press('Escape');
  await expect(rows).toHaveCount(3);
  await expect(page.locator('#undo')).toBeDisabled();
});

unwatched('without what draws there is a notice, and keys are about the clip; it is loaded once it is there', async ({ page }) => {
  await page.route('**/assets/brush-*.js', (route) => route.abort());
  await openSegmented(page, await clipFrames(4));
  const tool = page.locator('#tools [name=tool]:checked');
  await page.keyboard.press('b');
  await expect(page.locator('#notice-code')).toHaveText('not-loaded');
  await expect(tool).toHaveValue('look');
  await page.locator('.layers').focus();
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('#caption')).toHaveText('Frame 1');
  await page.unrouteAll();
  await page.keyboard.press('b');
  await expect(tool).toHaveValue('brush');
  await expect(page.locator('#strokes .brush')).toBeAttached();
});

test.describe('on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 3 });

  test('in a clip the trace is under the finger, which need not wait for what draws it', async ({ page }) => {
    let touches = (): void => undefined;
    const touched = new Promise<void>((resolve) => (touches = resolve));
    await page.route('**/assets/brush-*.js', (route) => touched.then(() => route.continue()));
    await clipWithBrush(page);
    const cdp = await page.context().newCDPSession(page);
    for (let enlarged = 0; enlarged < 2; enlarged++) {
      const box = (await page.locator('.layers').boundingBox())!;
      const at = (u: number, v: number): { x: number; y: number }[] => [{ x: box.x + u * box.width, y: box.y + v * box.height }];
      await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0.6, 0.4) });
      for (let k = 1; k <= 4; k++) await cdp.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(0.6 - 0.05 * k, 0.4 + 0.05 * k) });
      touches();
      const [{ x, y }] = at(0.5, 0.5) as [{ x: number; y: number }];
      await isAt(page, '#strokes .stroke.now', x, y);
      await cdp.send('Input.dispatchTouchEvent', { type: 'touchCancel', touchPoints: [] });
      for (let k = 0; k < 4; k++) await page.locator('#zoom-in').tap();
    }
  });
});
