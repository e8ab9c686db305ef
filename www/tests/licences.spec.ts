//! The page with the licences: whoever wants it finds it, nobody else loads it.

import { readFileSync } from 'node:fs';

import { expect, open, test } from './support.js';

test.use({ serviceWorkers: 'allow' });

test('the footer leads to all licences and sources, which a visit does not load', async ({ page }) => {
  const loaded: string[] = [];
  page.context().on('request', (request) => loaded.push(request.url()));
  await open(page);
  await expect(page.locator('html')).toHaveAttribute('data-offline', 'ready');
  expect(loaded.length).toBeGreaterThan(5);
  expect(loaded.filter((url) => url.includes('licences'))).toEqual([]);
  const kept = await page.evaluate(async () => {
    const caches = await Promise.all((await window.caches.keys()).map(async (name) => (await window.caches.open(name)).keys()));
    return caches.flat().map(({ url }) => url);
  });
  expect(kept.length).toBeGreaterThan(5);
  expect(kept.filter((url) => url.includes('licences'))).toEqual([]);

  await page.getByRole('link', { name: 'Licences and sources' }).click();
  await expect(page).toHaveTitle('Licences – Veronese');
  const texts = await page.locator('pre').allTextContents();
  const read = (name: string): string => readFileSync(new URL(`../../${name}`, import.meta.url), 'utf8');
  const files = ['THIRD-PARTY-NOTICES', 'LICENSE-MIT', 'LICENSE-APACHE'].map(read);
  expect(texts).toEqual(files);
  await expect(page.locator('a[href="https://github.com/Vanilagy/mediabunny"]').first()).toBeVisible();
});
