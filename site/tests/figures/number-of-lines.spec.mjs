import { changes, expect, open, test } from './figure.mjs';

const ranks = (reading) => reading.textContent().then((text) => [...text.matchAll(/degree (\d): (\d) of (\d)/g)].map((found) => found.slice(1).map(Number)));

test('n lines have full rank below degree n, and rank n from there on', async ({ page }) => {
  const { figure, reading } = await open(page, 'number-of-lines');
  for (const n of [1, 3, 4, 2]) {
    await changes(reading, () => figure.getByRole('radio', { name: String(n) }).check());
    await expect(reading).toContainText(new RegExp(`^${n} lines? at .*which is right\\.$`));
    expect(await ranks(reading)).toEqual([1, 2, 3, 4, 5].map((degree) => [degree, Math.min(n, degree + 1), degree + 1]));
    // The polynomial of that degree gives all lines back.
    await expect(figure.locator('.guide')).toHaveCount(n);
    await expect(figure.locator('.degrees .first b')).toHaveText(`n = ${n}`);
  }
});

test('noise takes the dependence away', async ({ page }) => {
  const { figure, reading } = await open(page, 'number-of-lines');
  const noise = figure.getByRole('slider', { name: 'Noise' });
  await noise.focus();
  await changes(reading, () => noise.press('ArrowRight'));
  await expect(reading).toContainText('2 lines at 25°, 80°, noise 0.25 %');
  await expect(reading).toContainText('which is right');
  await changes(reading, () => noise.press('End'));
  await expect(reading).toContainText('degree 2: 3 of 3');
  await expect(figure.locator('.degrees li').nth(1).locator('.rank')).toHaveText('rank 3 of 3');
});
