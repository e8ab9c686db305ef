// A browser, and a server for it.

import { createHash } from 'node:crypto';
import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, sep } from 'node:path';
import { chromium } from '@playwright/test';

const TYPES = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png' };

export function launch() {
  const executablePath = process.env.VERONESE_CHROMIUM ?? '/usr/bin/chromium';
  const args = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--no-pings'];
  return chromium.launch({ executablePath, args });
}

/** Serves a folder on loopback with the headers; returns the address and what was asked for in vain. */
export async function serve(t, folder, headers = {}) {
  const missing = [];
  const server = createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const path = normalize(join(folder, name.endsWith('/') ? `${name}index.html` : name));
    if (!path.startsWith(folder + sep) || !statSync(path, { throwIfNoEntry: false })?.isFile()) {
      missing.push(name);
      response.writeHead(404).end('not found');
      return;
    }
    response.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream', ...headers }).end(readFileSync(path));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => {
    server.close();
    server.closeAllConnections();
  });
  return { address: `http://127.0.0.1:${server.address().port}/`, missing };
}

/** Opens a page and waits for its `outcome`; every error and refusal that the browser reports fails it. */
export async function outcomeOf(t, browser, address) {
  const page = await browser.newPage();
  t.after(() => page.close());
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  await page.goto(address);
  try {
    await page.waitForFunction(() => globalThis.outcome !== undefined, undefined, { timeout: 60_000 });
    const outcome = await page.evaluate(() => globalThis.outcome);
    return { outcome, complaints };
  } catch (error) {
    throw new Error(`${error.message}\nThe page said: ${complaints.join('\n') || 'nothing'}`);
  }
}

/** The source expression that allows one inline script. */
export function hashOf(script) {
  return `'sha256-${createHash('sha256').update(script).digest('base64')}'`;
}
