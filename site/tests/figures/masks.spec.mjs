import { fileURLToPath } from 'node:url';

import { expect, test } from '@playwright/test';

test.describe.configure({ mode: 'serial' });

const SAMPLE = fileURLToPath(new URL('../../../www/public/samples/parallax/', import.meta.url));
const STAGES = ['Derivatives', 'Dominant motion', 'Measurements', 'Candidates', 'Selection', 'Refinement', 'Labels', 'Masks'];

/** The first pair is segmented once, for all tests. */
let page;
let figure;

test.beforeAll(async ({ browser, baseURL }) => {
  page = await browser.newPage({ baseURL });
  await page.goto('method/#masks');
  figure = page.locator('#masks');
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute('data-ready', '', { timeout: 120_000 });
});

test.afterAll(() => page.close());

const reading = () => figure.locator('.reading');
const stage = (k) => figure.getByLabel(`${k + 1} ${STAGES[k]}`, { exact: true });
const rows = () => figure.locator('tbody tr').evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.innerText.replace('−', '-'))));
const picture = () => figure.locator('.picture canvas').evaluate((one) => one.getContext('2d').getImageData(0, 0, one.width, one.height).data.reduce((sum, value, k) => (sum * 31 + value * k) % 1_000_003, 7));

test('buttons and keys go through all stages', async () => {
  for (const [k, name] of STAGES.entries()) {
    await expect(reading()).toContainText(`Stage ${k + 1} of 8, ${name.toLowerCase()}`);
    await expect(stage(k)).toBeChecked();
    if (k < 7) await figure.getByRole('button', { name: 'Next stage' }).click();
  }
  await expect(figure.getByRole('button', { name: 'Next stage' })).toBeDisabled();
  await figure.getByRole('button', { name: 'Back' }).click();
  await expect(reading()).toContainText('Stage 7 of 8');
  await stage(6).press('ArrowLeft');
  await expect(stage(5)).toBeFocused();
  await expect(reading()).toContainText('Stage 6 of 8');
});

test('every picture of every stage is another one', async () => {
  for (const k of STAGES.keys()) {
    await stage(k).check();
    const choices = figure.locator('.picture + div input');
    const seen = new Set();
    const count = await choices.count();
    for (let c = 0; c < count; c++) {
      await choices.nth(c).check();
      const arrows = await figure.locator('.picture .arrow').count();
      seen.add(`${await picture()} ${arrows}`);
    }
    // The two sizes of labels may agree.
    expect(seen.size, STAGES[k]).toBeGreaterThanOrEqual(Math.min(count, 6 === k ? 2 : count));
  }
});

test('things have one colour each, and so have motions, in the picture and in the table', async () => {
  await stage(7).check();
  const swatches = () => figure.locator('tbody .swatch').evaluateAll((all) => all.map((one) => getComputedStyle(one.querySelector('rect')).fill));
  const outlines = () => figure.locator('.picture canvas').evaluate((one) => {
    const { data } = one.getContext('2d').getImageData(0, 0, one.width, one.height);
    const tones = ['one', 'two', 'three', 'four'].map((name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    const counts = tones.map(() => 0);
    for (let p = 0; p < data.length; p += 4) {
      const tone = `#${[data[p], data[p + 1], data[p + 2]].map((value) => value.toString(16).padStart(2, '0')).join('')}`;
      if (tones.includes(tone)) counts[tones.indexOf(tone)]++;
    }
    return counts.filter((count) => count > 20).length;
  });
  for (const choice of ['things', 'motions']) {
    await figure.getByLabel(choice, { exact: true }).check();
    const coloured = new Set((await swatches()).slice(1));
    expect(coloured.size, choice).toBe(await outlines());
    const row = (await rows()).find(([name]) => name.toLowerCase() === choice);
    expect(coloured.size, choice).toBe(Number(row[1]) - 1);
  }
});

test('another pair, and one of the reader’s own, which is the same', async () => {
  await stage(7).check();
  await figure.getByLabel('parallax').check();
  await expect(figure.locator('.stage')).not.toHaveClass(/busy/, { timeout: 120_000 });
  await expect(reading()).toContainText('4 motions, 4 things');
  const sample = await reading().textContent();
  await figure.getByLabel('two cars').check();
  await expect(reading()).not.toHaveText(sample, { timeout: 120_000 });
  const input = figure.getByLabel('Two frames of your own');
  await input.setInputFiles([`${SAMPLE}first.png`]);
  await expect(figure.locator('.news')).toContainText('Two pictures are needed, not 1');
  await input.setInputFiles([`${SAMPLE}second.png`, `${SAMPLE}first.png`]);
  await expect(reading()).toHaveText(sample, { timeout: 120_000 });
});

test('frames of two sizes are refused with the reason', async () => {
  const before = await reading().textContent();
  await figure.getByLabel('Two frames of your own').setInputFiles([`${SAMPLE}first.png`, `${SAMPLE}../intel-two-cars/second.png`]);
  await expect(figure.locator('.news')).toContainText('400');
  await expect(reading()).toHaveText(before);
});
