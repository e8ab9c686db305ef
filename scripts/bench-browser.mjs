// npm run bench:browser: compares the package in headless Chromium with OpenCV.js, jsfeat and the same source compiled to native
// code, in alternating calls on the same frames. Prints tables. Options:
//   --rounds N                 calls of each kind (30)
//   --sizes 320x240,640x480,…  sizes of the frames (320x240,640x480,1280x720,1920x1080)
//   --scaling                  also measure time and memory against pixels and motions (several minutes)
//   --alone                    without the alternatives; nothing is installed
//   --write-docs               writes the figures to docs/figures, and docs/performance.md from them

import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

import { buildPackage } from './lib/builds.mjs';
import { present } from './lib/documented.mjs';
import { launchChromium } from './lib/launch-chromium.mjs';
import { prepare } from './lib/prepare.mjs';
import { root, toolsFolder } from './lib/project.mjs';
import { Stop, command, longStep, must } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';
import { exponent, median } from './lib/statistics.mjs';

const FRAMES = join(root, 'out/bench/frames');
const NATIVE = ['run', '--quiet', '--release', '--locked', '--package', 'benches', '--example', 'ratio', '--'];
const PEERS = { '@techstark/opencv-js': '5.0.0-release.1', jsfeat: '0.0.8' };
const PEER_FILES = { opencv: '@techstark/opencv-js/dist/opencv.js', jsfeat: 'jsfeat/build/jsfeat-min.js' };
const OURS = ['fast', 'best'];
const THEIRS = ['farneback', 'opencvPipeline', 'jsfeat'];
/** Clips, of which the median of a frame is measured, and only that. */
const CLIPS = ['clip', 'clipFlow'];
/** Number of fresh pages for each case and size, to measure the first call and the time until the page is ready. */
const FRESH_PAGES = 3;
/** Rounds in which numbers of workers take turns. */
const WORKER_ROUNDS = 3;
/** 0.05 to 16.8 megapixels, the largest supported frame. */
const SCALES = ['256x192', '512x384', '1024x768', '2048x1536', '3264x2448', '4096x4096'];
const SCALING_ROUNDS = 3;
/** Megapixels above which the exponents are fitted; below, the work does not depend on the frame's size. */
const LARGE = 0.5;
const MOST_MOTIONS = 10;
const HOST = '127.0.0.1';
/** Without the page's own policy, because OpenCV.js creates functions from text when it starts. */
const HEADERS = { 'X-Content-Type-Options': 'nosniff' };

await command(async (args) => {
  const { rounds, sizes, scaling, alone, writeDocs } = options(args);
  const cases = alone ? [...OURS, CLIPS[0]] : [...OURS, ...THEIRS, ...CLIPS];
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildPackage();
  if (!alone) await preparePeers();
  await writeFrames(sizes);
  const server = await serve(root, { host: HOST, headers: HEADERS });
  const address = `http://${HOST}:${server.address().port}/benches/browser/page.html`;
  const browser = await launchChromium(chromium.path);
  try {
    const middle = sizes[Math.min(1, sizes.length - 1)];
    const report = {
      rounds,
      ...downloads(alone),
      ...(await measured(browser, address, { rounds, sizes, cases })),
      workers: await overWorkers(browser, address, middle),
      ...(scaling && { scaling: await scaled(browser, address, middle) }),
    };
    present('browser', { command: 'npm run bench:browser -- --scaling', chromium: browser.version() }, report, writeDocs);
  } finally {
    await browser.close();
    server.close();
    server.closeAllConnections();
    rmSync(FRAMES, { recursive: true, force: true });
  }
});

