import { changes, expect, numbers, open, test } from './figure.mjs';

const ERRORS = /By roots, .*?: error (\S+) %\..* error (\S+) %; at the best of 60 pixels: (\S+) %\.$/;

test('roots lose track where third columns are equal; derivatives do not', async ({ page }) => {
  const { figure, reading } = await open(page, 'apart-again');
  const apart = figure.getByRole('slider', { name: 'Distance' });
  await expect(reading).toContainText('each row is given to its motion');
  for (const error of await numbers(reading, ERRORS)) expect(error).toBeLessThan(1);

  await changes(reading, () => apart.press('Home'));
  await expect(reading).toContainText('Third columns at distance 0,');
  await expect(reading).toContainText('The third columns cannot tell which row belongs to which motion.');
  const [roots, here, best] = await numbers(reading, ERRORS);
  expect(roots).toBeGreaterThan(10);
  expect(here).toBeLessThan(1);
  expect(best).toBeLessThan(1);
  await expect(figure.locator('.verdict')).toHaveText('Rows of two motions are together.');

  // A little way off, the columns can be told apart again.
  for (let step = 0; step < 10; step++) await apart.press('ArrowRight');
  await expect(reading).toContainText('Third columns at distance 0.1,');
  await expect(reading).toContainText('each row is given to its motion');
  expect((await numbers(reading, ERRORS))[0]).toBeLessThan(1);
});

test('the roots of the polynomial are what the motions predict for each direction of the gradient', async ({ page }) => {
  const { figure, reading } = await open(page, 'apart-again');
  const places = () => figure.locator('.plot[aria-label^="The polynomial"] circle.point').evaluateAll((dots) => dots.map((dot) => Number(dot.getAttribute('cx'))));
  const before = await places();
  expect(before).toHaveLength(2);
  await changes(reading, () => figure.getByRole('slider', { name: 'Gradient' }).press('ArrowRight'));
  await expect(reading).toContainText('along 53°');
  expect(await places()).not.toEqual(before);
  // The opposite direction has the opposite roots: the plot is 300 wide and symmetric.
  await changes(reading, () => figure.getByRole('slider', { name: 'Gradient' }).fill('0'));
  const zero = (await places()).sort((a, b) => a - b);
  await changes(reading, () => figure.getByRole('slider', { name: 'Gradient' }).fill('180'));
  const half = (await places()).map((x) => 300 - x).sort((a, b) => a - b);
  for (const [k, x] of zero.entries()) expect(Math.abs(x - half[k])).toBeLessThan(0.01);
});
