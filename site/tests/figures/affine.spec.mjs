import { changes, drag, expect, open, test } from './figure.mjs';

/** The columns of the table: the motion, and what the pixels tell. */
async function columns(figure) {
  const texts = await figure.locator('tbody td').allTextContents();
  const values = texts.map((text) => Number(text.replace('−', '-')));
  return [0, 1].map((column) => values.filter((_, k) => k % 2 === column));
}

test('the pixels tell all six numbers of the motion, wherever its corners go', async ({ page }) => {
  const { figure, reading } = await open(page, 'affine');
  const corner = (name) => figure.getByRole('slider', { name: `${name} corner` });
  const works = [
    () => corner('Upper left').press('ArrowRight'),
    () => corner('Upper right').press('Shift+ArrowDown'),
    () => drag(page, corner('Lower left'), [30, -40]),
    () => figure.getByRole('button', { name: 'Grow' }).click(),
  ];
  for (const work of works) {
    await changes(reading, work);
    await expect(reading).toContainText('20 pixels tell 6 of its 6 numbers, exactly');
    const [motion, told] = await columns(figure);
    expect(told).toEqual(motion);
  }
  expect((await columns(figure))[0]).toEqual([0.35, 0, 0, 0, 0.35, 0]);
  const corners = await Promise.all(['Upper left', 'Upper right', 'Lower left'].map((name) => corner(name).getAttribute('aria-valuetext')));
  expect(corners).toEqual(['−1.35, −1.35', '1.35, −1.35', '−1.35, 1.35']);
});

test('six pixels are needed', async ({ page }) => {
  const { figure, reading } = await open(page, 'affine');
  const pixels = figure.getByRole('slider', { name: 'Pixels', exact: true });
  await changes(reading, () => pixels.press('Home'));
  await expect(reading).toContainText('4 pixels do not determine it');
  expect((await columns(figure))[1].every(Number.isNaN)).toBe(true);
  await pixels.press('ArrowRight');
  await changes(reading, () => pixels.press('ArrowRight'));
  await expect(reading).toContainText('6 pixels tell 6 of its 6 numbers');
});
