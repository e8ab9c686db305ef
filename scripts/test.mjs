// npm test: all tests and all checks; `npm test -- native page` runs the named parts only.

import { findBrowsers, testInBrowsers } from './lib/browsers.mjs';
import { buildModules, buildPackage, buildPage } from './lib/builds.mjs';
import { runChecks } from './lib/checks.mjs';
import { cargoCounts, nodeCounts, playwrightCounts } from './lib/counts.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command } from './lib/run.mjs';
import { tests } from './lib/tests.mjs';

const PARTS = {
  check: { title: 'checks', run: runChecks },
  native: {
    title: 'native tests',
    run: () => tests(cargoCounts, 'cargo', ['test', '--locked', '--no-fail-fast', '--features', 'codecs']),
  },
  wasm: {
    title: 'WebAssembly tests in Node',
    run: () => tests(cargoCounts, 'wasm-pack', ['test', '--node', '--mode', 'no-install', '--', '--locked']),
  },
  package: {
    title: 'package tests',
    run: async () => {
      await buildModules();
      await buildPackage();
      return tests(nodeCounts, 'npm', ['test', '--silent', '--workspace', 'pkg']);
    },
  },
  formats: {
    title: "formats, read by the annotation tools' own decoders",
    run: async ({ python }) => {
      await buildModules();
      await buildPackage();
      if (python.problem) console.log(python.problem);
      return tests(nodeCounts, 'npm', ['run', '--silent', 'test:formats', '--workspace', 'pkg']);
    },
  },
  hosts: {
    title: 'the packed package in its hosts',
    run: async ({ chromium }) => {
      await buildModules();
      await buildPackage();
      if (chromium.problem) throw new Stop(chromium.problem);
      const env = { VERONESE_CHROMIUM: chromium.path };
      return tests(nodeCounts, 'npm', ['run', 'test:hosts', '--silent', '--workspace', 'pkg'], env);
    },
  },
  page: {
    title: 'page tests in Chromium',
    run: async ({ chromium }) => {
      await buildModules();
      await buildPackage();
      await buildPage();
      if (chromium.problem) throw new Stop(chromium.problem);
      const env = { VERONESE_CHROMIUM: chromium.path };
      return tests(playwrightCounts, 'npm', ['test', '--silent', '--workspace', 'www'], env);
    },
  },
  browsers: {
    title: 'the page in the browsers that are installed',
    run: async ({ chromium }) => {
      await buildModules();
      await buildPackage();
      await buildPage();
      return testInBrowsers(await findBrowsers(chromium.path));
    },
  },
};

await command(async (args) => {
  const unknown = args.filter((name) => !(name in PARTS));
  if (unknown.length > 0) {
    console.error(`There is no part '${unknown[0]}'; there are ${Object.keys(PARTS).join(', ')}.`);
    return 2;
  }
  const names = args.length > 0 ? args : Object.keys(PARTS);
  const setup = await prepare({
    checks: names.includes('check'),
    browser: ['page', 'hosts', 'browsers'].some((name) => names.includes(name)),
    python: names.includes('formats'),
    hosts: names.includes('hosts'),
  });
  const results = [];
  for (const name of names) results.push(await runPart(PARTS[name], setup));
  return summarise(results);
});

/** Runs one part; a failure does not stop the parts after it. */
async function runPart({ title, run: runTests }, setup) {
  console.log(`\n=== ${title} ===`);
  const start = Date.now();
  const outcome = await runTests(setup).catch((error) => {
    if (!(error instanceof Stop)) throw error;
    console.error(error.message);
    return { passed: 0, failed: 1, skipped: 0, note: error.message };
  });
  return { title, seconds: (Date.now() - start) / 1000, ...outcome };
}

function summarise(results) {
  console.log('\n=== summary ===');
  for (const { title, passed, failed, skipped, seconds, note } of results) {
    const extra = [skipped > 0 ? `${skipped} skipped` : '', note ?? ''].filter(Boolean);
    const counts = [`${passed} passed`, `${failed} failed`, ...extra].join(', ');
    console.log(`${failed === 0 ? 'passed' : 'FAILED'}  ${title}: ${counts} (${seconds.toFixed(0)} s)`);
  }
  const total = (kind) => results.reduce((sum, result) => sum + result[kind], 0);
  console.log(`\n${total('passed')} passed, ${total('failed')} failed`);
  return total('failed') === 0 ? 0 : 1;
}
