// The installed package and a browser, for all tests of the file that imports this.

import { after, before } from 'node:test';
import { launch } from './browser.mjs';
import { install } from './packed.mjs';

/** As `install` gives them; there once a test runs. */
export let [app, tarball, browser] = [];
let remove;

before(async () => {
  ({ app, tarball, remove } = install());
  browser = await launch();
});
after(async () => {
  await browser?.close();
  remove?.();
});
