// The parts of the tests. DAILY is what `npm test` runs: what users rely on, once. RARE is for `npm run soak`: what downloads much, needs
// other programs, or looks at the same things in many more ways.
//
// Of each part: a title, what set-up has to prepare for it, and `run`, which returns counts as those of tests.mjs. Of daily ones also the lane,
// `inputs`, what a part depends on (unchanged.mjs), and the `budget`: seconds of processor when everything is new, 15 % more than two cores of
// a Xeon took. Parts with `named` can run those tests alone whose file or name has `word`; `stressed` has the ways in which stress.mjs runs
// them.

import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import { findBrowsers, testInBrowsers } from './browsers.mjs';
import { MODULES, buildModules, buildPackage, buildPage, buildTestWheel, buildWheel, testOfModules } from './builds.mjs';
import { runChecks, runLints, runRareChecks } from './checks.mjs';
import { root } from './project.mjs';
import { OWN, installWheel } from './python-packages.mjs';
import { Stop, must, say } from './run.mjs';
import { buildSite } from './site.mjs';
import { stressed } from './stress.mjs';
import { cargo, node, playwright, pytest } from './test-programs.mjs';
import { NOTHING, added, tests } from './tests.mjs';
import { testWithWasmPack } from './wasm-pack.mjs';

/**
 * The crates that have native tests, and that of the Python package, which has none: named beside them, it asks for the same features of
 * other packages, so that the tests and its wheel share what is compiled.
 */
const CRATES = ['veronese', 'scenes', 'experiments', 'veronese-site', 'veronese-python'].flatMap((name) => ['--package', name]);
const NATIVE = ['test', '--locked', '--no-fail-fast', '--features', 'codecs', ...CRATES];
const SOAK = { VERONESE_SOAK: '1' };

/** What nothing but their own checks depends on. */
const NOTES = [
  'ARCHITECTURE.md',
  'CODE_OF_CONDUCT.md',
  'CONTRIBUTING.md',
  'SECURITY.md',
  'VERSIONING.md',
  '.github',
  'cspell.json',
  'deny.toml',
  'fuzz',
  'benches',
  'docs/figures',
  'docs/images',
];
/** The sources of the modules: what depends on the modules depends on the built ones. */
const CRATES_OF_MODULES = [
  'src',
  'wasm',
  'scenes',
  'experiments',
  'Cargo.toml',
  'Cargo.lock',
  '.cargo',
  'clippy.toml',
  'rustfmt.toml',
  'scripts/wasm-tools',
];
const BUILT = [...MODULES.map(({ folder, name }) => `${folder}/${name}_bg.wasm`), 'pkg/THIRD-PARTY-NOTICES'];
const PAGE = ['www/src', 'www/tests', 'www/browsers', 'www/screens', 'www/index.html'];
/** The site without its crate. */
const SITE = ['client', 'data', 'layouts', 'pages', 'styles', 'tests', 'eleventy.config.mjs', 'package.json', 'package-lock.json'].map(
  (name) => `site/${name}`,
);
const PACKAGE = ['pkg/src', 'pkg/test', 'pkg/types', 'pkg/scripts', 'pkg/bin', 'pkg/schemas'];

/**
 * Parts of one lane run one after another, because they would wait for each other: for cargo's lock, for ports, for cores. What is for `either`
 * fills the lane that is ready first.
 */
