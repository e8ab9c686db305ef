//! The package alone in each browser: answers the cases of `npm run same-bits`, which compares their bits with those of other variants.

import { writeFile } from 'node:fs/promises';

import { test } from '@playwright/test';

import { BROWSERS, Driven } from '../browsers/driven.js';

/** The page, the address of the folder with the cases, and a file for the answers, with the browser's name in the place of `NAME`. */
const { page, folder, out } = JSON.parse(process.env.VERONESE_SAME_BITS ?? '{}') as Record<'page' | 'folder' | 'out', string>;

for (const found of BROWSERS) {
  test(`the package in ${found.name}`, async () => {
    test.skip(found.problem !== undefined, found.problem);
    const browser = await Driven.open(found);
    try {
      await browser.driver.manage().setTimeouts({ script: 1_700_000 });
      await browser.driver.get(page);
      await browser.until('the package', () => browser.driver.executeScript<boolean>('return globalThis.sameBits !== undefined;'));
      const answer = await browser.driver.executeAsyncScript<string>(
        `const done = arguments[arguments.length - 1];
        globalThis.sameBits(arguments[0]).then((found) => done(JSON.stringify({ found })), (error) => done(JSON.stringify({ error: String(error) })));`,
        folder,
      );
      const { found: bits, error } = JSON.parse(answer) as { found?: unknown; error?: string };
      if (error !== undefined) throw new Error(error);
      await writeFile(out.replace('NAME', found.name), JSON.stringify(bits));
    } finally {
      await browser.close();
    }
  });
}
