//! Accessibility, content security policy, offline use, licences, size, memory. `npm run bench -- page` measures how long the page is blocked.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

import { type Page } from '@playwright/test';

import { PAIR, axe, clipDone, clipFrames, done, drag, expect, inspect, kept, labelsOnCanvas, openClip, openEmpty, openExport, openSample, openSegmented, opened, segmentClip, test, unwatched, withSamples } from './support.js';

const DIST = fileURLToPath(new URL('../dist/', import.meta.url));

/** Axe finds nothing serious, light and dark. */
async function check(page: Page): Promise<void> {
  // All but the colours is the same in the dark.
  await page.emulateMedia({ colorScheme: 'light' });
  expect(await axe(page)).toEqual([]);
  await page.emulateMedia({ colorScheme: 'dark' });
  expect(await axe(page, ['color-contrast']), 'dark').toEqual([]);
}

test('axe finds nothing serious, light and dark, and single-key shortcuts can be disabled', async ({ page }) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await openClip(page, await clipFrames(2, 96, 64));
  await inspect(page);
  await page.locator('#motions summary').nth(1).click();
  await openExport(page);
  await check(page);
  await page.keyboard.press('Escape');

  // ? lists the shortcuts, which can be disabled.
  await page.setViewportSize({ width: 360, height: 740 });
  await page.keyboard.press('?');
  const dialog = page.getByRole('dialog', { name: 'Keyboard shortcuts' });
  await expect(dialog).toContainText('Alternate between the frames');
  await check(page);
  await dialog.getByLabel('Enable single-key shortcuts').uncheck();
  await dialog.getByRole('button', { name: 'Close' }).click();
  await page.keyboard.press('s');
  await expect(page.locator('#caption')).toHaveText('Frame 0');
  await page.keyboard.press('?');
  await expect(dialog).toBeHidden();
});

test('axe finds nothing serious with a clip, whatever is done with it', async ({ page }) => {
  await openSegmented(page, await clipFrames(3, 96, 64));
  await kept(page);
  await test.step('one frame is accepted, both objects are selected, one of them is locked', async () => {
    await page.getByRole('button', { name: 'Lock Object 1' }).click();
    await page.keyboard.press('y');
    for (const id of [1, 2]) await page.locator(`#objects > [data-mask="${id}"] .thumbnail`).click({ modifiers: ['ControlOrMeta'] });
    await expect(page.getByRole('group', { name: 'Selected objects' })).toBeVisible();
    await check(page);
  });
  await test.step('the dialogue of classes', async () => {
    await page.getByRole('button', { name: 'Classes…' }).click();
    await check(page);
    await page.keyboard.press('Escape');
  });
  await test.step('a polygon is being drawn, on a phone', async () => {
    await page.setViewportSize({ width: 360, height: 740 });
    await page.locator('#objects > [data-mask="2"] .thumbnail').click();
    await page.keyboard.press('w');
    await drag(page, [0.5, 0.2], [0.5, 0.2]);
    await drag(page, [0.6, 0.3], [0.6, 0.3]);
    await expect(page.locator('.corners')).toHaveAttribute('d', /^(M[^M]+){2}$/);
    await check(page);
    await page.keyboard.press('Escape');
    await page.setViewportSize({ width: 1280, height: 860 });
  });
  await test.step('a box asks what it is, and a correction has changed frames', async () => {
    await page.keyboard.press('x');
    await drag(page, [0.5, 0.05], [0.6, 0.2]);
    await clipDone(page);
    await check(page);
  });
  await test.step('something that was not found is offered as an object', async () => {
    await page.keyboard.press('v');
    await drag(page, [0.5, 0.9], [0.5, 0.9]);
    await expect(page.getByRole('button', { name: 'New object here' })).toBeVisible();
    await check(page);
  });
  await test.step('the export of a clip', async () => {
    await openExport(page);
    await expect(page.locator('#clip-preview li')).not.toHaveCount(0);
    await check(page);
    await page.keyboard.press('Escape');
  });
  await test.step('the clip is offered at the next visit', async () => {
    await kept(page);
    await page.goto('about:blank');
    await page.goto('./#sample=parallax&quality=fast&segment=asked');
    await done(page);
    await expect(page.getByRole('region', { name: 'Continue your work' }).getByRole('button')).toBeVisible();
    await check(page);
  });
});

