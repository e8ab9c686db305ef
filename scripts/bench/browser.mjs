// npm run bench -- browser: compares the package in headless Chromium with OpenCV.js and with the same source compiled to native code, in
// alternating calls on the same generated frames. Prints tables. Options:
//   --rounds N                 calls of each kind (8)
//   --sizes 320x240,640x480,…  sizes of the frames (320x240,640x480,1280x720,1920x1080)
//   --write-docs               writes the figures to docs/figures, and docs/performance.md from them

import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

import { buildPackage } from '../lib/builds.mjs';
import { present } from '../lib/documented.mjs';
import { openBrowser } from '../lib/launch-chromium.mjs';
import { prepare } from '../lib/prepare.mjs';
import { root, toolsFolder } from '../lib/project.mjs';
import { Stop, command, longStep, must } from '../lib/run.mjs';
import { median } from '../lib/statistics.mjs';

const FRAMES = join(root, 'out/bench/frames');
const NATIVE = ['run', '--quiet', '--release', '--locked', '--package', 'benches', '--example', 'browser', '--'];
const PEER = '@techstark/opencv-js';
const PEER_VERSION = '5.0.0-release.1';
const OURS = ['fast', 'best'];
/** Calls on a pair, which also have a first one on a fresh page; then clips, of which the median of a frame is measured. */
const PAIRS = [...OURS, 'farneback', 'opencvPipeline'];
const CASES = [...PAIRS, 'clip', 'clipFlow'];
/** Number of fresh pages for each case and size. */
const FRESH_PAGES = 3;
/** Without the page's own policy, because OpenCV.js creates functions from text when it starts. */
const HEADERS = { 'X-Content-Type-Options': 'nosniff' };

await command(async (args) => {
  const { rounds, sizes, writeDocs } = options(args);
  const { chromium } = await prepare({ browser: true });
  await buildPackage();
  await preparePeer();
  mkdirSync(FRAMES, { recursive: true });
  console.log('Generating the frames (building the native program first if it has changed) …');
  await must('The frames could not be generated.', 'cargo', [...NATIVE, 'scenes', FRAMES, ...sizes]);
  const { browser, address, close } = await openBrowser(chromium, root, HEADERS);
  try {
    const report = { rounds, ...downloads(), ...(await measured(browser, `${address}benches/browser/page.html`, rounds, sizes)) };
    present('browser', { command: 'npm run bench -- browser', chromium: browser.version() }, report, writeDocs);
  } finally {
    await close();
    rmSync(FRAMES, { recursive: true, force: true });
  }
});

