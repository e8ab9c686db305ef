import { expect, test } from '@playwright/test';

import { timers } from '../site.mjs';

test.describe.configure({ mode: 'serial' });

/** The clip is segmented once, for all tests. */
let page;
let figure;

test.beforeAll(async ({ browser, baseURL }) => {
  page = await browser.newPage({ baseURL });
  await page.goto('method/#clip');
  figure = page.locator('#clip');
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute('data-ready', '');
  await settled();
});

test.afterAll(() => page.close());

const settled = () => expect(figure.getByRole('button', { name: 'Stop' })).toBeDisabled({ timeout: 120_000 });
const reading = () => figure.locator('.reading');
const slider = () => figure.getByRole('slider', { name: 'Frame', exact: true });

/** Numbers of each frame: pixels of each object, of the pairs alone, agreement, changed pixels. */
async function table() {
  const rows = await figure.locator('tbody tr').evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  return rows.map(([, objects, alone, agreement, changed]) => ({
    objects: Object.fromEntries(objects.split(', ').map((entry) => entry.split(': ').map(Number))),
    alone: Number.parseInt(alone, 10),
    agreement: Number.parseFloat(agreement),
    changed: Number(changed),
  }));
}

/** The number of the second car: the first car is object 1, and anything else is small. */
const secondCar = (frames) => {
  const { objects } = frames[11];
  return Object.keys(objects).filter((id) => id !== '1').sort((a, b) => objects[b] - objects[a])[0];
};

const canvasSum = () => figure.locator('canvas').evaluate((one) => one.getContext('2d').getImageData(0, 0, one.width, one.height).data.reduce((sum, value, k) => (sum * 31 + value * k) % 1_000_003, 7));

test('the whole clip knows more than its pairs', async () => {
  const frames = await table();
  expect(frames).toHaveLength(25);
  // The pairs of the first frames do not show the first car yet.
  expect(frames[1].alone).toBe(0);
  expect(frames[1].objects[1]).toBeGreaterThan(500);
  // Both cars keep their numbers to the end.
  for (const frame of frames.slice(8, 22)) {
    expect(frame.objects[1]).toBeGreaterThan(5000);
    expect(frame.objects[secondCar(frames)]).toBeGreaterThan(5000);
    expect(frame.agreement).toBeLessThan(100);
  }
});

test('frames are chosen by keys, by the strip and by playing', async () => {
  await slider().fill('18');
  await slider().press('ArrowRight');
  await expect(reading()).toContainText('Frame 19 of 25');
  const strip = figure.locator('svg.strip').first();
  const { width, height } = await strip.boundingBox();
  await strip.click({ position: { x: (12.5 / 25) * width, y: height / 2 } });
  await expect(slider()).toHaveValue('13');
  await figure.getByRole('button', { name: 'Play' }).click();
  await expect(slider()).not.toHaveValue('13');
  await figure.getByRole('button', { name: 'Pause' }).click();
  const still = await slider().inputValue();
  await timers(page, 500);
  await expect(slider()).toHaveValue(still);
});

test('masks of the pairs alone are others than those of the clip', async () => {
  await slider().fill('19');
  const whole = await canvasSum();
  await figure.getByLabel('its pairs alone').check();
  expect(await canvasSum()).not.toBe(whole);
  await figure.getByLabel('the whole clip').check();
  expect(await canvasSum()).toBe(whole);
});

test('a stroke spreads from its frame, changes nothing else, and is taken back', async () => {
  const before = await table();
  await figure.getByRole('button', { name: /Paint the shadow/ }).click();
  await settled();
  const after = await table();
  const car = secondCar(before);
  expect(after[17].objects[car]).toBeLessThan(before[17].objects[car] - 1000);
  expect(after[20].objects[car]).toBeLessThan(before[20].objects[car] - 500);
  after.forEach((frame, index) => expect(frame.objects[1], `object 1 in frame ${index + 1}`).toBe(before[index].objects[1]));
  await expect(reading()).toContainText('One stroke changed');
  await figure.getByRole('button', { name: 'Take back' }).click();
  await settled();
  expect(await table()).toEqual(before);
});

test('a stroke that is stopped leaves nothing', async () => {
  const before = await table();
  await figure.getByRole('button', { name: /Paint the shadow/ }).click();
  await expect(figure.locator('.news')).toContainText('The stroke has reached');
  await figure.getByRole('button', { name: 'Stop' }).click();
  await settled();
  await expect(figure.locator('.news')).toContainText('Stopped');
  expect(await table()).toEqual(before);
});

test('strokes are painted by keys and by the mouse', async () => {
  const before = await table();
  await slider().fill('14');
  const brush = figure.getByRole('slider', { name: /^Brush/ });
  await brush.focus();
  for (let k = 0; k < 20; k++) await brush.press('ArrowLeft');
  await expect(brush).toHaveAttribute('aria-valuetext', /column 176, row 144/);
  await brush.press(' ');
  await expect(brush).toHaveAttribute('aria-valuetext', /painting/);
  await brush.press('Shift+ArrowLeft');
  await brush.press('Escape');
  await brush.press(' ');
  for (let k = 0; k < 4; k++) await brush.press('Shift+ArrowDown');
  await figure.getByLabel('object 1').check();
  expect(await table(), 'a stroke that is left is none').toEqual(before);
  await brush.press(' ');
  await brush.press('ArrowRight');
  await brush.press(' ');
  await settled();
  const keyed = await table();
  expect(keyed[13].objects[1]).toBeGreaterThan(before[13].objects[1]);

  await figure.getByLabel('ground').check();
  const { x, y, width, height } = await figure.locator('canvas').boundingBox();
  const at = (column, row) => [x + (column / 512) * width, y + (row / 288) * height];
  await page.mouse.move(...at(80, 222));
  await page.mouse.down();
  await page.mouse.move(...at(150, 222), { steps: 5 });
  await page.mouse.up();
  await settled();
  const painted = await table();
  expect(painted[13].changed).toBeGreaterThan(keyed[13].changed);
  await expect(reading()).toContainText('2 strokes changed');
});
