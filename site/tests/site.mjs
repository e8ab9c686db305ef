// Shared by the tests of the site.

import { readdirSync } from 'node:fs';
import { sep } from 'node:path';
import { fileURLToPath } from 'node:url';

export const SITE = fileURLToPath(new URL('../../out/site', import.meta.url));

/** Made by others' programs, from our sources: not by the templates of the site. */
const OTHERS = ['app', 'reference/package', 'reference/crate'];

/** The addresses of all pages of the site's own. */
export const PAGES = readdirSync(SITE, { recursive: true })
  .map((path) => path.split(sep).join('/'))
  .filter((path) => path.endsWith('.html') && !OTHERS.some((folder) => path.startsWith(`${folder}/`)))
  .map((path) => path.replace(/(^|\/)index\.html$/, '$1'))
  .sort();

/** Fails if the page asks another host for something, or complains. Returns what it has asked for. */
export function watch(page, problems = []) {
  const requests = [];
  page.on('request', (request) => {
    const { protocol, hostname } = new URL(request.url());
    if (['blob:', 'data:'].includes(protocol)) return;
    if (hostname !== '127.0.0.1') problems.push(`asks ${hostname}`);
    requests.push(request);
  });
  page.on('pageerror', ({ message }) => problems.push(message));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) problems.push(message.text());
  });
  page.on('response', (response) => {
    if (response.status() >= 400) problems.push(`${response.status()} ${response.url()}`);
  });
  return { problems, requests };
}

/** Waits until all timers of the page have fired that are due within so many milliseconds. */
export const timers = (page, milliseconds) => page.evaluate((delay) => new Promise((done) => setTimeout(done, delay)), milliseconds);

/** Waits for so many frames of the page. */
export async function frames(page, count) {
  for (let frame = 0; frame < count; frame++) await page.evaluate(() => new Promise(requestAnimationFrame));
}
