// The browsers in which the page is driven by WebDriver, and the programs that drive them.

import { existsSync, readdirSync } from 'node:fs';
import { join } from 'node:path';

import { installDebianPackages } from './debian.mjs';
import { which } from './project.mjs';
import { Stop, say } from './run.mjs';
import { prepareGeckodriver } from './rust.mjs';
import { buildSite } from './site.mjs';
import { playwright } from './test-programs.mjs';
import { added, tests } from './tests.mjs';

/** Each looks for its programs anew and returns what is missing, or how the browser is driven. */
const BROWSERS = [
  {
    name: 'Chromium',
    packages: ['chromium', 'chromium-driver'],
    find: (chromium) =>
      found({ 'Chromium or Chrome': chromium, chromedriver: which('chromedriver') }, ([program, driver]) => ({
        driver: [driver],
        program,
      })),
  },
  {
    name: 'Firefox',
    packages: ['firefox-esr'],
    find: () =>
      found({ Firefox: firstOf('firefox-esr', 'firefox'), geckodriver: which('geckodriver') }, ([program, driver]) => ({
        driver: [driver],
        program,
      })),
  },
  {
    name: 'WebKit',
    packages: ['webkit2gtk-driver', 'xvfb', 'xauth'],
    // It has no mode without a screen: without one it gets a virtual one.
    find: () => {
      const screen = process.env.DISPLAY || process.env.WAYLAND_DISPLAY ? {} : { 'xvfb-run': which('xvfb-run') };
      return found({ MiniBrowser: miniBrowser(), WebKitWebDriver: which('WebKitWebDriver'), ...screen }, ([program, driver, xvfb]) => ({
        driver: xvfb === undefined ? [driver] : [xvfb, '--auto-servernum', driver],
        program,
      }));
    },
  },
];

/**
 * The browsers: `{ name, program, driver }` with the command line of the driver, or `{ name, problem }` with a sentence.
 * `install` installs what is missing, where that needs no confirmation.
 */
export async function findBrowsers(chromium, { install = false } = {}) {
  if (install) await installMissing(chromium);
  return BROWSERS.map(({ name, packages, find }) => {
    const { missing, ...way } = find(chromium);
    if (!missing) return { name, ...way };
    const gecko = missing.includes('geckodriver') ? '; geckodriver: `cargo install geckodriver --locked`' : '';
    return {
      name,
      problem: `${name} is not driven, because there is no ${missing.join(' and no ')} (Debian: \`apt-get install ${packages.join(' ')}\`${gecko}).`,
    };
  });
}

async function installMissing(chromium) {
  const lacking = BROWSERS.filter(({ find }) => find(chromium).missing);
  const packages = lacking
    .filter(({ find }) => find(chromium).missing.some((program) => program !== 'geckodriver'))
    .flatMap(({ packages }) => packages);
  if (packages.length > 0) await installDebianPackages(packages, 'browsers and their drivers');
  // Debian has no package of it.
  if (firstOf('firefox-esr', 'firefox') && !which('geckodriver')) {
    await prepareGeckodriver().catch((error) => {
      if (!(error instanceof Stop)) throw error;
      console.error(error.message);
    });
  }
}

/** The way to drive these programs, or the names of those that are missing. */
function found(programs, way) {
  const missing = Object.keys(programs).filter((name) => !programs[name]);
  return missing.length > 0 ? { missing } : way(Object.values(programs));
}

function firstOf(...names) {
  return names.map(which).find(Boolean);
}

/** WebKitGTK's own small browser, which is not on the path. */
function miniBrowser() {
  if (!existsSync('/usr/lib')) return undefined;
  const folders = ['/usr/libexec', '/usr/lib', ...readdirSync('/usr/lib').map((name) => join('/usr/lib', name))];
  return folders.map((folder) => join(folder, 'webkit2gtk-4.1', 'MiniBrowser')).find(existsSync);
}

/** Drives the built page and the explainer in each of the browsers; those that have a problem are skipped with a message. */
export async function testInBrowsers(browsers) {
  const problems = browsers.flatMap(({ problem }) => problem ?? []);
  for (const problem of problems) say(problem);
  if (problems.length === browsers.length) return { passed: 0, failed: 0, skipped: problems.length };
  const env = { VERONESE_BROWSERS: JSON.stringify(browsers) };
  await buildSite();
  const page = await tests(playwright, 'npm', ['run', '--silent', 'test:browsers', '--workspace', 'www'], env);
  const explainer = await tests(
    playwright,
    'npx',
    ['--no-install', 'playwright', 'test', '--config', 'site/tests/playwright.browsers.config.mjs'],
    env,
  );
  return added(page, explainer);
}
