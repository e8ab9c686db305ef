// npm test: all tests and all checks; `npm test -- native page` runs the named parts only, and is the way to run those that download much.
//
// Parts of one lane run one after another, because they would wait for each other: for cargo's lock on its folder, for ports, for cores. The
// two lanes run side by side, and what a part writes is shown when it ends. Some page tests measure time, so that cargo takes the cores that
// they leave. A few tests that failed have another try, by themselves, when all else has ended: on a busy machine a page may come too late.

import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { findBrowsers, testInBrowsers } from './lib/browsers.mjs';
import { buildModules, buildPackage, buildPage, buildWheel } from './lib/builds.mjs';
import { runChecks } from './lib/checks.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { OWN, installWheel } from './lib/python-packages.mjs';
import { Stop, command, inLane, say } from './lib/run.mjs';
import { CRATES } from './lib/rust.mjs';
import { buildSite } from './lib/site.mjs';
import { cargo, node, playwright, pytest } from './lib/test-programs.mjs';
import { added, repeated, tests } from './lib/tests.mjs';

const LANES = { cargo: { niceness: 10 }, node: { niceness: 0 } };

const PARTS = {
  native: {
    lane: 'cargo',
    title: 'native tests',
    run: async () => {
      const args = ['test', '--locked', ...CRATES, '--no-fail-fast', '--features', 'codecs,stages'];
      // Examples are compiled by the test that runs them, and checked by clippy: the large ones would take longer than what they show.
      return added(await tests(cargo, 'cargo', [...args, '--lib', '--tests']), await tests(cargo, 'cargo', [...args, '--doc']));
    },
  },
  wasm: {
    lane: 'cargo',
    title: 'WebAssembly tests in Node',
    run: () => tests(cargo, 'wasm-pack', ['test', '--node', '--mode', 'no-install', '--', '--locked', ...CRATES]),
  },
  check: { lane: 'cargo', title: 'checks', run: runChecks },
  python: {
    lane: 'cargo',
    title: 'the Python package',
    run: async ({ ownPython: { problem } }) => {
      if (problem) return { passed: 0, failed: 0, skipped: 1, note: problem };
      await buildModules();
      await buildPackage();
      const wheel = await buildWheel(OWN.python);
      await installWheel(OWN, wheel);
      // What is installed is tested, not the sources beside the tests.
      return tests(pytest, OWN.python, ['-B', '-m', 'pytest', '-p', 'no:cacheprovider', 'python'], { VERONESE_WHEEL: wheel });
    },
  },
  guide: {
    // After the Python package, which it uses as it is installed then, and one at a time with cargo.
    lane: 'cargo',
    title: "the code of the site's guide",
    run: async ({ chromium }) => {
      await buildModules();
      await buildPackage();
      if (chromium.problem) say(chromium.problem);
      return tests(node, process.execPath, ['--test', '--test-reporter=tap', 'site/tests/guide.test.mjs'], chromium.path ? { VERONESE_CHROMIUM: chromium.path } : {});
    },
  },
  package: {
    lane: 'node',
    title: 'package tests',
    run: async () => {
      await buildModules();
      await buildPackage();
      return tests(node, 'npm', ['test', '--silent', '--workspace', 'pkg']);
    },
  },
  formats: {
    lane: 'node',
    title: "formats, read by the annotation tools' own decoders",
    run: async ({ python }) => {
      await buildModules();
      await buildPackage();
      if (python.problem) say(python.problem);
      return tests(node, 'npm', ['run', '--silent', 'test:formats', '--workspace', 'pkg']);
    },
  },
  hosts: {
    lane: 'node',
    title: 'the packed package in its hosts',
    run: async ({ chromium, python }) => {
      await buildModules();
      await buildPackage();
      if (chromium.problem) throw new Stop(chromium.problem);
      if (python.problem) say(python.problem);
      const env = { VERONESE_CHROMIUM: chromium.path };
      return tests(node, 'npm', ['run', 'test:hosts', '--silent', '--workspace', 'pkg'], env);
    },
  },
  page: {
    lane: 'node',
    title: 'page tests in Chromium',
    run: ({ chromium }) => inChromium(chromium, ['test', '--silent', '--workspace', 'www']),
  },
  screens: {
    lane: 'node',
    title: 'screenshots of the page, in out/screens',
    // To be looked at: what they show is tested by the part page.
    onRequest: true,
    run: ({ chromium }) => inChromium(chromium, ['run', 'screens', '--silent', '--workspace', 'www']),
  },
  site: {
    lane: 'node',
    title: 'the site in Chromium',
    run: async ({ chromium }) => {
      if (chromium.problem) throw new Stop(chromium.problem);
      await buildSite();
      const env = { VERONESE_CHROMIUM: chromium.path };
      const scripts = readdirSync(join(root, 'site/tests')).filter((name) => name.endsWith('.test.mjs') && name !== 'guide.test.mjs');
      const inNode = await tests(node, process.execPath, ['--test', '--test-reporter=tap', ...scripts.map((name) => `site/tests/${name}`)], env);
      const inBrowser = await tests(playwright, 'npx', ['--no-install', 'playwright', 'test', '--config', 'site/tests/playwright.config.mjs'], env);
      return added(inNode, inBrowser);
    },
  },
  runtimes: {
    lane: 'node',
    title: 'the packed package in Node 20 to 26, Deno, Bun and workerd',
    // Hundreds of megabytes of runtimes.
    onRequest: true,
    run: async () => {
      await buildModules();
      await buildPackage();
      return tests(node, 'npm', ['run', 'test:runtimes', '--silent', '--workspace', 'pkg']);
    },
  },
  browsers: {
    lane: 'node',
    title: 'the page in the browsers that are installed',
    run: async ({ chromium }) => {
      await buildModules();
      await buildPackage();
      await buildPage();
      return testInBrowsers(await findBrowsers(chromium.path));
    },
  },
};

