// The element in frameworks: their types know it, and the examples for Vue and Svelte are built and run.

import assert from 'node:assert/strict';
import { cpSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openClip, segmentPair } from 'veronese';
import { frame, pair, png } from '../support/frames.mjs';
import { outcomeOf, serve } from '../packed/browser.mjs';
import { app, browser } from '../packed/installed.mjs';
import { run } from '../packed/packed.mjs';

const here = fileURLToPath(new URL('.', import.meta.url));
// The project's, which is much faster than the one beside this file.
const tsc = fileURLToPath(new URL('../../../node_modules/.bin/tsc', import.meta.url));
const clip = Array.from({ length: 4 }, (_, k) => frame(k / 2));

/** A folder with the installed package, and others beside it as npm installs them. */
function folderWith(name, packages) {
  const folder = join(app, name);
  cpSync(join(app, 'node_modules/veronese'), join(folder, 'node_modules/veronese'), { recursive: true });
  for (const one of packages) {
    const link = join(folder, 'node_modules', one);
    mkdirSync(dirname(link), { recursive: true });
    symlinkSync(join(here, 'node_modules', one), link);
  }
  return folder;
}

const TYPES = {
  react: { packages: ['@types/react'], jsxImportSource: 'react', jsx: 'react-jsx' },
  preact: { packages: ['preact'], jsxImportSource: 'preact', jsx: 'react-jsx' },
  solid: { packages: ['solid-js'], jsxImportSource: 'solid-js', jsx: 'preserve' },
};

/** The sample of each; in Preact the same as in React, but for three names. */
function sampleOf(name) {
  const read = (file) => readFileSync(join(here, 'markup', file), 'utf8');
  if (name !== 'preact') return read(`${name}.tsx`);
  return read('react.tsx').replace("from 'react'", "from 'preact/hooks'").replace('veronese/react', 'veronese/preact').replace('className', 'class');
}

describe('types', () => {
  for (const [name, { packages, ...options }] of Object.entries(TYPES)) {
    test(`${name}: the element's attributes, properties and events, and none that it has not`, () => {
      const folder = folderWith(`types-${name}`, packages);
      writeFileSync(join(folder, 'sample.tsx'), sampleOf(name));
      if (name === 'react') cpSync(join(here, 'markup/react-component.tsx'), join(folder, 'component.tsx'));
      const strict = { strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, noEmit: true, skipLibCheck: false };
      const compilerOptions = { ...strict, target: 'ES2022', lib: ['ES2022', 'DOM', 'DOM.Iterable'], types: [], module: 'ESNext', moduleResolution: 'Bundler', ...options };
      writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions, include: ['*.tsx'] }));
      run(tsc, ['-p', folder]);
    });
  }

  test('custom-elements.json is what its schema says', () => {
    const folder = folderWith('types-manifest', ['custom-elements-manifest']);
    const text = readFileSync(join(app, 'node_modules/veronese/custom-elements.json'), 'utf8');
    writeFileSync(join(folder, 'sample.ts'), `import type { Package } from 'custom-elements-manifest/schema.js';\nexport const manifest: Package = ${text};\n`);
    const compilerOptions = { strict: true, noEmit: true, target: 'ES2022', lib: ['ES2022'], types: [], module: 'ESNext', moduleResolution: 'Bundler' };
    writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions, include: ['sample.ts'] }));
    run(tsc, ['-p', folder]);
  });
});

/** How each framework's JSX is compiled, and what it needs to run. */
const RUNNING = {
  react: { packages: ['react', 'react-dom'], config: { oxc: { jsx: { runtime: 'automatic', importSource: 'react' } } } },
  preact: { packages: ['preact'], config: { oxc: { jsx: { runtime: 'automatic', importSource: 'preact' } } } },
  solid: { packages: ['solid-js'], plugin: async () => (await import('vite-plugin-solid')).default() },
};

/** The outcome of each of these applications. */
async function expectedClip() {
  const whole = await openClip(pair());
  await whole.segment({ quality: 'fast', motions: 3 });
  const { labels } = await whole.labels(0);
  const { objects } = await whole.tracks();
  await whole.close();
  const attributes = { motions: '3', quality: 'fast', grouped: true };
  return { objects: objects.length, labels: Array.from(labels).join(''), attributes };
}

describe('JSX', () => {
  for (const [name, { packages, config, plugin }] of Object.entries(RUNNING)) {
    test(`${name}: frames arrive as a property, options as attributes, and listeners hear the events`, async (t) => {
      const folder = folderWith(`run-${name}`, packages);
      cpSync(join(here, 'markup/run'), folder, { recursive: true });
      cpSync(join(app, 'frames.js'), join(folder, 'frames.js'));
      writeFileSync(join(folder, 'package.json'), '{ "private": true, "type": "module" }\n');
      writeFileSync(join(folder, 'index.html'), `<!doctype html>\n<link rel="icon" href="data:," />\n<body><script type="module" src="/${name}.jsx"></script></body>\n`);
      const { build } = await import('vite');
      await build({ root: folder, configFile: false, logLevel: 'error', clearScreen: false, plugins: plugin ? [await plugin()] : [], ...config });
      const { address } = await serve(t, join(folder, 'dist'));
      const { outcome, complaints } = await outcomeOf(t, browser, address);
      assert.deepEqual(complaints, []);
      assert.deepEqual(outcome, await expectedClip());
    });
  }
});

