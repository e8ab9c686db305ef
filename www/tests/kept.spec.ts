//! The page of a test is as good as new, whatever the test before it did.

import { expect, openEmpty, test } from './support.js';

test.describe.configure({ mode: 'serial' });

test('a test leaves everything behind', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read']);
  await context.route('**/icon.svg', (route) => route.fulfill({ body: 'left' }));
  await page.addInitScript(() => Object.assign(window, { left: true }));
  await page.setViewportSize({ width: 500, height: 500 });
  await page.emulateMedia({ colorScheme: 'dark', reducedMotion: 'reduce' });
  await openEmpty(page);
  await page.evaluate(async () => {
    localStorage.setItem('left', '1');
    sessionStorage.setItem('left', '1');
    document.cookie = 'left=1; max-age=1000';
    await (await caches.open('left')).put('./left', new Response('left'));
    await (await navigator.storage.getDirectory()).getFileHandle('left', { create: true });
    await new Promise((resolve) => (indexedDB.open('left').onsuccess = resolve));
    window.addEventListener('beforeunload', (event) => event.preventDefault());
  });
  await page.locator('#zoom-in').click(); // without it nobody is asked
  await (await context.newCDPSession(page)).send('Emulation.setCPUThrottlingRate', { rate: 20 });
  await context.setOffline(true);
  await context.newPage();
});

test('and the next one finds nothing of it', async ({ page, context }) => {
  expect(context.pages()).toHaveLength(1);
  await openEmpty(page);
  const found = await page.evaluate(async () => {
    const files: string[] = [];
    for await (const name of (await navigator.storage.getDirectory()).keys()) files.push(name);
    return {
      left: 'left' in window,
      stored: [localStorage.length, sessionStorage.length, document.cookie, await caches.keys(), await indexedDB.databases(), files],
      size: [innerWidth, innerHeight],
      media: [matchMedia('(prefers-color-scheme: dark)').matches, matchMedia('(prefers-reduced-motion: reduce)').matches],
      granted: (await navigator.permissions.query({ name: 'clipboard-read' as PermissionName })).state === 'granted',
      icon: (await (await fetch('./icon.svg')).text()).slice(0, 4),
    };
  });
  expect(found).toEqual({ left: false, stored: [0, 0, '', [], [], []], size: [1280, 860], media: [false, false], granted: false, icon: '<svg' });
});
