// Starts the browser that chromium.mjs has found.

import { createRequire } from 'node:module';
import { join } from 'node:path';

import { root } from './project.mjs';

/** Playwright's browser: `executablePath` is the program, and no request is one of the browser itself. */
export function launchChromium(executablePath) {
  // Playwright is a package of the page.
  const { chromium } = createRequire(join(root, 'www', 'package.json'))('@playwright/test');
  const args = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--no-pings'];
  return chromium.launch({ executablePath, args });
}
