// A browser, and a server for it.

import { createHash } from 'node:crypto';
import { launchChromium } from '../../../scripts/lib/launch-chromium.mjs';
import { serve as serveFolder } from '../../../scripts/lib/static-server.mjs';

export function launch() {
  return launchChromium(process.env.VERONESE_CHROMIUM ?? '/usr/bin/chromium');
}

/** Serves a folder on loopback with the headers; returns the address and what was asked for in vain. */
export async function serve(t, folder, headers = {}) {
  const missing = [];
  const server = await serveFolder(folder, { port: 0, host: '127.0.0.1', headers });
  server.on('request', ({ url }, response) => response.once('finish', () => response.statusCode === 404 && missing.push(url)));
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
    throw new Error(`${error.message}\nThe page said: ${complaints.join('\n') || 'nothing'}`, { cause: error });
  }
}

/** The source expression that allows one inline script. */
export function hashOf(script) {
  return `'sha256-${createHash('sha256').update(script).digest('base64')}'`;
}
