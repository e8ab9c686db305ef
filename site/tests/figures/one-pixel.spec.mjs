import { changes, drag, expect, numbers, open, test } from './figure.mjs';
import { frames } from '../site.mjs';

const GRADIENT = /by (\S+) grey levels per pixel to the right, by (\S+) per pixel down and by (\S+) from frame/;
const REST = /sheet’s motion \((\S+), (\S+)\) gives (\S+) there/
const NORMAL = /normal flow \((\S+), (\S+)\), (\S+) pixels long/;

test('the line passes through the motion, and the normal flow is its part along the gradient', async ({ page }) => {
  const { figure, reading } = await open(page, 'one-pixel');
  const motion = figure.getByRole('slider', { name: 'Motion of the sheet' });
  const gradient = figure.getByRole('slider', { name: 'Direction of the gradient' });
  const works = [
    () => motion.press('ArrowLeft'),
    () => motion.press('Shift+ArrowUp'),
    () => drag(page, motion, [-40, 60]),
    () => gradient.press('ArrowRight'),
    () => drag(page, gradient, [-60, -30]),
  ];
  for (const work of works) {
    await changes(reading, work);
    const [ix, iy, it] = await numbers(reading, GRADIENT);
    const [u, v, rest] = await numbers(reading, REST);
    const [normalU, normalV, length] = await numbers(reading, NORMAL);
    const slope = Math.hypot(ix, iy);
    expect(slope, 'the slope of the stripes: 220 grey levels in 9 pixels').toBeGreaterThan(24);
    expect(Math.abs(rest), 'grey levels').toBeLessThan(0.03 * slope);
    expect(Math.abs(ix * u + iy * v + it - rest), 'what it says of the sum').toBeLessThan(0.4);
    expect(Math.abs((ix * u + iy * v) / slope)).toBeCloseTo(length, 1);
    expect(Math.hypot(normalU, normalV)).toBeCloseTo(length, 1);
    expect(Math.abs(normalU * iy - normalV * ix) / slope, 'along the gradient').toBeLessThan(0.02);
  }
});

test('behind the window only the shift across the stripes shows; without it the whole', async ({ page }) => {
  const { figure } = await open(page, 'one-pixel');
  await figure.getByRole('radio', { name: 'along the line' }).check();
  const picture = figure.locator('.covered');
  const motion = figure.getByRole('slider', { name: 'Motion of the sheet' });
  const shot = () => picture.screenshot();
  const closed = await shot();
  await motion.press('Shift+ArrowDown');
  expect(Buffer.compare(await shot(), closed), 'behind the window nothing changes').toBe(0);
  await figure.getByRole('switch', { name: 'Take the window away' }).check();
  const whole = await shot();
  await motion.press('Shift+ArrowUp');
  expect(Buffer.compare(await shot(), whole)).not.toBe(0);
});

test('the sheet moves by itself only where motion is welcome, and stops', async ({ page }) => {
  const { figure } = await open(page, 'one-pixel');
  const picture = () => figure.locator('canvas').evaluate((canvas) => canvas.toDataURL());
  const still = await picture();
  await frames(page, 5);
  expect(await picture()).toBe(still);
  const play = figure.getByRole('button', { name: /the sheet$/ });
  await play.click();
  await expect.poll(picture).not.toBe(still);
  await expect(play).toHaveText('Stop the sheet');
  await play.click();
  await frames(page, 2);
  const stopped = await picture();
  await frames(page, 5);
  expect(await picture()).toBe(stopped);
  const other = await page.context().newPage();
  const moving = await open(other, 'one-pixel', { motion: true });
  await expect(moving.figure.getByRole('button', { name: 'Stop the sheet' })).toBeVisible();
});
