// The browser of the page tests.

import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';

import { installDebianPackages } from './debian.mjs';
import { isProgram, root, which } from './project.mjs';
import { run } from './run.mjs';

const NAMES = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable', 'chrome'];
const MAC = ['/Applications/Google Chrome.app/Contents/MacOS/Google Chrome', '/Applications/Chromium.app/Contents/MacOS/Chromium'];

/** Finds or installs Chromium. Returns `{ path }`, or `{ problem }` with a sentence that says what to do. */
export async function prepareChromium() {
  const named = process.env.VERONESE_CHROMIUM;
  if (named) {
    if (isProgram(named) && (await works(named))) return { path: named };
    return { problem: `VERONESE_CHROMIUM is ${named}, which does not run: correct or unset it.` };
  }
  const found = await findChromium();
  if (found) return { path: found };
  if (await installDebianPackages(['chromium'], 'Chromium for the page tests')) {
    const installed = await findChromium();
    if (installed) return { path: installed };
  }
  return {
    problem:
      'The page tests need Chromium or Chrome, and there is none: install it (Debian: `apt-get install chromium`; ' +
      'anywhere: `npx playwright install --with-deps chromium`) or name one in VERONESE_CHROMIUM.',
  };
}

async function findChromium() {
  for (const path of [...NAMES.map(which), ...MAC.filter(existsSync)]) if (path && (await works(path))) return path;
  const own = playwrightsOwn();
  return own && (await works(own)) ? own : undefined;
}

/** Whether it runs. Existence is not enough: Ubuntu's `chromium-browser` outside snap only prints how to install snap. */
async function works(path) {
  const { code, text } = await run(path, ['--version'], { output: 'collect' });
  return code === 0 && /Chrome|Chromium/.test(text);
}

/** The browser that `npx playwright install` put in the user's cache. */
function playwrightsOwn() {
  try {
    const { chromium } = createRequire(`${root}/www/package.json`)('@playwright/test');
    const path = chromium.executablePath();
    return existsSync(path) ? path : undefined;
  } catch {
    return undefined; // The npm packages are not there: nothing to find.
  }
}
