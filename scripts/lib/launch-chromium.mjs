// Starts the browser that chromium.mjs has found.

import { createRequire } from 'node:module';
import { join } from 'node:path';

import { root } from './project.mjs';
import { Stop } from './run.mjs';
import { serve } from './static-server.mjs';

const HOST = '127.0.0.1';

/** Playwright's browser: `executablePath` is the program, and no request is one of the browser itself. */
export function launchChromium(executablePath) {
  // Playwright is a package of the page.
  const { chromium } = createRequire(join(root, 'www', 'package.json'))('@playwright/test');
  const args = [
    '--no-sandbox',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    '--no-first-run',
    '--no-pings',
  ];
  return chromium.launch({ executablePath, args });
}

/** The browser of chromium.mjs and a server of a folder for it, at `address`; `close` ends both. */
export async function openBrowser({ path, problem }, folder, headers) {
  if (problem) throw new Stop(problem);
  const server = await serve(folder, { host: HOST, headers });
  const browser = await launchChromium(path);
  const close = async () => {
    await browser.close();
    server.close();
    server.closeAllConnections();
  };
  return { browser, address: `http://${HOST}:${server.address().port}/`, close };
}
