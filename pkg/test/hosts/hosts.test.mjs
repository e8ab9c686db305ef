// The packed package, installed and run where people run it. Every host has to find the same bits as a direct call in Node; packed.test.mjs
// has Node and Vite.

import assert from 'node:assert/strict';
import { copyFileSync, cpSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { hashOf, outcomeOf, serve } from '../packed/browser.mjs';
import { checkOutcome, expected, isWhole } from '../packed/outcome.mjs';
import { app, browser, tarball } from '../packed/installed.mjs';
import { run } from '../packed/packed.mjs';

const here = fileURLToPath(new URL('.', import.meta.url));
const bin = (name) => join(here, 'node_modules', '.bin', name);

describe('webpack 5', () => {
  async function build(options) {
    const { default: webpack } = await import('webpack');
    const stats = await new Promise((resolve, reject) => {
      webpack({ mode: 'production', context: app, ...options }, (error, stats) => (error ? reject(error) : resolve(stats)));
    });
    assert.deepEqual(stats.toJson({ all: false, errors: true, warnings: true }).errors, []);
    const warnings = stats.toJson({ all: false, warnings: true }).warnings.map(({ message }) => message);
    assert.deepEqual(warnings.filter((message) => !/size limit|performance/i.test(message)), []);
  }

  test('build for the browser', async (t) => {
    const path = join(app, 'built-by-webpack');
    await build({ entry: './main.js', output: { path, filename: 'main.js' } });
    copyFileSync(join(app, 'index.html'), join(path, 'index.html'));
    const { address, missing } = await serve(t, path);
    const found = await outcomeOf(t, browser, address);
    checkOutcome(found);
    isWhole(found);
    assert.deepEqual(missing, []);
  });

  test('build for the server, everything bundled as Next does', async () => {
    const path = join(app, 'built-for-server');
    await build({
      entry: './server.js',
      target: 'node22',
      experiments: { outputModule: true },
      output: { path, filename: 'server.mjs', module: true, library: { type: 'module' }, chunkFormat: 'module' },
    });
    const script = `
      const { render, segment } = await import(${JSON.stringify(String(pathToFileURL(join(path, 'server.mjs'))))});
      console.log(render());
      console.log(await segment());`;
    assert.equal(run(process.execPath, ['--input-type=module', '--eval', script], { cwd: here }), `<p>function function</p>\n${expected}\n`);
  });
});

describe('esbuild', () => {
  async function build(options, folder) {
    const { build } = await import('esbuild');
    const outdir = join(app, folder);
    const { errors, warnings } = await build({ absWorkingDir: app, bundle: true, minify: true, format: 'esm', outdir, logLevel: 'silent', ...options });
    assert.deepEqual([errors, warnings], [[], []]);
    writeFileSync(join(outdir, 'index.html'), readFileSync(join(app, 'index.html')));
    return outdir;
  }

  test('veronese/inline in one file, the worker in another', async (t) => {
    const folder = await build({ entryPoints: { main: 'inline.js', worker: 'veronese/worker' } }, 'inline-by-esbuild');
    assert.deepEqual(readdirSync(folder).sort(), ['index.html', 'main.js', 'worker.js']);
    const { address, missing } = await serve(t, folder);
    checkOutcome(await outcomeOf(t, browser, address));
    assert.deepEqual(missing, []);
  });
});

describe('Rollup and Parcel, which copy the worker as it is', () => {
  test('Rollup, with the plugin that copies files', async (t) => {
    const { rollup } = await import('rollup');
    const { default: resolve } = await import('@rollup/plugin-node-resolve');
    const { importMetaAssets } = await import('@web/rollup-plugin-import-meta-assets');
    const bundle = await rollup({ input: join(app, 'main.js'), plugins: [resolve({ browser: true }), importMetaAssets()], onwarn: (warning) => assert.fail(warning.message) });
    t.after(() => bundle.close());
    const dir = join(app, 'built-by-rollup');
    await bundle.write({ dir, format: 'es' });
    copyFileSync(join(app, 'index.html'), join(dir, 'index.html'));
    const { address, missing } = await serve(t, dir);
    const found = await outcomeOf(t, browser, address);
    checkOutcome(found);
    isWhole(found);
    assert.deepEqual(missing, []);
  });

  test('Parcel, told to look at the exports of packages', async (t) => {
    const folder = join(app, 'for-parcel');
    mkdirSync(folder);
    for (const name of ['main.js', 'frames.js', 'measurements.js', 'report.js']) copyFileSync(join(app, name), join(folder, name));
    cpSync(join(app, 'node_modules'), join(folder, 'node_modules'), { recursive: true });
    writeFileSync(join(folder, 'package.json'), '{ "private": true, "type": "module", "@parcel/resolver-default": { "packageExports": true } }\n');
    // Parcel takes the folder with a lock file for the project.
    writeFileSync(join(folder, 'package-lock.json'), '{}\n');
    writeFileSync(join(folder, 'index.html'), readFileSync(join(app, 'index.html'), 'utf8').replace('/main.js', 'main.js'));
    run(bin('parcel'), ['build', 'index.html', '--no-cache'], { cwd: folder });
    const { address, missing } = await serve(t, join(folder, 'dist'));
    const found = await outcomeOf(t, browser, address);
    checkOutcome(found);
    isWhole(found);
    assert.deepEqual(missing, []);
  });
});

describe('without a bundler, under a strict content security policy', () => {
  /** The page, its import map and the policy that allows that map, the page's own files, WebAssembly, and nothing else. */
  async function page(t, script, policy = (map) => `default-src 'none'; script-src 'self' 'wasm-unsafe-eval' ${map}; worker-src 'self'; connect-src 'self'; img-src data:`) {
    const map = JSON.stringify({ imports: { veronese: '/node_modules/veronese/dist/web.js' } });
    writeFileSync(join(app, 'strict.html'), `<!doctype html>
<link rel="icon" href="data:," />
<script type="importmap">${map}</script>
<script type="module" src="/${script}"></script>
`);
    return serve(t, app, { 'Content-Security-Policy': policy(hashOf(map)) });
  }

  test('by an import map: direct, in a worker, in a pool', async (t) => {
    const { address, missing } = await page(t, 'main.js');
    const found = await outcomeOf(t, browser, `${address}strict.html`);
    checkOutcome(found);
    isWhole(found);
    assert.deepEqual(missing, []);
  });

  test('in a Web Worker of the page', async (t) => {
    const { address, missing } = await page(t, 'own-worker.js');
    checkOutcome(await outcomeOf(t, browser, `${address}strict.html`), ['direct']);
    assert.deepEqual(missing, []);
  });

  test('a policy that forbids WebAssembly is an error with a code, not a silence', async (t) => {
    const { address } = await page(t, 'main.js', (map) => `default-src 'none'; script-src 'self' ${map}; worker-src 'self'; connect-src 'self'; img-src data:`);
    const { outcome } = await outcomeOf(t, browser, `${address}strict.html`);
    assert.match(outcome.error, /^wasm-load-failed: .*(Content Security Policy|unsafe-eval)/);
  });
});

describe('the package looked at by others', () => {
  test('publint finds nothing', async () => {
    const { publint } = await import('publint');
    const { formatMessage } = await import('publint/utils');
    const pkgDir = join(app, 'node_modules/veronese');
    const { messages, pkg } = await publint({ pkgDir, pack: false, strict: true, level: 'suggestion' });
    assert.deepEqual(messages.map((message) => formatMessage(message, pkg)), []);
  });

  test('Are The Types Wrong? finds nothing: it ends with an error if it does', () => {
    // The module's file is for bundlers to copy; there is nothing in it that types could describe.
    const text = run(bin('attw'), [tarball, '--exclude-entrypoints', './veronese_bg.wasm', './veronese_points_bg.wasm', '--profile', 'esm-only', '--format', 'ascii', '--no-emoji', '--no-color']);
    for (const entry of ['veronese', 'veronese/slim', 'veronese/worker', 'veronese/codecs']) assert.ok(text.includes(`"${entry}"`), entry);
  });

  for (const [module, moduleResolution] of [['NodeNext', 'NodeNext'], ['ESNext', 'Bundler']]) {
    test(`strict TypeScript compiles against it, resolving as ${moduleResolution} does`, () => {
      const folder = join(app, `types-${moduleResolution}`);
      mkdirSync(folder);
      copyFileSync(join(here, '../types/sample.ts'), join(folder, 'sample.ts'));
      const options = { strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, noEmit: true, target: 'ES2022', lib: ['ES2022', 'DOM', 'DOM.Iterable'], types: [], module, moduleResolution };
      writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions: options, include: ['.'] }));
      run(bin('tsc'), ['-p', folder]);
    });
  }
});
