import { changes, drag, expect, numbers, open, test } from './figure.mjs';

const PIXEL = /At pixel (\d+) the first factor is (\S+) and the second is (\S+)\.$/;

/** The coefficients that the figure shows. */
async function coefficients(figure) {
  const texts = await figure.locator('.terms .value').allTextContents();
  return texts.map((text) => Number(text.replace('−', '-')));
}

/** A motion, read from its point. */
async function motion(point) {
  const [, u, v] = (await point.getAttribute('aria-valuetext')).match(/u (\S+), v (\S+)/);
  return [u, v].map((text) => Number(text.replace('−', '-')));
}

test('the conic of unlabelled pixels is the product of both motions', async ({ page }) => {
  const { figure, reading } = await open(page, 'two-motions');
  const points = [1, 2].map((body) => figure.getByRole('slider', { name: `Motion ${body}` }));
  const works = [() => points[0].press('ArrowLeft'), () => points[1].press('Shift+ArrowUp'), () => drag(page, points[0], [-70, 30])];
  for (const work of works) {
    await changes(reading, work);
    await expect(reading).toContainText('The product is 0 at every pixel');
    const [[u1, v1], [u2, v2]] = await Promise.all(points.map(motion));
    const expected = [u1 * u2, u1 * v2 + v1 * u2, u1 + u2, v1 * v2, v1 + v2, 1];
    for (const [k, value] of (await coefficients(figure)).entries()) expect(Math.abs(value - expected[k])).toBeLessThan(0.02);
  }
});

test('five pixels are enough, and at each of them one factor is zero', async ({ page }) => {
  const { figure, reading } = await open(page, 'two-motions');
  const all = await coefficients(figure);
  await changes(reading, () => figure.getByRole('slider', { name: 'Pixels', exact: true }).press('Home'));
  await expect(reading).toContainText('One conic goes through all 5 pixels');
  expect(await coefficients(figure)).toEqual(all);
  await expect(figure.locator('circle.point:visible')).toHaveCount(5);
  const look = figure.getByRole('slider', { name: 'Look at' });
  for (let pixel = 1; pixel <= 5; pixel++) {
    const [number, first, second] = await numbers(reading, PIXEL);
    expect(number).toBe(pixel);
    expect([first, second].filter((factor) => factor === 0)).toHaveLength(1);
    if (pixel < 5) await changes(reading, () => look.press('ArrowRight'));
  }
  await changes(reading, () => figure.locator('circle.point').nth(1).click());
  expect((await numbers(reading, PIXEL))[0]).toBe(2);
  await expect(look).toHaveValue('2');
});

test('colours appear on demand only', async ({ page }) => {
  const { figure } = await open(page, 'two-motions');
  const of = (tone) => figure.locator(`circle.point.${tone}`);
  await expect(of('one')).toHaveCount(0);
  const before = await coefficients(figure);
  await figure.getByRole('switch', { name: 'Colour by truth' }).check();
  await expect(of('one')).toHaveCount(20);
  await expect(of('two')).toHaveCount(20);
  expect(await coefficients(figure)).toEqual(before);
});