function options(args) {
  const [text, flag] = [{ type: 'string' }, { type: 'boolean', default: false }];
  let values;
  try {
    const known = { rounds: text, sizes: text, scaling: flag, alone: flag, 'write-docs': flag };
    ({ values } = parseArgs({ args, options: known }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const rounds = Number(values.rounds ?? 30);
  const sizes = (values.sizes ?? '320x240,640x480,1280x720,1920x1080').split(',');
  if (!Number.isInteger(rounds) || rounds < 1) throw new Stop('--rounds must be a whole number from 1.');
  if (!sizes.every((size) => /^\d+x\d+$/.test(size))) throw new Stop('--sizes must look like 320x240,640x480.');
  if (values['write-docs'] && (values.alone || !values.scaling)) throw new Stop('--write-docs writes the comparison and the scaling: give --scaling, not --alone.');
  return { rounds, sizes, scaling: values.scaling, alone: values.alone, writeDocs: values['write-docs'] };
}

/** The alternatives are not dependencies; fixed versions are installed here, in a separate folder. */
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

/** Writes generated pairs with their true labels to the folder from which the page fetches them. */
async function writeFrames(sizes) {
  mkdirSync(FRAMES, { recursive: true });
  console.log('Generating the frames (building the native program first if it has changed) …');
  await must('The frames could not be generated.', 'cargo', [...NATIVE, 'scenes', FRAMES, ...sizes]);
}

/** Download size in bytes (gzip -9): the module, and the JavaScript that the browser entry imports. */
function downloads(alone) {
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
  const ours = {
    wasmGzip: zipped('pkg/wasm/veronese_bg.wasm'),
    jsGzip: [...scripts].reduce((sum, path) => sum + zipped(path), 0),
  };
  if (alone) return ours;
  const peers = {};
  for (const [name, path] of Object.entries(PEER_FILES)) peers[name] = { gzip: zipped(`.tools/peers/node_modules/${path}`) };
  peers.opencv.version = PEERS['@techstark/opencv-js'];
  peers.jsfeat.version = PEERS.jsfeat;
  return { ...ours, peers };
}

async function measured(browser, address, { rounds, sizes, cases }) {
  const fresh = await freshPages(browser, address, sizes, cases.filter((name) => !CLIPS.includes(name)));
  const { calls, native } = await interleaved(browser, address, { rounds, sizes, cases });
  const bySize = {};
  for (const size of sizes) {
    bySize[size] = {};
    for (const name of cases) {
      const times = calls[size][name].map((call) => call.milliseconds);
      const { overlap, count } = calls[size][name][0];
      const entry = { median: median(times), best: Math.min(...times), first: fresh.first[size][name] };
      if (OURS.includes(name)) {
        entry.stages = stageMedians(calls[size][name].map((call) => call.stages));
        entry.native = nativeMedians(native.map((round) => round[size][name]));
        entry.memoryBytes = fresh.memory[size][name];
      }
      bySize[size][name] = { ...entry, overlap, count };
    }
  }
  const { ours: readyMs, farneback: opencv, jsfeat } = fresh.ready;
  return { readyMs, ...(opencv && { peersReadyMs: { opencv, jsfeat } }), sizes: bySize };
}

/** Opens one page after another, each without cache, and measures the time until ready, the first call and memory. */
async function freshPages(browser, address, sizes, cases) {
  const ready = {};
  const first = {};
  const memory = {};
  for (const size of sizes) {
    first[size] = {};
    memory[size] = {};
    for (const name of cases) {
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
      first[size][name] = median(firsts);
      if (OURS.includes(name)) {
        memory[size][name] = await onPage(browser, address, async (page) => {
          await page.evaluate((size) => globalThis.bench.prepare(size), size);
          return page.evaluate(([name, size]) => globalThis.bench.memory(name, size), [name, size]);
        });
      }
    }
  }
  return { ready: Object.fromEntries(Object.entries(ready).map(([k, v]) => [k, median(v)])), first, memory };
}

/** Alternates between all cases of all sizes in one page and in native code, so that other load on the machine slows all of them. */
async function interleaved(browser, address, { rounds, sizes, cases }) {
  const calls = Object.fromEntries(sizes.map((size) => [size, Object.fromEntries(cases.map((name) => [name, []]))]));
  const native = [];
  await onPage(browser, address, async (page) => {
    for (const name of cases) await page.evaluate((name) => globalThis.bench.load(name), name);
    for (const size of sizes) {
      await page.evaluate((size) => globalThis.bench.prepare(size), size);
      for (const name of cases) for (let k = 0; k < 2; k += 1) await call(page, name, size); // not counted
    }
    for (let round = 0; round < rounds; round += 1) {
      if (round % 5 === 0) console.log(`Round ${round + 1} of ${rounds}`);
      for (const size of sizes) for (const name of cases) calls[size][name].push(await call(page, name, size));
      const stages = ['stages', FRAMES, ...sizes];
      const { stdout } = await must('The native program failed.', 'cargo', [...NATIVE, ...stages], { output: 'collect' });
      native.push(JSON.parse(stdout));
    }
  });
  return { calls, native };
}

/** Whole clips with one worker, two, and four where there are so many cores; they take turns. */
async function overWorkers(browser, address, size) {
  const numbers = [1, 2, 4].filter((jobs) => jobs <= Math.max(2, cpus().length));
  return onPage(browser, address, async (page) => {
    await page.evaluate((size) => globalThis.bench.prepare(size), size);
    const runs = [];
    for (let round = 0; round < WORKER_ROUNDS + 1; round += 1) {
      console.log(round === 0 ? 'Workers: warming up' : `Workers: round ${round} of ${WORKER_ROUNDS}`);
      for (const quality of OURS) {
        for (const jobs of numbers) {
          const task = [jobs, quality, size];
          const clip = await page.evaluate((task) => globalThis.bench.wholeClip(...task), task);
          if (round > 0) runs.push({ quality, jobs, ...clip });
        }
        const masks = new Set(runs.filter((run) => run.quality === quality).map((run) => run.masks));
        if (masks.size > 1) throw new Stop('The masks depend on the number of workers.');
      }
    }
    const rows = OURS.flatMap((quality) => numbers.map((jobs) => {
      const of = (value) => median(runs.filter((run) => run.quality === quality && run.jobs === jobs).map(value));
      return { quality, jobs, perFrame: of(({ perFrame }) => perFrame), first: of(({ first }) => first) };
    }));
    return { size, rows };
  });
}

/** Time and memory against pixels, and time against the requested number of motions, with power-law exponents. */
async function scaled(browser, address, from) {
  const pixels = [];
  for (const size of SCALES) {
    console.log(`Scaling: ${size}`);
    const [width, height] = size.split('x').map(Number);
    const entry = { size, megapixels: (width * height) / 1e6, memory: {} };
    for (const quality of OURS) {
      entry[quality] = await onResized(browser, address, from, size, async (page) => {
        await page.evaluate((name) => globalThis.bench.load(name), quality);
        const times = [];
        for (let k = 0; k < SCALING_ROUNDS + 1; k += 1) times.push((await call(page, quality, size)).milliseconds);
        return median(times.slice(1)); // the first warms up
      });
      entry.memory[quality] = await onResized(browser, address, from, size, (page) =>
        page.evaluate(([name, size]) => globalThis.bench.memory(name, size), [quality, size]),
      );
    }
    pixels.push(entry);
  }
  const motions = [];
  await onPage(browser, address, async (page) => {
    await page.evaluate((from) => globalThis.bench.prepare(from), from);
    await page.evaluate((name) => globalThis.bench.load(name), OURS[0]);
    for (const quality of OURS) await call(page, quality, from); // not counted
    for (let n = 1; n <= MOST_MOTIONS; n += 1) {
      console.log(`Scaling: ${n} motions`);
      const entry = { motions: n };
      for (const quality of OURS) {
        const times = [];
        for (let k = 0; k < SCALING_ROUNDS; k += 1) {
          const task = [n, quality, from];
          times.push((await page.evaluate((task) => globalThis.bench.given(...task), task)).milliseconds);
        }
        entry[quality] = median(times);
      }
      motions.push(entry);
    }
  });
  const large = pixels.filter(({ megapixels }) => megapixels > LARGE);
  const byPixels = (value) => exponent(large.map((entry) => [entry.megapixels, value(entry)]));
  const exponents = {
    pixels: {
      fast: byPixels(({ fast }) => fast),
      best: byPixels(({ best }) => best),
      memoryFast: byPixels(({ memory }) => memory.fast),
      memoryBest: byPixels(({ memory }) => memory.best),
    },
    motions: Object.fromEntries(OURS.map((name) => [name, exponent(motions.map((entry) => [entry.motions, entry[name]]))])),
  };
  return { size: from, pixels, motions, exponents };
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

/** Opens a fresh page with the frames of one size scaled to another. */
function onResized(browser, address, from, to, work) {
  return onPage(browser, address, async (page) => {
    await page.evaluate((from) => globalThis.bench.prepare(from), from);
    await page.evaluate(([from, to]) => globalThis.bench.resize(from, to), [from, to]);
    return work(page);
  });
}

function call(page, name, size) {
  return page.evaluate(([name, size]) => globalThis.bench.run(name, size), [name, size]);
}

/** Medians of the stages over calls that report their times. */
function stageMedians(calls) {
  const names = Object.keys(calls[0]).filter((name) => name !== 'total');
  return Object.fromEntries(names.map((name) => [name, median(calls.map((stages) => stages[name] ?? 0))]));
}

function nativeMedians(calls) {
  return { median: median(calls.map(({ total }) => total)), stages: stageMedians(calls) };
}
