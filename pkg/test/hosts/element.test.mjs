// The element bundled by esbuild, which copies no files of the package: in one script with all inside, or with files that the page names.

import assert from 'node:assert/strict';
import { cpSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { build } from 'esbuild';
import { outcomeOf, serve } from '../packed/browser.mjs';
import { app, browser } from '../packed/installed.mjs';

/** The outcome of a page with this script, and what the page asked for besides. */
async function page(t, name, script) {
  const folder = join(app, name);
  const source = join(app, `${name}.js`);
  writeFileSync(source, `import { first, second } from './frames.js';\n${script}
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    element.addEventListener('result', () => (element.frames = [first, second]));
    element.addEventListener('tracks', ({ detail }) => (globalThis.outcome = { width: element.clip.width, objects: detail.objects.length }));
    element.addEventListener('error', ({ detail: { code, message } }) => (globalThis.outcome = { error: code + ': ' + message }));
    document.body.append(element);
    element.setFrames(first, second).catch(() => undefined);`);
  await build({ entryPoints: { script: source }, outdir: folder, bundle: true, format: 'esm', logLevel: 'error' });
  await build({ entryPoints: { worker: join(app, 'node_modules/veronese/dist/worker.js') }, outdir: folder, bundle: true, format: 'esm', logLevel: 'error' });
  cpSync(join(app, 'node_modules/veronese/wasm/veronese_bg.wasm'), join(folder, 'core.wasm'));
  writeFileSync(join(folder, 'index.html'), '<!doctype html>\n<link rel="icon" href="data:," />\n<body><script type="module" src="/script.js"></script></body>\n');
  const { address, missing } = await serve(t, folder);
  const { outcome } = await outcomeOf(t, browser, address);
  return { outcome, missing, address };
}

test('veronese/element/inline is one script with everything inside', async (t) => {
  const { outcome, missing } = await page(t, 'inline', "import 'veronese/element/inline';");
  assert.deepEqual([outcome, missing], [{ width: 64, objects: 1 }, []]);
});

test('the page names the worker and the module', async (t) => {
  const script = `import { VeroneseSegmenterElement } from 'veronese/element';
    VeroneseSegmenterElement.worker = () => new Worker('/worker.js', { type: 'module' });
    VeroneseSegmenterElement.source = '/core.wasm';`;
  const { outcome, missing } = await page(t, 'named', script);
  assert.deepEqual([outcome, missing], [{ width: 64, objects: 1 }, []]);
});

test('an error of loading names the address, the status and the remedy', async (t) => {
  const script = (source, worker) => `import { VeroneseSegmenterElement } from 'veronese/element';
    VeroneseSegmenterElement.worker = () => new Worker('${worker}', { type: 'module' });
    VeroneseSegmenterElement.source = '${source}';`;
  const module = await page(t, 'no-module', script('/nowhere.wasm', '/worker.js'));
  const { error } = module.outcome;
  assert.ok(error.startsWith(`wasm-load-failed: the WebAssembly module cannot be loaded: ${module.address}nowhere.wasm answered 404 Not Found; `), error);
  assert.match(error, /init\(\).*of the element: source, veronese\/element\/inline/);
  const elsewhere = await page(t, 'no-server', script('http://127.0.0.1:1/core.wasm', '/worker.js'));
  assert.match(elsewhere.outcome.error, /^wasm-load-failed: .*: http:\/\/127\.0\.0\.1:1\/core\.wasm cannot be reached .*; .*init\(\)/);
  const worker = await page(t, 'no-worker', script('/core.wasm', '/nowhere.js'));
  assert.match(worker.outcome.error, /^worker-failed: .*file could not be loaded; .*'worker'.*of the element: worker, veronese\/element\/inline/);
  const unbundled = await page(t, 'unbundled', "import 'veronese/element';");
  assert.match(unbundled.outcome.error, /^(worker|wasm-load)-failed: .*veronese\/element\/inline/);
});