/** Builds the page and runs a script of npm that drives it. */
async function inChromium(chromium, script) {
  await buildModules();
  await buildPackage();
  await buildPage();
  if (chromium.problem) throw new Stop(chromium.problem);
  return tests(playwright, 'npm', script, { VERONESE_CHROMIUM: chromium.path });
}

await command(async (args) => {
  const unknown = args.filter((name) => !(name in PARTS));
  if (unknown.length > 0) {
    console.error(`There is no part '${unknown[0]}'; there are ${Object.keys(PARTS).join(', ')}.`);
    return 2;
  }
  const names = args.length > 0 ? args : Object.keys(PARTS).filter((name) => !PARTS[name].onRequest);
  const setup = await prepare({
    checks: names.includes('check'),
    browser: ['page', 'screens', 'hosts', 'site', 'browsers', 'guide'].some((name) => names.includes(name)),
    python: ['formats', 'hosts'].some((name) => names.includes(name)),
    ownPython: names.includes('python'),
    hosts: names.includes('hosts'),
    runtimes: names.includes('runtimes'),
  });
  return summarise(await runParts(names, setup));
});

/** Runs parts in their lanes; the results have the order of `names`. */
async function runParts(names, setup) {
  const lanes = Object.entries(LANES).flatMap(([lane, options]) => {
    const own = names.filter((name) => PARTS[name].lane === lane);
    return own.length > 0 ? [{ ...options, own }] : [];
  });
  const results = {};
  const alone = lanes.length === 1;
  await Promise.all(
    lanes.map(async ({ niceness, own }) => {
      for (const name of own) results[name] = alone ? await runPart(PARTS[name], setup) : await runBeside(PARTS[name], setup, niceness);
    }),
  );
  const ended = [];
  for (const name of names) ended.push(await repeated(results[name]));
  return ended;
}

/** Runs a part while others run, and shows what it has written when it ends. */
async function runBeside(part, setup, niceness) {
  console.log(`… ${part.title}: begin`);
  const pieces = [];
  try {
    return await inLane({ write: (piece) => pieces.push(Buffer.from(piece)), niceness }, () => runPart(part, setup));
  } finally {
    process.stdout.write(Buffer.concat(pieces));
    console.log(`… ${part.title}: end`);
  }
}

/** Runs one part; a failure does not stop the parts after it. */
async function runPart({ title, run: runTests }, setup) {
  say(`\n=== ${title} ===`);
  const start = Date.now();
  const outcome = await runTests(setup).catch((error) => {
    if (!(error instanceof Stop)) throw error;
    say(error.message);
    return { passed: 0, failed: 1, skipped: 0, note: error.message };
  });
  return { title, seconds: (Date.now() - start) / 1000, ...outcome };
}

function summarise(results) {
  console.log('\n=== summary ===');
  for (const { title, passed, failed, skipped, seconds, note, failures = [], unsteady = [] } of results) {
    const extra = [skipped > 0 ? `${skipped} skipped` : '', note ?? ''].filter(Boolean);
    const counts = [`${passed} passed`, `${failed} failed`, ...extra].join(', ');
    console.log(`${failed === 0 ? 'passed' : 'FAILED'}  ${title}: ${counts} (${seconds.toFixed(0)} s)`);
    for (const name of failures.slice(0, 10)) console.log(`        failed: ${name}`);
    for (const name of unsteady) console.log(`        failed beside others, passed alone: ${name}`);
  }
  const total = (kind) => results.reduce((sum, result) => sum + result[kind], 0);
  console.log(`\n${total('passed')} passed, ${total('failed')} failed`);
  return total('failed') === 0 ? 0 : 1;
}
