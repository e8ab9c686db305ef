import { changes, drag, expect, numbers, open, test } from './figure.mjs';

const ANSWER = /moves by \((\S+), (\S+)\)\. The lines of (\d+) pixels agree best on \((\S+), (\S+)\): (\S+) pixels from the truth/;

test('the lines agree on the true motion, wherever it is dragged', async ({ page }) => {
  const { figure, reading } = await open(page, 'one-motion');
  const motion = figure.getByRole('slider', { name: 'Motion of the pattern' });
  for (const work of [() => motion.press('ArrowDown'), () => motion.press('Shift+ArrowLeft'), () => drag(page, motion, [-50, 80])]) {
    await changes(reading, work);
    const [u, v, count, foundU, foundV, error] = await numbers(reading, ANSWER);
    expect(count).toBe(12);
    expect(Math.hypot(foundU - u, foundV - v)).toBeLessThan(0.05);
    expect(error).toBeLessThan(0.05);
    await expect(figure.locator('line.thin:visible')).toHaveCount(12);
  }
});

test('noise moves the answer, more pixels bring it back', async ({ page }) => {
  const { figure, reading } = await open(page, 'one-motion');
  const pixels = figure.getByRole('slider', { name: 'Pixels', exact: true });
  const [, , , , , exact] = await numbers(reading, ANSWER);
  await changes(reading, () => figure.getByRole('slider', { name: 'Noise', exact: true }).press('End'));
  await changes(reading, () => pixels.press('Home'));
  const [, , two, , , far] = await numbers(reading, ANSWER);
  expect(two).toBe(2);
  expect(far).toBeGreaterThan(exact);
  await changes(reading, () => pixels.press('End'));
  const [, , all, , , near] = await numbers(reading, ANSWER);
  expect(all).toBe(80);
  expect(near).toBeLessThan(far);
});

test('stripes leave one direction open, however many pixels there are', async ({ page }) => {
  const { figure, reading } = await open(page, 'one-motion');
  await changes(reading, () => figure.getByRole('radio', { name: 'stripes' }).check());
  await expect(reading).toContainText('All 12 lines are parallel');
  await changes(reading, () => figure.getByRole('slider', { name: 'Pixels', exact: true }).press('End'));
  await expect(reading).toContainText('All 80 lines are parallel');
});