export const DAILY = {
  compile: {
    lane: 'cargo',
    title: 'compiling the native tests',
    budget: 230,
    run: async () => {
      await must('The native tests could not be compiled.', 'cargo', [...NATIVE, '--tests', '--no-run']);
      return NOTHING;
    },
  },
  native: {
    lane: 'cargo',
    title: 'native tests',
    named: true,
    budget: 150,
    inputs: { apart: [...NOTES, ...PAGE, ...PACKAGE, ...SITE, 'docs', 'python/tests', 'python/package'] },
    // The names of these tests begin with their files, as modules or paths.
    run: async ({ word }) => {
      const own = word === undefined ? [] : ['--', word];
      return added(
        await tests(cargo, 'cargo', [...NATIVE, '--tests', ...own], {}, word),
        await tests(cargo, 'cargo', [...NATIVE, '--doc', ...own], {}, word),
      );
    },
  },
  wasm: {
    lane: 'cargo',
    title: 'the algebra in WebAssembly, under Node',
    named: true,
    budget: 12,
    inputs: { apart: [...NOTES, ...PAGE, ...PACKAGE, 'site', 'docs', 'examples', 'experiments', 'python'] },
    // Its library is that of the modules, compiled once.
    run: async ({ word }) => {
      await buildModules();
      const { args, env } = testOfModules('algebra');
      const own = word === undefined || 'algebra'.includes(word) ? [] : ['--', word];
      return tests(cargo, 'cargo', [...args, ...own], env, word);
    },
  },
  python: {
    lane: 'cargo',
    title: 'the Python package',
    named: true,
    needs: { ownPython: true },
    budget: 92,
    inputs: { build: buildPackage, apart: [...NOTES, ...PAGE, 'pkg/test', 'experiments'] },
    run: async (setup) => added(await ofPython('python', setup, buildTestWheel), await ofStart(setup, ['start-python'])),
    stressed: { busy: (setup) => ofPython('python', setup, buildTestWheel) },
  },
  clippy: {
    lane: 'cargo',
    title: 'lints of Rust',
    needs: { checks: true },
    budget: 60,
    inputs: { apart: [...NOTES, ...PAGE, ...PACKAGE, ...SITE, 'docs'] },
    run: runLints,
  },
  builds: {
    lane: 'node',
    title: 'the modules, the package and the page',
    budget: 56,
    run: async () => {
      await buildPage();
      return NOTHING;
    },
  },
  package: {
    lane: 'node',
    title: 'package tests',
    named: true,
    budget: 140,
    inputs: { build: buildPackage, built: BUILT, apart: [...NOTES, ...CRATES_OF_MODULES, ...PAGE, 'site', 'python'] },
    run: ({ word }) => ofPackage('test', {}, word),
    stressed: { busy: ({ word }) => ofPackage('test', {}, word, ['--test-concurrency=1']) },
  },
  packed: {
    lane: 'node',
    title: 'the packed package, in Node and with Vite',
    named: true,
    needs: { browser: true },
    budget: 22,
    inputs: { build: buildPackage, built: BUILT, apart: [...NOTES, ...CRATES_OF_MODULES, ...PAGE, 'tests', 'python'] },
    run: (setup) =>
      withInstalled(async (env) => {
        const packed = await ofPackage('test:packed', { ...inBrowser(setup), ...env }, setup.word);
        return added(packed, await ofStart(setup, ['start', 'start-typescript', 'start-page'], env));
      }),
  },
  page: {
    lane: 'node',
    title: 'page tests in Chromium',
    named: true,
    needs: { browser: true },
    budget: 585,
    inputs: { build: buildPage, built: BUILT, apart: [...NOTES, ...CRATES_OF_MODULES, 'pkg/test', 'tests', 'site', 'python', 'docs'] },
    // Playwright looks for it in files and names alike.
    run: (setup) => ofPage('test', setup, {}, named(setup.word)),
    stressed: {
      busy: (setup) => ofPage('test', setup, {}, ['--workers=1', ...named(setup.word)]),
      'slow-page': (setup) => ofPage('test', setup, { VERONESE_STRESS: 'slow-page' }, named(setup.word)),
      'slow-test': (setup) => ofPage('test', setup, { VERONESE_STRESS: 'slow-test' }, named(setup.word)),
    },
  },
  check: {
    lane: 'either',
    title: 'checks',
    budget: 30,
    // They ask the types of the package too.
    inputs: { build: buildPackage, apart: [] },
    run: runChecks,
  },
};

export const RARE = {
  native: {
    title: 'native tests that take long',
    run: async () =>
      added(
        await tests(cargo, 'cargo', [...NATIVE, '--tests', '--', '--ignored']),
        await tests(cargo, 'cargo', [...NATIVE, '--test', 'all', 'properties::'], { PROPTEST_CASES: '200000' }),
      ),
  },
  check: { title: 'the crates with each set of features', needs: { checks: true }, run: runRareChecks },
  package: { title: 'package tests, whole sweeps', run: () => ofPackage('test', SOAK) },
  page: {
    title: 'page tests that take long',
    needs: { browser: true },
    run: (setup) => ofPage('test', setup, SOAK, ['--grep', '@soak|same-bits']),
  },
  screens: { title: 'screenshots of the page, in out/screens', needs: { browser: true }, run: (setup) => ofPage('screens', setup) },
  python: {
    title: 'the wheel as it is published',
    needs: { ownPython: true },
    run: (setup) => ofPython('python/tests/test_wheel.py', setup, buildWheel, { VERONESE_PUBLISHED: '1' }),
  },
  formats: {
    title: "formats, read by the annotation tools' own decoders",
    needs: { python: true, fiftyone: true },
    run: ({ python, fiftyone }) => {
      for (const { problem } of [python, fiftyone]) if (problem) throw new Stop(problem);
      return ofPackage('test:formats');
    },
  },
  hosts: {
    title: 'the packed package in its hosts',
    needs: { browser: true, python: true, hosts: true },
    run: (setup) => withInstalled((env) => ofPackage('test:hosts', { ...inBrowser(setup), ...env })),
  },
  runtimes: {
    title: 'the packed package in Node 22 to 26, Deno, Bun and workerd',
    needs: { runtimes: true },
    run: () => ofPackage('test:runtimes'),
  },
  browsers: {
    title: 'the page in Chromium, Firefox and WebKit',
    needs: { browser: true },
    run: async ({ chromium }) => {
      const browsers = await findBrowsers(chromium.path, { install: true });
      await buildPage();
      return testInBrowsers(browsers);
    },
  },
  site: {
    title: 'the site in Chromium',
    needs: { browser: true },
    run: async (setup) => {
      const env = inBrowser(setup);
      await buildSite();
      const scripts = readdirSync(join(root, 'site/tests')).filter((name) => name.endsWith('.test.mjs') && name !== 'guide.test.mjs');
      const inNode = await tests(
        node,
        process.execPath,
        ['--test', '--test-reporter=tap', ...scripts.map((name) => `site/tests/${name}`)],
        env,
      );
      return added(
        inNode,
        await tests(playwright, 'npx', ['--no-install', 'playwright', 'test', '--config', 'site/tests/playwright.config.mjs'], env),
      );
    },
  },
  guide: {
    title: "the code of the site's guide",
    needs: { browser: true, ownPython: true, hosts: true },
    run: async (setup) => {
      const env = inBrowser(setup);
      await buildPackage();
      if (setup.ownPython.problem) say(setup.ownPython.problem);
      else await installWheel(OWN, await buildTestWheel(OWN.python));
      return ofGuide(env);
    },
  },
  stress: {
    title: 'tests on a busy or slow machine',
    needs: { browser: true, ownPython: true },
    run: (setup) => stressed(Object.values(DAILY), setup, 1),
  },
  'wasm-pack': { title: 'the modules, as wasm-pack makes and tests them', run: testWithWasmPack },
  release: {
    title: 'a rehearsal of a release',
    run: async () => {
      await must('A release would fail.', process.execPath, ['scripts/release.mjs', '--dry-run']);
      return { passed: 1, failed: 0, skipped: 0, failures: [] };
    },
  },
};

