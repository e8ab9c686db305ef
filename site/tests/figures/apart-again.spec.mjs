import { expect, test } from '@playwright/test';

import { changes, drag, numbers, open } from './figure.mjs';

const ERRORS = /By roots, .*?: error (\S+) %\..* error (\S+) %; at the best of 60 pixels: (\S+) %\.$/;

test('roots lose track where third columns are equal; derivatives do not', async ({ page }) => {
  const { figure, reading, problems } = await open(page, 'apart-again');
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
  expect(problems).toEqual([]);
});

test('without noise both are exact, and at a pixel where flows agree derivatives fail', async ({ page }) => {
  const { figure, reading, problems } = await open(page, 'apart-again');
  await changes(reading, () => figure.getByRole('slider', { name: 'Noise' }).fill('0'));
  await expect(reading).toContainText(/By roots, .*: error about 10⁻\S+ %\..* error about 10⁻\S+ %; at the best of 60 pixels: about 10⁻\S+ %\./);

  await changes(reading, () => figure.getByRole('slider', { name: 'Noise' }).fill('0.3'));
  await figure.getByRole('slider', { name: 'Distance' }).fill('0');
  await expect(reading).toContainText('Third columns at distance 0,');
  const pixel = figure.getByRole('slider', { name: 'Pixel' });
  await changes(reading, () => drag(page, pixel, [-40, -20]));
  expect((await numbers(reading, ERRORS))[1]).toBeLessThan(5);
  // Keys take it to the centre, where both motions have the same flow.
  const [, x, y] = (await pixel.getAttribute('aria-valuetext')).match(/(\S+), (\S+)/).map((text) => Number(text.replace('−', '-')));
  for (let step = 0; step < Math.round(Math.abs(x) / 0.02); step++) await pixel.press(x > 0 ? 'ArrowLeft' : 'ArrowRight');
  for (let step = 0; step < Math.round(Math.abs(y) / 0.02); step++) await pixel.press(y > 0 ? 'ArrowUp' : 'ArrowDown');
  await expect(reading).toContainText(/at the pixel (−?0(\.0\d)?), (−?0(\.0\d)?) along/);
  await expect(figure.locator('.results li').nth(1)).toHaveClass(/bad/);
  const [, , best] = await numbers(reading, /error (\S+) %\..* (error \S+ %|nothing found); at the best of 60 pixels: (\S+) %\.$/);
  expect(best).toBeLessThan(1);
  expect(problems).toEqual([]);
});

test('the roots of the polynomial are what the motions predict for each direction of the gradient', async ({ page }) => {
  const { figure, reading, problems } = await open(page, 'apart-again');
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
  expect(problems).toEqual([]);
});

test('with other noise the guess is another, and derivatives stay right', async ({ page }) => {
  const { figure, reading, problems } = await open(page, 'apart-again');
  await changes(reading, () => figure.getByRole('slider', { name: 'Distance' }).fill('0'));
  const guesses = new Set();
  for (let draw = 0; draw < 8; draw++) {
    guesses.add(await figure.locator('.verdict').textContent());
    expect((await numbers(reading, ERRORS))[2]).toBeLessThan(1);
    await changes(reading, () => figure.getByRole('button', { name: 'Other noise' }).press('Enter'));
  }
  expect(guesses.size).toBe(2);
  expect(problems).toEqual([]);
});
