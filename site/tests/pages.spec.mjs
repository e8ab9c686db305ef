// Every page opens without a complaint, asks nobody else for anything, and is usable by everybody.

import { existsSync, readFileSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

import { expect, test } from '@playwright/test';

import identity from '../data/identity.mjs';
import { PAGES, SITE, timers, watch } from './site.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const KILOBYTE = 1024;
/** The folder of the published site. */
const PUBLISHED = new URL(identity.site).pathname;

for (const path of PAGES.filter((page) => page !== '404.html')) {
  test(`/${path} opens, in light and dark, on a phone and on a desk`, async ({ page }) => {
    const { problems } = watch(page);
    for (const [width, scheme] of [[1280, 'light'], [390, 'dark']]) {
      await page.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
      await page.setViewportSize({ width, height: 844 });
      await page.goto(path);
      await expect(page.locator('h1')).toHaveCount(1);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      expect(wide, 'nothing is wider than the screen').toBeLessThanOrEqual(0);
      await page.evaluate(AXE);
      const found = await page.evaluate(() => globalThis.axe.run({ resultTypes: ['violations'] }));
      expect(found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(' | ')}`)).toEqual([]);
    }
    expect(problems).toEqual([]);
  });
}

test('columns of tables keep their words whole on a phone', async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  for (const path of ['', 'comparison/']) {
    await page.goto(path);
    const { columns, scrolls, inside } = await page.locator('.scroll > table').first().evaluate((table) => ({
      columns: [...table.rows[1].cells].map((cell) => cell.getBoundingClientRect().width),
      scrolls: table.parentElement.scrollWidth > table.parentElement.clientWidth,
      inside: table.parentElement.getBoundingClientRect().right <= document.documentElement.clientWidth,
    }));
    expect(columns.length).toBeGreaterThanOrEqual(4);
    expect(Math.min(...columns), path).toBeGreaterThan(60);
    expect([scrolls, inside]).toEqual([true, true]);
  }
});

test('every link within the site leads somewhere, and every fragment to an element', async ({ request }) => {
  const texts = new Map();
  const textOf = (file) => {
    if (!texts.has(file)) texts.set(file, readFileSync(file, 'utf8'));
    return texts.get(file);
  };
  const broken = [];
  for (const path of PAGES) {
    const html = textOf(fileOf(path));
    // The page of what is missing is shown at any address: its links begin with the folder of the published site.
    const whole = path === '404.html' ? PUBLISHED : undefined;
    for (const [, address] of html.matchAll(/\s(?:href|src)="([^"]*)"/g)) {
      if (/^(https?:|data:|mailto:)/.test(address)) continue;
      if (whole) expect(address).toMatch(new RegExp(`^(${whole}|#)`));
      const link = whole ? address.replace(whole, '') : address;
      const { pathname, hash } = new URL(link.replaceAll('&amp;', '&'), `http://site/${path}`);
      const file = fileOf(decodeURIComponent(pathname.slice(1)));
      if (!existsSync(file) || !statSync(file).isFile()) broken.push(`${path || '/'}: ${link}`);
      else if (hash && file.endsWith('.html') && !textOf(file).includes(`id="${decodeURIComponent(hash.slice(1))}"`)) broken.push(`${path || '/'}: ${link} (fragment)`);
      expect(link, `${path}: relative`).not.toMatch(/^\//);
    }
  }
  expect(broken).toEqual([]);
  expect(PAGES.length).toBeGreaterThan(10);
  expect((await request.get('')).status()).toBe(200);
});

function fileOf(path) {
  return join(SITE, path === '' || path.endsWith('/') ? `${path}index.html` : path);
}

test('works below another folder', async ({ page, baseURL }) => {
  const { problems } = watch(page);
  const below = `http://127.0.0.1:${Number(new URL(baseURL).port) + 1}/out/site/`;
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.goto(below);
  await expect(page.locator('.told')).toContainText('things that move');
  await page.getByRole('navigation', { name: 'Site' }).getByRole('link', { name: 'The method' }).click();
  await expect(page).toHaveURL(`${below}method/`);
  await search(page, 'corrections');
  await page.locator('dialog.search li a').first().click();
  expect(page.url()).toContain(below);
  await expect(page.locator('h1')).toBeVisible();
  expect(problems).toEqual([]);
});

test('the start page segments its clip, plays it and stops', async ({ page }) => {
  const { problems } = watch(page);
  await page.goto('');
  await expect(page.locator('.told')).toContainText(/29 frames, [1-9]\d* things that move/);
  const play = page.locator('.play');
  await expect(play).toHaveText('Pause');
  const shown = () => page.evaluate(() => document.querySelector('veronese-segmenter').currentFrame);
  const first = await shown();
  await expect.poll(shown).not.toBe(first);
  await play.click();
  const stopped = await shown();
  await timers(page, 300);
  expect(await shown()).toBe(stopped);
  expect(problems).toEqual([]);
});

for (const [what, address, status] of [['element', '**/package/dist/element.js', undefined], ['frames', '**/samples/passing-cars/frames/**', 404]]) {
  test(`the start page says that its ${what} cannot be had, and goes on`, async ({ page }) => {
    const { problems } = watch(page, []);
    const thrown = [];
    page.on('pageerror', ({ message }) => thrown.push(message));
    await page.route(address, (route) => (status ? route.fulfill({ status }) : route.abort()));
    await page.goto('');
    await expect(page.locator('.told')).toContainText('The clip could not be segmented: ');
    await expect(page.locator('.play')).toBeHidden();
    await expect(page.getByAltText('two cars that pass each other')).toBeVisible();
    await search(page, 'corrections');
    await page.keyboard.press('Escape');
    await page.getByRole('link', { name: 'See how it works' }).click();
    await expect(page).toHaveURL(/\/method\/$/);
    expect(thrown).toEqual([]);
    // The browser's own complaint, and no other.
    expect(problems.filter((problem) => !/Failed to load resource|^404 .*\/frames\//.test(problem))).toEqual([]);
  });
}

test('search finds pages by keyboard', async ({ page }) => {
  const { problems } = watch(page);
  await page.goto('guide/');
  await search(page, 'label studio');
  await expect(page.locator('dialog.search .found')).toContainText(/\d+ pages|One page/);
  await page.keyboard.press('Escape');
  await expect(page.locator('dialog.search')).toBeHidden();
  expect(problems).toEqual([]);
});

async function search(page, words) {
  await page.keyboard.press('/');
  await page.getByRole('searchbox').fill(words);
  await expect(page.locator('dialog.search li a').first()).toBeVisible();
}

for (const [path, budget] of [['', 200], ['method/', 400]]) {
  test(`/${path} loads at most ${budget} KB besides the module and samples`, async ({ page }) => {
    const { requests } = watch(page);
    await page.goto(path);
    if (path === '') await expect(page.locator('.told')).toContainText('things that move');
    else await seeAll(page);
    // Workers load again what the browser has.
    const once = [...new Map(requests.map((request) => [request.url(), request])).values()];
    const sizes = await Promise.all(
      once.map(async (request) => {
        const { pathname } = new URL(request.url());
        const response = await request.response();
        return /\.wasm$|^\/samples\//.test(pathname) || !response?.ok() ? 0 : (await response.body()).length;
      }),
    );
    const kilobytes = sizes.reduce((sum, size) => sum + size, 0) / KILOBYTE;
    expect(kilobytes).toBeLessThanOrEqual(budget);
  });
}

/** Scrolls through a page until all its figures are computed. */
async function seeAll(page) {
  for (const figure of await page.locator('figure[data-figure]').all()) {
    await figure.scrollIntoViewIfNeeded();
    await expect(figure).toHaveAttribute('data-ready', '');
  }
}
