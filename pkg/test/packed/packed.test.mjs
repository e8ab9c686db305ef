// The packed package, installed into an empty project: run in Node, and bundled by Vite and run in Chromium. What other bundlers and
// frameworks make of it is in hosts, for npm run soak.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { build, createServer } from 'vite';
import { outcomeOf, serve } from './browser.mjs';
import { checkOutcome, expected, isWhole } from './outcome.mjs';
import { random } from '../../../scripts/lib/random.mjs';
import { app, browser } from './installed.mjs';
import { run } from './packed.mjs';

describe('plain Node', () => {
  test('imports the installed package and runs it', () => {
    checkOutcome({ outcome: JSON.parse(run(process.execPath, ['plain.mjs'], { cwd: app })), complaints: [] });
  });

  test('runs the installed program', () => {
    assert.match(run('npx', ['--no-install', 'veronese', '--version'], { cwd: app }), /^veronese \d+\.\d+\.\d+\n$/);
  });

  test('reaches the module file and the manifest by their names', () => {
    const script = `
      const { readFileSync } = await import('node:fs');
      const compiled = (name) => WebAssembly.compile(readFileSync(new URL(import.meta.resolve(name))));
      for (const name of ['veronese/veronese_bg.wasm', 'veronese/veronese_points_bg.wasm']) await compiled(name);
      console.log(true, import.meta.resolve('veronese/package.json').length > 0);`;
    assert.equal(run(process.execPath, ['--input-type=module', '--eval', script], { cwd: app }), 'true true\n');
  });

  test('every entry of package.json that is JavaScript can be imported, on a server too', () => {
    const { exports } = JSON.parse(readFileSync(join(app, 'node_modules/veronese/package.json')));
    const entries = Object.keys(exports).filter((name) => !/\.(wasm|json)$/.test(name) && !['./worker', './react'].includes(name)); // React is not installed here
    assert.ok(entries.length >= 4);
    const script = `for (const name of ${JSON.stringify(entries.map((entry) => join('veronese', entry)))}) await import(name);`;
    run(process.execPath, ['--input-type=module', '--eval', script], { cwd: app });
  });
});

test('no bundler: pictures of the browser are segmented as their pixels', async (t) => {
  const { address } = await serve(t, app);
  const { outcome, complaints } = await outcomeOf(t, browser, `${address}pictures.html`);
  assert.deepEqual([outcome.error, outcome.differ, complaints], [undefined, [], []]);
  assert.deepEqual(outcome.errors.slice(0, -2), [
    'invalid-input: the second frame is an ImageBitmap that is closed, or was given to another thread',
    'invalid-input: the second frame is a VideoFrame that is closed',
    'invalid-input: the second frame is a canvas without pixels',
    ...Array(2).fill('unreadable-image: the second frame is not an image that this browser can read'),
  ]);
  const [pretended, number] = outcome.errors.slice(-2);
  assert.match(pretended, /^invalid-input: the second frame is no picture: /);
  assert.match(number, /^invalid-input: the second frame must be .* in browsers an ImageBitmap, VideoFrame, Blob, image or canvas, /);
});

test('no bundler: a clip whose page is closed at any moment has all that was settled when it is opened again', async (t) => {
  const { address } = await serve(t, app);
  const context = await browser.newContext();
  t.after(() => context.close());
  const straight = await outcomeOf(t, browser, `${address}journal.html`);
  assert.deepEqual([straight.outcome.error, straight.complaints], [undefined, []]);
  const next = random(3);
  let settled = 0;
  for (let run = 0; run < 12 && settled < 9; run++) {
    const page = await context.newPage();
    await page.goto(`${address}journal.html?journal=drive`);
    await page.waitForFunction(() => globalThis.begun !== undefined);
    const begun = await page.evaluate(() => globalThis.begun);
    // More may have been settled before the page was gone.
    assert.ok(begun >= settled && begun <= 9, `${settled} steps were settled, ${begun} are there`);
    const wanted = Math.min(9, begun + Math.floor(3 * next()));
    await page.waitForFunction((wanted) => globalThis.settled >= wanted, wanted);
    settled = await page.evaluate(() => globalThis.settled);
    await page.close();
  }
  assert.equal(settled, 9);
  const { outcome } = await outcomeOf(t, context, `${address}journal.html?journal=drive`);
  assert.match(outcome.second, /another clip has 'drive' open/);
  assert.deepEqual([outcome.error, outcome.damaged, outcome.labels === straight.outcome.labels], [undefined, false, true]);
});

describe('Vite 8', () => {
  const quiet = { logLevel: 'error', configFile: false, clearScreen: false };

  test('development server', async (t) => {
    const server = await createServer({ ...quiet, root: app, server: { host: '127.0.0.1', port: 0, hmr: false, watch: null } });
    t.after(() => server.close());
    await server.listen();
    const found = await outcomeOf(t, browser, `http://127.0.0.1:${server.httpServer.address().port}/`);
    checkOutcome(found);
    isWhole(found);
  });

  test('build', async (t) => {
    await build({ ...quiet, root: app, build: { outDir: 'built-by-vite', emptyOutDir: true } });
    const files = readdirSync(join(app, 'built-by-vite/assets'));
    const modules = files.filter((name) => name.endsWith('.wasm')).map((name) => name.replace(/_bg.*/, ''));
    assert.deepEqual(modules.sort(), ['veronese', 'veronese_points'], 'each module once, whoever loads it');
    const { address, missing } = await serve(t, join(app, 'built-by-vite'));
    const found = await outcomeOf(t, browser, address);
    checkOutcome(found);
    isWhole(found);
    assert.deepEqual(missing, []);
  });

  test('import on the server', async (t) => {
    const server = await createServer({ ...quiet, root: app, appType: 'custom', server: { middlewareMode: true, hmr: false, watch: null, ws: false } });
    t.after(() => server.close());
    const module = await server.ssrLoadModule('/server.js');
    assert.equal(module.render(), '<p>function function</p>');
    assert.equal(await module.segment(), expected);
  });
});