function options(args) {
  let values;
  try {
    const known = { rounds: { type: 'string' }, sizes: { type: 'string' }, 'write-docs': { type: 'boolean', default: false } };
    ({ values } = parseArgs({ args, options: known }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const rounds = Number(values.rounds ?? 8);
  const sizes = (values.sizes ?? '320x240,640x480,1280x720,1920x1080').split(',');
  if (!Number.isInteger(rounds) || rounds < 1) throw new Stop('--rounds must be a whole number from 1.');
  if (!sizes.every((size) => /^\d+x\d+$/.test(size))) throw new Stop('--sizes must look like 320x240,640x480.');
  return { rounds, sizes, writeDocs: values['write-docs'] };
}

/** OpenCV.js is no dependency; a fixed version is installed in a folder of its own. */
async function preparePeer() {
  const folder = join(toolsFolder, 'peers');
  try {
    if (JSON.parse(readFileSync(join(folder, 'node_modules', PEER, 'package.json'), 'utf8')).version === PEER_VERSION) return;
  } catch {
    // Not there yet.
  }
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, 'package.json'), JSON.stringify({ private: true, dependencies: { [PEER]: PEER_VERSION } }));
  const install = ['install', '--ignore-scripts', '--omit=dev', '--no-package-lock', '--no-workspaces', '--prefix', folder];
  await longStep('Installing OpenCV.js (13 MB)', 'It could not be installed.', 'npm', install, { cwd: folder });
}

/** Download size in bytes (gzip -9): the module, the JavaScript that the browser entry imports, and OpenCV.js. */
function downloads() {
  const read = (path) => readFileSync(join(root, path));
  const zipped = (path) => gzipSync(read(path), { level: 9 }).length;
  const scripts = new Set();
  const follow = (path) => {
    if (scripts.has(path)) return;
    scripts.add(path);
    for (const [, name] of read(path)
      .toString()
      .matchAll(/^(?:import|export) .*?from "\.\/([^"]+)"/gm))
      follow(`pkg/dist/${name}`);
  };
  follow('pkg/dist/web.js');
  return {
    wasmGzip: zipped('pkg/wasm/veronese_bg.wasm'),
    jsGzip: [...scripts].reduce((sum, path) => sum + zipped(path), 0),
    peers: { opencv: { gzip: zipped(`.tools/peers/node_modules/${PEER}/dist/opencv.js`), version: PEER_VERSION } },
  };
}

async function measured(browser, address, rounds, sizes) {
  const { ready, first, memory } = await freshPages(browser, address, sizes);
  const { calls, native } = await interleaved(browser, address, rounds, sizes);
  const bySize = {};
  for (const size of sizes) {
    bySize[size] = {};
    for (const name of CASES) {
      const times = calls[size][name].map((call) => call.milliseconds);
      const { overlap, count } = calls[size][name][0];
      const ours = OURS.includes(name) && { native: median(native.map((round) => round[size][name])), memoryBytes: memory[size][name] };
      bySize[size][name] = { median: median(times), first: first[size][name], ...ours, overlap, count };
    }
  }
  return { readyMs: ready.fast, peersReadyMs: { opencv: ready.farneback }, sizes: bySize };
}

/** Opens one page after another, each without cache, and measures the time until ready, the first call and memory. */
async function freshPages(browser, address, sizes) {
  const [ready, first, memory] = [{}, {}, {}];
  for (const size of sizes) {
    [first[size], memory[size]] = [{}, {}];
    for (const name of PAIRS) {
      console.log(`Fresh pages: ${name}, ${size}`);
      const firsts = [];
      for (let k = 0; k < FRESH_PAGES; k += 1) {
        await onPage(browser, address, async (page) => {
          (ready[name] ??= []).push(await page.evaluate((name) => globalThis.bench.load(name), name));
          await page.evaluate((size) => globalThis.bench.prepare(size), size);
          firsts.push((await call(page, name, size)).milliseconds);
          if (OURS.includes(name))
            memory[size][name] = await page.evaluate(([name, size]) => globalThis.bench.memory(name, size), [name, size]);
        });
      }
      first[size][name] = median(firsts);
    }
  }
  return { ready: Object.fromEntries(Object.entries(ready).map(([name, times]) => [name, median(times)])), first, memory };
}

/** Alternates between all cases of all sizes in one page and in native code, so that other load on the machine slows all of them. */
async function interleaved(browser, address, rounds, sizes) {
  const calls = Object.fromEntries(sizes.map((size) => [size, Object.fromEntries(CASES.map((name) => [name, []]))]));
  const native = [];
  await onPage(browser, address, async (page) => {
    for (const name of CASES) await page.evaluate((name) => globalThis.bench.load(name), name);
    for (const size of sizes) {
      await page.evaluate((size) => globalThis.bench.prepare(size), size);
      for (const name of CASES) for (let k = 0; k < 2; k += 1) await call(page, name, size); // not counted
    }
    for (let round = 0; round < rounds; round += 1) {
      if (round % 5 === 0) console.log(`Round ${round + 1} of ${rounds}`);
      for (const size of sizes) for (const name of CASES) calls[size][name].push(await call(page, name, size));
      const { stdout } = await must('The native program failed.', 'cargo', [...NATIVE, 'times', FRAMES, ...sizes], { output: 'collect' });
      native.push(JSON.parse(stdout));
    }
  });
  return { calls, native };
}

async function onPage(browser, address, work) {
  const context = await browser.newContext();
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(0);
    await page.goto(address);
    await page.waitForFunction(() => globalThis.bench !== undefined);
    return await work(page);
  } finally {
    await context.close();
  }
}

function call(page, name, size) {
  return page.evaluate(([name, size]) => globalThis.bench.run(name, size), [name, size]);
}
