// npm run test:browsers: drives the built page in Chromium, Firefox and WebKit, and compares the bits of the masks with those in Node.
// What is missing is installed where that needs no confirmation: on Debian and its derivatives, as root, firefox-esr, webkit2gtk-driver,
// xvfb and chromium-driver by apt-get; geckodriver by cargo, into .tools. Writes screenshots to out/screens. Each browser that cannot be
// driven is a failure here; `npm test` skips it.

import { findBrowsers, testInBrowsers } from './lib/browsers.mjs';
import { buildAll } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command } from './lib/run.mjs';

await command(async () => {
  const { chromium } = await prepare({ browser: true });
  const browsers = await findBrowsers(chromium.path, { install: true });
  await buildAll();
  const { failed, skipped } = await testInBrowsers(browsers);
  if (skipped > 0) throw new Stop(`Not in all browsers:\n${browsers.flatMap(({ problem }) => problem ?? []).join('\n')}`);
  return failed === 0 ? 0 : 1;
});
