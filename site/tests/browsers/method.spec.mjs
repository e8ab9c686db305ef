// The explainer in Chromium, Firefox and WebKit: each figure is computed and has a reading.

import { expect, test } from '@playwright/test';

import { BROWSERS, Driven } from '../../../www/browsers/driven.ts';

for (const found of BROWSERS) {
  test(`every figure of the explainer in ${found.name}`, async ({ baseURL }) => {
    test.skip(found.problem !== undefined, found.problem);
    const browser = await Driven.open(found);
    const run = (script, ...args) => browser.driver.executeScript(script, ...args);
    try {
      await browser.driver.get(new URL('method/', baseURL).href);
      const figures = await run("return [...document.querySelectorAll('figure[data-figure]')].map(({ id }) => id)");
      expect(figures.length).toBeGreaterThanOrEqual(8);
      for (const id of figures) {
        await run('document.getElementById(arguments[0]).scrollIntoView()', id);
        const state = () =>
          run(
            `const { dataset } = document.getElementById(arguments[0]);
            const reading = document.querySelector('#' + arguments[0] + ' .reading').textContent;
            return { ended: 'ready' in dataset || 'failed' in dataset, failed: 'failed' in dataset, reading };`,
            id,
          );
        await browser.until(`figure ${id}`, async () => {
          const { ended, failed, reading } = await state();
          return failed || (ended && reading !== '');
        });
        expect((await state()).failed, id).toBe(false);
      }
    } finally {
      await browser.close();
    }
  });
}
