//! The circle and the trace of the brush are under the pointer, whatever is open and however it is enlarged.

import { type Page } from '@playwright/test';

import { clipFrames, expect, openSegmented, test } from './support.js';

/** Differences that rounding to whole pixels of the screen explains. */
const NEAR = 1.5;

/** Opens and segments a clip before any pair was painted, and takes the brush. */
async function clipWithBrush(page: Page): Promise<void> {
  await openSegmented(page, await clipFrames(3, 120, 84));
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