/** The needs of these parts, for prepare.mjs. */
export function needsOf(parts) {
  return Object.assign({}, ...parts.map(({ needs }) => needs));
}

/** Runs a script of the package; with a word the tests whose file or name has it. */
async function ofPackage(script, env = {}, word, own = []) {
  await buildPackage();
  if (word === undefined && own.length === 0) return tests(node, 'npm', ['run', script, '--silent', '--workspace', 'pkg'], env);
  const folders = script === 'test' ? ['pkg/test', 'pkg/test/scripts'] : [`pkg/test/${script.split(':')[1]}`];
  const files = folders.flatMap((folder) =>
    readdirSync(join(root, folder))
      .filter((name) => name.endsWith('.test.mjs'))
      .map((name) => `${folder}/${name}`),
  );
  const isNamed = (file) => basename(file, '.test.mjs').includes(word);
  const run = (own, ...options) =>
    own.length === 0 ? NOTHING : tests(node, process.execPath, ['--test', '--test-reporter=tap', ...options, ...own], env, word);
  return added(
    await run(files.filter(isNamed)),
    await run(
      files.filter((file) => !isNamed(file)),
      `--test-name-pattern=${literal(word)}`,
    ),
  );
}

/** Playwright's arguments for the tests whose file or name has the word. */
function named(word) {
  return word === undefined ? [] : ['--pass-with-no-tests', '--grep', literal(word)];
}

/** A regular expression for a text as it is. */
function literal(text) {
  return text.replace(/[.*+?^${}()|[\]\\/]/g, '\\$&');
}

/** Runs a script of the page. */
async function ofPage(script, setup, env = {}, args = []) {
  const browser = inBrowser(setup);
  await buildPage();
  return tests(playwright, 'npm', ['run', script, '--silent', '--workspace', 'www', '--', ...args], { ...browser, ...env }, setup.word);
}

/** Runs tests of the Python package: what is installed is tested, not the sources beside the tests. */
async function ofPython(place, { ownPython: { problem }, word }, build, env = {}) {
  if (problem) return { passed: 0, failed: 0, skipped: 1, failures: [], note: problem };
  await buildPackage();
  const wheel = await build(OWN.python);
  await installWheel(OWN, wheel);
  const own = word === undefined ? [] : ['-k', word];
  return tests(
    pytest,
    OWN.python,
    ['-B', '-m', 'pytest', '-p', 'no:cacheprovider', ...own, place],
    { ...env, VERONESE_WHEEL: wheel },
    word,
  );
}

function ofGuide(env) {
  return tests(node, process.execPath, ['--test', '--test-reporter=tap', 'site/tests/guide.test.mjs'], env);
}

/** The pages of the guide that are read first. */
async function ofStart({ chromium, word }, pages, env = {}) {
  if (word !== undefined && !pages.some((page) => page.includes(word))) return NOTHING;
  return ofGuide({ ...env, ...(chromium && inBrowser({ chromium })), VERONESE_GUIDE_PAGES: pages.join() });
}

/** Tests that share one installed package, whichever process comes first installs it. */
async function withInstalled(run) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-installed-'));
  try {
    return await run({ VERONESE_INSTALLED: folder });
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

function inBrowser({ chromium }) {
  if (chromium.problem) throw new Stop(chromium.problem);
  return { VERONESE_CHROMIUM: chromium.path };
}