unwatched('inline scripts are blocked', async ({ page }) => {
  await openEmpty(page);
  await withSamples(page); // which only watched tests do by themselves
  const refused = await page.evaluate(
    () =>
      new Promise<string>((resolve) => {
        document.addEventListener('securitypolicyviolation', ({ violatedDirective, blockedURI }) => resolve(`${violatedDirective} ${blockedURI}`));
        const script = document.createElement('script');
        script.textContent = 'window.reached = true';
        document.body.append(script);
      }),
  );
  expect(refused).toBe('script-src-elem inline');
  expect(await page.evaluate(() => 'reached' in window)).toBe(false);
});

test('the page loads what it needs: scripts within their size budgets, none for videos, and the core module; its content security policy has no exceptions', async ({ page }) => {
  const asked = new Set<string>();
  page.on('request', (request) => asked.add(request.url().replace(/^.*\//, '')));
  const response = await page.goto(`${PAIR}&quality=fast`);
  const meta = await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content');
  expect(response?.headers()['content-security-policy']).toBe(meta);
  expect(meta).not.toContain('unsafe-inline');
  expect(meta).not.toContain("'unsafe-eval'");
  expect(meta).toContain("script-src 'self' 'wasm-unsafe-eval';");
  const html = readFileSync(join(DIST, 'index.html'), 'utf8');
  expect(html).not.toMatch(/<script(?![^>]*\ssrc=)|\sstyle=|\son\w+=|<style/);
  await clipDone(page);
  expect(await page.evaluate(() => crossOriginIsolated)).toBe(false); // it needs no isolation
  expect([...asked].filter((name) => /^(exact|reader|video-file|browser)-/.test(name))).toEqual([]);
  expect([...asked].flatMap((name) => /^([a-z_]+_bg).*\.wasm$/.exec(name)?.[1] ?? [])).toEqual(['veronese_bg']);
  // The host page has scripts of its own. Mediabunny is `reader` and, with what writes videos, `video-file`.
  const files = readdirSync(join(DIST, 'assets')).filter((name) => name.endsWith('.js') && !/^(embed|element|reader|video-file)-/.test(name));
  const sizeOf = (names: readonly string[]): number => names.reduce((sum, name) => sum + gzipSync(readFileSync(join(DIST, 'assets', name)), { level: 9 }).length, 0);
  expect(sizeOf(files.filter((name) => asked.has(name)))).toBeLessThanOrEqual(94 * 1024);
  // The others are loaded when they are used. Few need the readers of annotation tools.
  const later = files.filter((name) => !asked.has(name));
  const reading = later.filter((name) => name.startsWith('importing-'));
  expect(reading).toHaveLength(1);
  expect(sizeOf(reading)).toBeLessThanOrEqual(24 * 1024);
  expect(sizeOf(later.filter((name) => !reading.includes(name)))).toBeLessThanOrEqual(56 * 1024);
});

test('a first visit loads at most 583 KB, compressed, until it shows masks', async ({ page }) => {
  // As a web server sends it: text and the module with gzip, pictures as they are.
  const sizes = new Map<string, number>();
  page.on('request', (request) => {
    const { protocol, pathname } = new URL(request.url());
    if (protocol === 'blob:') return;
    const file = readFileSync(join(DIST, pathname === '/' ? 'index.html' : pathname));
    sizes.set(pathname, /\.(png|jpe?g|webp)$/.test(pathname) ? file.length : gzipSync(file, { level: 9 }).length);
  });
  await page.goto('./');
  await expect.poll(async () => new Set(await labelsOnCanvas(page)).size, { intervals: [50] }).toBeGreaterThan(2);
  const total = [...sizes.values()].reduce((sum, size) => sum + size, 0);
  console.log(`a first visit: ${total} bytes, ${[...sizes].map(([path, size]) => `${path} ${size}`).join(', ')}`);
  // The page, its style, its scripts, the module and all frames are counted.
  for (const part of [/^\/$/, /index-.*\.css$/, /index-.*\.js$/, /worker-.*\.js$/, /\.wasm$/, /\/00\.webp$/, /\/50\.webp$/]) {
    expect([...sizes].find(([path]) => part.test(path))?.[1]).toBeGreaterThan(1000);
  }
  const clip = [...sizes].filter(([path]) => path.includes('/frames/')).map(([, size]) => size);
  expect(clip).toHaveLength(51);
  expect(clip.reduce((sum, size) => sum + size, 0)).toBeLessThanOrEqual(250 * 1024);
  expect(total).toBeLessThanOrEqual(583 * 1024);
});

test('memory does not grow over 100 steps, each of which finds the motions', { tag: '@soak' }, async ({ page }) => {
  await openClip(page, await clipFrames(3, 200, 150));
  await inspect(page);
  const cdp = await page.context().newCDPSession(page);
  const heap = async (): Promise<number> => {
    await cdp.send('HeapProfiler.collectGarbage');
    return (await cdp.send('Runtime.getHeapUsage')).usedSize;
  };
  const stepAndBack = (times: number): Promise<void> =>
    page.evaluate(async (times) => {
      for (let k = 0; k < 2 * times; k++) {
        const isThere = (): boolean => document.querySelector('#caption')?.textContent === `Frame ${1 - (k % 2)}` && document.querySelector('.inspected')?.ariaBusy === 'false';
        document.body.dispatchEvent(new KeyboardEvent('keydown', { key: k % 2 === 0 ? '.' : ',', bubbles: true, cancelable: true }));
        await new Promise<void>((resolve) => {
          const observer = new MutationObserver(() => {
            if (!isThere()) return;
            observer.disconnect();
            resolve();
          });
          observer.observe(document.body, { attributes: true, childList: true, characterData: true, subtree: true });
        });
      }
    }, times);
  await stepAndBack(10);
  const early = await heap();
  await stepAndBack(40);
  const late = await heap();
  console.log(`heap after 20: ${(early / 2 ** 20).toFixed(1)} MiB, after 100: ${(late / 2 ** 20).toFixed(1)} MiB`);
  expect(late - early).toBeLessThan(2 * 2 ** 20);
  expect(page.workers()).toHaveLength(2); // of what is inspected and of the clip
});

test.describe('with a service worker', () => {
  test.use({ serviceWorkers: 'allow' });

  test('the page works offline after the first visit, which does not load the licences that the footer leads to', async ({ page, context }) => {
    const loaded: string[] = [];
    context.on('request', (request) => loaded.push(request.url()));
    await page.goto('./#sample=parallax&quality=fast&segment=asked');
    await done(page);
    await segmentClip(page);
    const labels = await labelsOnCanvas(page);
    await expect(page.locator('html')).toHaveAttribute('data-offline', 'ready');
    const kept = await page.evaluate(async () => {
      const caches = await Promise.all((await window.caches.keys()).map(async (name) => (await window.caches.open(name)).keys()));
      return caches.flat().map(({ url }) => url);
    });
    for (const urls of [loaded, kept]) {
      expect(urls.length).toBeGreaterThan(5);
      expect(urls.filter((url) => url.includes('licences'))).toEqual([]);
    }

    await context.setOffline(true);
    await page.reload();
    await done(page);
    await segmentClip(page);
    expect(await labelsOnCanvas(page)).toEqual(labels);
    await openSample(page, 'Passing cars');
    await opened(page, 'passing-cars, 51 frames, 512 × 288');
    await context.setOffline(false);

    await page.getByRole('link', { name: 'Licences and sources' }).click();
    await expect(page).toHaveTitle('Licences – Veronese');
    const texts = await page.locator('pre').allTextContents();
    const read = (name: string): string => readFileSync(new URL(`../../${name}`, import.meta.url), 'utf8');
    expect(texts).toEqual(['THIRD-PARTY-NOTICES', 'LICENSE-MIT', 'LICENSE-APACHE'].map(read));
    await expect(page.locator('a[href="https://github.com/Vanilagy/mediabunny"]').first()).toBeVisible();
  });
});
