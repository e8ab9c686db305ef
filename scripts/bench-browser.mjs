// npm run bench:browser: the package in headless Chromium beside OpenCV.js and jsfeat, on the same frames, calls in turn.
// Options: --rounds N (default 30), --sizes 320x240,640x480,…, --scaling (also time and memory against pixels and motions).
// Writes out/bench/browser.json and prints tables.

import { mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { cpus } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

import { buildModules, buildPackage } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { root, toolsFolder } from './lib/project.mjs';
import { Stop, command, longStep, must } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';

const PEERS = { '@techstark/opencv-js': '5.0.0-release.1', jsfeat: '0.0.8' };
const PEER_FILES = { opencv: '@techstark/opencv-js/dist/opencv.js', jsfeat: 'jsfeat/build/jsfeat-min.js' };
const OURS = ['fast', 'best'];
const CASES = [...OURS, 'farneback', 'opencvPipeline', 'jsfeat'];
/** Fresh pages for each case and size: what a first call takes, and how long until it can be made. */
const FRESH_PAGES = 3;
/** One and two workers by turns. */
const THROUGHPUT_ROUNDS = 5;
const THROUGHPUT_PAIRS = 12;
/** 0.05 to 16.8 megapixels, the largest frame there may be. */
const SCALES = ['256x192', '512x384', '1024x768', '2048x1536', '3264x2448', '4096x4096'];
const SCALING_ROUNDS = 3;
const HOST = '127.0.0.1';
/** Without the page's own policy: OpenCV.js makes functions from text when it starts. */
const HEADERS = { 'X-Content-Type-Options': 'nosniff' };

await command(async (args) => {
  const { rounds, sizes, scaling } = options(args);
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildModules();
  await buildPackage();
  await preparePeers();
  await writeFrames(sizes);
  const server = await serve(root, { host: HOST, headers: HEADERS });
  const address = `http://${HOST}:${server.address().port}/benches/browser/page.html`;
  const browser = await playwright().launch({ executablePath: chromium.path });
  try {
    const report = { ...downloads(), ...(await measured(browser, address, rounds, sizes)) };
    if (scaling) report.scaling = await scaled(browser, address, sizes[Math.min(1, sizes.length - 1)]);
    write(report);
    print(report, browser.version(), rounds);
  } finally {
    await browser.close();
    server.close();
    server.closeAllConnections();
  }
});

function options(args) {
  const text = { type: 'string' };
  let values;
  try {
    ({ values } = parseArgs({ args, options: { rounds: text, sizes: text, scaling: { type: 'boolean' } } }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const rounds = Number(values.rounds ?? 30);
  const sizes = (values.sizes ?? '320x240,640x480,1280x720').split(',');
  if (!Number.isInteger(rounds) || rounds < 1) throw new Stop('--rounds must be a whole number from 1.');
  if (!sizes.every((size) => /^\d+x\d+$/.test(size))) throw new Stop('--sizes must look like 320x240,640x480.');
  return { rounds, sizes, scaling: values.scaling === true };
}

/** The others are nobody's dependency: they are installed here, at fixed versions, into a folder of their own. */
async function preparePeers() {
  const folder = join(toolsFolder, 'peers');
  const installed = (name) => {
    try {
      return JSON.parse(readFileSync(join(folder, 'node_modules', name, 'package.json'), 'utf8')).version;
    } catch {
      return undefined; // Not there yet.
    }
  };
  if (Object.entries(PEERS).every(([name, version]) => installed(name) === version)) return;
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, 'package.json'), JSON.stringify({ private: true, dependencies: PEERS }));
  const install = ['install', '--ignore-scripts', '--omit=dev', '--no-package-lock', '--no-workspaces', '--prefix', folder];
  await longStep('Installing OpenCV.js and jsfeat (13 MB)', 'They could not be installed.', 'npm', install, { cwd: folder });
}

/** Generated pairs with their true labels, where the page fetches them. */
async function writeFrames(sizes) {
  const folder = join(root, 'out/bench/frames');
  mkdirSync(folder, { recursive: true });
  console.log('Generating the frames (building the native program first if it has changed) …');
  const program = ['run', '--quiet', '--release', '--locked', '--example', 'ratio', '--', 'scenes', folder, ...sizes];
  await must('The frames could not be generated.', 'cargo', program);
}

function playwright() {
  return createRequire(join(root, 'www/package.json'))('@playwright/test').chromium;
}

/** Bytes to download, gzip -9: the module, and the JavaScript that the entry for browsers imports. */
function downloads() {
  const read = (path) => readFileSync(join(root, path));
  const zipped = (path) => gzipSync(read(path), { level: 9 }).length;
  const scripts = new Set();
  const follow = (path) => {
    if (scripts.has(path)) return;
    scripts.add(path);
    for (const [, name] of read(path).toString().matchAll(/^(?:import|export) .*?from "\.\/([^"]+)"/gm)) {
      follow(`pkg/dist/${name}`);
    }
  };
  follow('pkg/dist/web.js');
  const peers = {};
  for (const [name, path] of Object.entries(PEER_FILES)) peers[name] = { gzip: zipped(`.tools/peers/node_modules/${path}`) };
  peers.opencv.version = PEERS['@techstark/opencv-js'];
  peers.jsfeat.version = PEERS.jsfeat;
  return {
    wasmGzip: zipped('pkg/wasm/veronese_bg.wasm'),
    jsGzip: [...scripts].reduce((sum, path) => sum + zipped(path), 0),
    peers,
  };
}

async function measured(browser, address, rounds, sizes) {
  const fresh = await freshPages(browser, address, sizes);
  const workers = await throughput(browser, address, sizes[Math.min(1, sizes.length - 1)]);
  const found = await interleaved(browser, address, rounds, sizes);
  const bySize = {};
  for (const size of sizes) {
    bySize[size] = {};
    for (const name of CASES) {
      const calls = found[size][name];
      const times = calls.map((call) => call.milliseconds);
      const entry = { median: quantile(times, 0.5), best: Math.min(...times), first: fresh.first[size][name] };
      if (OURS.includes(name)) {
        entry.stages = stageMedians(calls);
        entry.memoryBytes = fresh.memory[size][name];
      }
      const { overlap, count } = calls[0];
      bySize[size][name] = { ...entry, overlap, count };
    }
  }
  const peersReady = { opencv: fresh.ready.farneback, jsfeat: fresh.ready.jsfeat };
  return { readyMs: fresh.ready.ours, peersReadyMs: peersReady, workers, rounds, sizes: bySize };
}

/** One page after another, each in a context without cache: time until ready, first call, memory. */
async function freshPages(browser, address, sizes) {
  const ready = {};
  const first = {};
  const memory = {};
  for (const size of sizes) {
    first[size] = {};
    memory[size] = {};
    for (const name of CASES) {
      console.log(`Fresh pages: ${name}, ${size}`);
      const firsts = [];
      for (let k = 0; k < FRESH_PAGES; k += 1) {
        await onPage(browser, address, async (page) => {
          const load = await page.evaluate((name) => globalThis.bench.load(name), name);
          (ready[OURS.includes(name) ? 'ours' : name] ??= []).push(load);
          await page.evaluate((size) => globalThis.bench.prepare(size), size);
          firsts.push((await call(page, name, size)).milliseconds);
        });
      }
      first[size][name] = quantile(firsts, 0.5);
      if (OURS.includes(name)) {
        memory[size][name] = await onPage(browser, address, async (page) => {
          await page.evaluate((size) => globalThis.bench.prepare(size), size);
          return page.evaluate(([name, size]) => globalThis.bench.memory(name, size), [name, size]);
        });
      }
    }
  }
  return { ready: Object.fromEntries(Object.entries(ready).map(([k, v]) => [k, quantile(v, 0.5)])), first, memory };
}

/** All cases of all sizes in one page, by turns, so that whatever else the machine does slows all of them. */
async function interleaved(browser, address, rounds, sizes) {
  const found = Object.fromEntries(sizes.map((size) => [size, Object.fromEntries(CASES.map((name) => [name, []]))]));
  await onPage(browser, address, async (page) => {
    for (const name of CASES) await page.evaluate((name) => globalThis.bench.load(name), name);
    for (const size of sizes) {
      await page.evaluate((size) => globalThis.bench.prepare(size), size);
      for (const name of CASES) for (let k = 0; k < 2; k += 1) await call(page, name, size); // not counted
    }
    for (let round = 0; round < rounds; round += 1) {
      if (round % 5 === 0) console.log(`Round ${round + 1} of ${rounds}`);
      for (const size of sizes) for (const name of CASES) found[size][name].push(await call(page, name, size));
    }
  });
  return found;
}

async function throughput(browser, address, size) {
  const rates = { 1: [], 2: [] };
  await onPage(browser, address, async (page) => {
    await page.evaluate((size) => globalThis.bench.prepare(size), size);
    for (let round = 0; round < THROUGHPUT_ROUNDS; round += 1) {
      for (const workers of [1, 2]) {
        const task = [workers, THROUGHPUT_PAIRS, size];
        rates[workers].push(await page.evaluate((task) => globalThis.bench.throughput(...task), task));
      }
    }
  });
  const [one, two] = [quantile(rates[1], 0.5), quantile(rates[2], 0.5)];
  return { size, onePairsPerSecond: one, twoPairsPerSecond: two, ratio: two / one };
}

/** Time and memory against pixels, time against the number of motions asked for, with the exponents of power laws. */
async function scaled(browser, address, from) {
  const pixels = [];
  for (const size of SCALES) {
    console.log(`Scaling: ${size}`);
    const [width, height] = size.split('x').map(Number);
    const entry = { size, megapixels: (width * height) / 1e6 };
    for (const quality of OURS) {
      await onPage(browser, address, async (page) => {
        await page.evaluate((from) => globalThis.bench.prepare(from), from);
        await page.evaluate(([from, to]) => globalThis.bench.resize(from, to), [from, size]);
        await page.evaluate((name) => globalThis.bench.load(name), quality);
        const times = [];
        for (let k = 0; k < SCALING_ROUNDS + 1; k += 1) times.push((await call(page, quality, size)).milliseconds);
        entry[quality] = quantile(times.slice(1), 0.5); // the first warms up
      });
    }
    entry.memoryBytes = await onPage(browser, address, async (page) => {
      await page.evaluate((from) => globalThis.bench.prepare(from), from);
      await page.evaluate(([from, to]) => globalThis.bench.resize(from, to), [from, size]);
      return page.evaluate(([name, size]) => globalThis.bench.memory(name, size), ['best', size]);
    });
    pixels.push(entry);
  }
  const motions = [];
  await onPage(browser, address, async (page) => {
    await page.evaluate((from) => globalThis.bench.prepare(from), from);
    for (let n = 1; n <= 10; n += 1) {
      const entry = { motions: n };
      for (const quality of OURS) {
        const times = [];
        for (let k = 0; k < SCALING_ROUNDS; k += 1) {
          const task = [n, quality, from];
          times.push((await page.evaluate((task) => globalThis.bench.given(...task), task)).milliseconds);
        }
        entry[quality] = quantile(times, 0.5);
      }
      motions.push(entry);
    }
  });
  const large = pixels.filter(({ megapixels }) => megapixels > 0.5);
  const exponents = {
    fastByPixels: exponent(large, 'megapixels', 'fast'),
    bestByPixels: exponent(large, 'megapixels', 'best'),
    memoryByPixels: exponent(large, 'megapixels', 'memoryBytes'),
    fastByMotions: exponent(motions, 'motions', 'fast'),
    bestByMotions: exponent(motions, 'motions', 'best'),
  };
  return { pixels, motions, exponents };
}

/** Of the power law through points: the slope of the straight line through their logarithms. */
function exponent(points, x, y) {
  const logs = points.map((point) => [Math.log(point[x]), Math.log(point[y])]);
  const mean = (k) => logs.reduce((sum, log) => sum + log[k], 0) / logs.length;
  const [mx, my] = [mean(0), mean(1)];
  const covariance = logs.reduce((sum, [p, q]) => sum + (p - mx) * (q - my), 0);
  return covariance / logs.reduce((sum, [p]) => sum + (p - mx) ** 2, 0);
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

function stageMedians(calls) {
  const names = Object.keys(calls[0].stages).filter((name) => name !== 'total');
  return Object.fromEntries(names.map((name) => [name, quantile(calls.map((call) => call.stages[name] ?? 0), 0.5)]));
}

function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const [below, above] = [Math.floor(place), Math.ceil(place)];
  return sorted[below] + (place - below) * (sorted[above] - sorted[below]);
}

function write(report) {
  const path = join(root, 'out/bench/browser.json');
  mkdirSync(join(root, 'out/bench'), { recursive: true });
  writeFileSync(`${path}.new`, `${JSON.stringify(report, undefined, 2)}\n`);
  renameSync(`${path}.new`, path);
  rmSync(join(root, 'out/bench/frames'), { recursive: true, force: true });
}

function print({ wasmGzip, jsGzip, peers, readyMs, peersReadyMs, workers, sizes, scaling }, version, rounds) {
  const kib = (bytes) => `${(bytes / 1024).toFixed(1)} KiB`;
  const ms = (value) => value.toFixed(1);
  console.log(`\n${cpus()[0].model}, Chromium ${version}, ${rounds} rounds in turn on one thread, milliseconds\n`);
  console.log('| | download (gzip) | ready |\n|---|---|---|');
  console.log(`| Veronese | ${kib(wasmGzip)} + ${kib(jsGzip)} JavaScript | ${ms(readyMs)} |`);
  console.log(`| OpenCV.js ${peers.opencv.version} | ${kib(peers.opencv.gzip)} | ${ms(peersReadyMs.opencv)} |`);
  console.log(`| jsfeat ${peers.jsfeat.version} | ${kib(peers.jsfeat.gzip)} | ${ms(peersReadyMs.jsfeat)} |`);
  console.log('\n| size | call | median | best | first | ÷ Farneback | overlap | memory |\n|---|---|---|---|---|---|---|---|');
  for (const [size, cases] of Object.entries(sizes)) {
    for (const [name, { median, best, first, overlap, memoryBytes }] of Object.entries(cases)) {
      const ratio = (median / cases.farneback.median).toFixed(2);
      const rest = [ratio, overlap === undefined ? '' : overlap.toFixed(3), memoryBytes ? kib(memoryBytes) : ''];
      console.log(`| ${[size, name, ms(median), ms(best), ms(first), ...rest].join(' | ')} |`);
    }
  }
  const stages = Object.keys(Object.values(sizes)[0].fast.stages);
  console.log(`\n| size | quality | ${stages.join(' | ')} |\n|---|---|${'---|'.repeat(stages.length)}`);
  for (const [size, cases] of Object.entries(sizes)) {
    for (const name of OURS) {
      console.log(`| ${[size, name, ...stages.map((stage) => ms(cases[name].stages[stage] ?? 0))].join(' | ')} |`);
    }
  }
  const { size, onePairsPerSecond, twoPairsPerSecond, ratio } = workers;
  console.log(
    `\nPairs of ${size} per second, fast: ${ms(onePairsPerSecond)} in one worker, ${ms(twoPairsPerSecond)} in two (${ratio.toFixed(2)} times)`,
  );
  if (scaling) printScaling(scaling);
}

function printScaling({ pixels, motions, exponents }) {
  console.log('\n| size | megapixels | fast, ms | best, ms | memory, MiB |\n|---|---|---|---|---|');
  for (const { size, megapixels, fast, best, memoryBytes } of pixels) {
    const cells = [megapixels.toFixed(2), fast.toFixed(0), best.toFixed(0), (memoryBytes / 2 ** 20).toFixed(0)];
    console.log(`| ${[size, ...cells].join(' | ')} |`);
  }
  console.log('\n| motions given | fast, ms | best, ms |\n|---|---|---|');
  for (const { motions: n, fast, best } of motions) console.log(`| ${n} | ${fast.toFixed(0)} | ${best.toFixed(0)} |`);
  const list = Object.entries(exponents).map(([name, value]) => `${name} ${value.toFixed(2)}`);
  console.log(`\nExponents (pixels: above half a megapixel): ${list.join(', ')}`);
}