describe('a page made by a server', () => {
  test("React's component takes it over: properties, attributes, listeners and its reference are those of the element", async (t) => {
    const folder = folderWith('rendered-react', RUNNING.react.packages);
    // Without it, Next would take the component for one of the server's.
    assert.match(readFileSync(join(folder, 'node_modules/veronese/dist/react.js'), 'utf8'), /^'use client';/);
    for (const part of ['run', 'rendered']) cpSync(join(here, 'markup', part), folder, { recursive: true });
    cpSync(join(app, 'frames.js'), join(folder, 'frames.js'));
    writeFileSync(join(folder, 'package.json'), '{ "private": true, "type": "module" }\n');
    const { build } = await import('vite');
    // In its development form React says where the two pages differ.
    const common = { root: folder, configFile: false, logLevel: 'error', clearScreen: false, mode: 'development', define: { 'process.env.NODE_ENV': '"development"' }, ...RUNNING.react.config };
    await build({ ...common, build: { ssr: 'server.jsx', outDir: 'server' } });
    const { html } = await import(join(folder, 'server/server.js'));
    assert.equal(html, '<veronese-segmenter id="masks" class="wide"></veronese-segmenter>');
    writeFileSync(join(folder, 'index.html'), `<!doctype html>\n<link rel="icon" href="data:," />\n<body><div id="root">${html}</div><script type="module" src="/browser.jsx"></script></body>\n`);
    await build(common);
    const { address } = await serve(t, join(folder, 'dist'));
    const { outcome, complaints } = await outcomeOf(t, browser, address);
    assert.deepEqual(complaints, []);
    assert.deepEqual(outcome, await expectedClip());
  });

  test('properties that were set before the element was defined are its own', async (t) => {
    const folder = folderWith('set-before', []);
    cpSync(join(app, 'frames.js'), join(folder, 'frames.js'));
    const script = `import { first, second } from './frames.js';
      const element = document.querySelector('veronese-segmenter');
      Object.assign(element, { frames: [first, second], name: 'masks', selected: 1 });
      element.addEventListener('tracks', () => (globalThis.outcome = { own: Object.keys(element), frames: element.frameCount, name: element.getAttribute('name'), selected: element.selected }));
      await import('./node_modules/veronese/dist/element.js');`;
    writeFileSync(join(folder, 'index.html'), `<!doctype html>\n<link rel="icon" href="data:," />\n<veronese-segmenter quality="fast"></veronese-segmenter><script type="module">${script}</script>\n`);
    const { address } = await serve(t, folder);
    const { outcome, complaints } = await outcomeOf(t, browser, address);
    assert.deepEqual(complaints, []);
    assert.deepEqual(outcome, { own: [], frames: 2, name: 'masks', selected: 1 });
  });
});

/** Imports of each example, its configuration included. */
const EXAMPLES = {
  vue: ['vue', 'vite', '@vitejs/plugin-vue'],
  svelte: ['svelte', 'vite', '@sveltejs/vite-plugin-svelte'],
};

describe('examples', () => {
  for (const [name, packages] of Object.entries(EXAMPLES)) {
    test(`${name}: built by Vite, with frames that a person chooses`, async (t) => {
      const folder = folderWith(name, packages);
      cpSync(fileURLToPath(new URL(`../../../examples/${name}`, import.meta.url)), folder, { recursive: true });
      const { build } = await import('vite');
      await build({ root: folder, logLevel: 'error', clearScreen: false });
      const { address, missing } = await serve(t, join(folder, 'dist'));
      const tab = await browser.newPage();
      t.after(() => tab.close());
      const complaints = [];
      tab.on('pageerror', (error) => complaints.push(String(error)));
      await tab.goto(address);
      await tab.getByLabel('Frames of a clip').setInputFiles(clip.map((pixels, k) => ({ name: `${k}.png`, mimeType: 'image/png', buffer: Buffer.from(png(pixels)) })));
      await tab.locator('li').first().waitFor({ timeout: 60_000 });

      const whole = await openClip(clip);
      await whole.segment({ quality: 'fast' });
      const expected = await whole.labels(0);
      const { objects } = await whole.tracks();
      await whole.close();
      const lines = objects.map(({ id, first, last }) => `Object ${id}: frames ${first} to ${last}`);
      assert.deepEqual(await tab.locator('li').allTextContents(), lines);
      const labels = await tab.evaluate(() => Array.from(document.querySelector('veronese-segmenter').labels()));
      assert.deepEqual(labels, Array.from(expected.labels));
      const { count } = await segmentPair(clip[0], clip[1], { quality: 'fast' });
      await tab.getByText(`Motions between the first two frames: ${count}`).waitFor();
      assert.deepEqual([complaints, missing], [[], []]);
    });
  }
});
