import { changes, expect, open, test } from './figure.mjs';

const ranks = (reading) => reading.textContent().then((text) => [...text.matchAll(/n = (\d): rank (\d+) of (\d+)/g)].map((found) => found.slice(1).map(Number)));

test('the first matrix that is not full lacks one rank: the number of motions', async ({ page }) => {
  const { figure, reading } = await open(page, 'number-of-motions');
  for (const n of [1, 3, 2]) {
    await changes(reading, () => figure.getByRole('radio', { name: String(n) }).check());
    await expect(reading).toContainText(new RegExp(`^${n} motions? in truth.*The lowest score is that of ${n} motions?\\. ✓`));
    const found = await ranks(reading);
    // M_n² − Z_n columns.
    expect(found.map(([, , columns]) => columns)).toEqual([7, 25, 65, 140, 266]);
    for (const [degree, rank, columns] of found) {
      if (degree < n) expect(rank).toBe(columns);
      else if (degree === n && n < 3) expect(rank).toBe(columns - 1);
      else expect(rank).toBeLessThan(columns);
    }
    await expect(figure.locator('.degrees .first b')).toHaveText(`n = ${n}`);
    await expect(figure.locator('.scores .first b')).toHaveText(`n = ${n}`);
  }
});

test('a threshold that is too high finds fewer, one that is too low finds none under noise', async ({ page }) => {
  const { figure, reading } = await open(page, 'number-of-motions');
  await expect(reading).toContainText('Our scores');
  const threshold = figure.getByRole('slider', { name: 'Threshold κ' });
  await changes(reading, () => threshold.press('End'));
  await expect(figure.locator('.degrees li').first().locator('.rank')).not.toHaveText('rank 7 of 7');
  await changes(reading, () => figure.getByRole('slider', { name: 'Noise' }).fill('5'));
  await changes(reading, () => threshold.press('Home'));
  await expect(reading).toContainText('n = 2: rank 25 of 25');
  await expect(figure.locator('.verdict').first()).toHaveClass(/wrong/);
  await expect(figure.locator('.verdict').nth(1)).toHaveText(/^The lowest score is that of 2 motions\. ✓/);
});
