import { changes, expect, open, test } from './figure.mjs';

test.setTimeout(240_000);

/** The numbers of the table: a row for each noise level, without the level itself. */
const table = (figure) =>
  figure.locator('tbody tr').evaluateAll((rows) => rows.map((row) => [...row.querySelectorAll('td')].map((cell) => (cell.textContent.includes('/') ? cell.textContent.split('/').map(Number) : Number(cell.textContent)))));

test('trials accumulate, pause and go on; ours lies on the limit, the paper above', async ({ page }) => {
  const { figure, reading } = await open(page, 'noise');
  await expect(reading).toContainText('2 motions, 1 trial for each noise level.');
  const first = await table(figure);
  expect(first).toHaveLength(6);
  expect(first[0].slice(0, 4)).toEqual([0, 0, 0, 0]);

  await figure.getByRole('button', { name: 'Start' }).click();
  await expect(reading).toContainText('5 trials for each noise level', { timeout: 120_000 });
  await figure.getByRole('button', { name: 'Pause' }).press('Enter');
  await expect(figure.getByRole('button', { name: 'Go on' })).toBeVisible();
  const rows = await table(figure);
  for (const [factorised, refined, ours, limit, [, trials]] of rows.slice(1)) {
    expect(trials).toBeGreaterThanOrEqual(5);
    expect(factorised).toBeGreaterThan(refined);
    expect(refined).toBeGreaterThan(ours);
    expect(ours).toBeLessThan(1.3 * limit);
  }
  // It does rest, after the trial that was under way: another number of motions comes when what was asked before has ended.
  const trials = (of) => of.reduce((sum, row) => sum + row.at(-1)[1], 0);
  await figure.getByRole('radio', { name: '3' }).check();
  await expect(reading).toContainText('3 motions, 1 trial for each noise level.');
  await figure.getByRole('radio', { name: '2' }).check();
  await expect(reading).toContainText('2 motions,');
  const rested = await table(figure);
  expect(trials(rested)).toBeLessThanOrEqual(trials(rows) + 1);

  await changes(reading, () => figure.getByRole('radio', { name: 'means' }).check());
  await expect(reading).toContainText('Mean errors at 5 % noise');
  expect(await table(figure)).not.toEqual(rested);
});

test('another number of motions has trials of its own, and the page answers meanwhile', async ({ page }) => {
  const { figure, reading } = await open(page, 'noise');
  await figure.getByRole('radio', { name: '3' }).press('Space');
  await expect(reading).toContainText('3 motions: not yet a trial for each noise level.');
  const lasted = await page.evaluate(async () => {
    let longest = 0;
    for (let k = 0, last = performance.now(); k < 60; k++) {
      await new Promise(requestAnimationFrame);
      longest = Math.max(longest, performance.now() - last);
      last = performance.now();
    }
    return longest;
  });
  expect(lasted).toBeLessThan(500);
  await expect(reading).toContainText('3 motions, 1 trial for each noise level.');
  await expect(figure.locator('.plot .series .stated')).toHaveCount(1);
});
