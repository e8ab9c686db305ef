// npm run bench -- page: opens the page as a first visitor does and measures the time until masks are there. Then it opens a long generated video,
// segments all of it and steps through it, in headless Chromium, and samples the memory of all processes of the browser (Linux only). Then it
// paints in frames of a clip of 854 × 480 pixels and measures the time until the corrected frame is drawn, and the memory after many strokes more.
// Tasks that block the page are counted throughout. Prints tables. Options:
//   --frames N     length of the video (240)
//   --size WxH     size of its frames (1920x1080)
//   --quality Q    fast or best (fast)
//   --workers N    workers for the video, as on a machine with enough processors (the page's choice here)
//   --write-docs   writes the figures to docs/figures, and docs/performance.md from them

import { mkdirSync, rmSync } from 'node:fs';
import { cpus } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';

import { browserMemory } from '../lib/browser-memory.mjs';
import { buildPage } from '../lib/builds.mjs';
import { firstVisits, tasksSince, watchTasks } from '../lib/first-visit.mjs';
import { openBrowser } from '../lib/launch-chromium.mjs';
import { writeLongClip } from '../lib/long-clip.mjs';
import { present } from '../lib/documented.mjs';
import { prepare } from '../lib/prepare.mjs';
import { root } from '../lib/project.mjs';
import { Stop, command } from '../lib/run.mjs';

const OUT = join(root, 'out/bench');
const VIDEO = join(OUT, 'long-clip.webm');
/** Between samples of the memory, milliseconds. */
const INTERVAL = 1000;
/** The clip that is corrected: in each of these frames a stroke is drawn. */
const CORRECTED = { size: [854, 480], frames: 50, at: [5, 10, 15, 20, 25, 30, 35, 40, 45] };
/** Then in so many frames, each alone. */
const STROKES = 40;

await command(async (args) => {
  const { frames, size, quality, workers, writeDocs } = options(args);
  if (process.platform !== 'linux') throw new Stop('The memory of processes is read from /proc, which only Linux has.');
  const { chromium } = await prepare({ browser: true });
  await buildPage();
  mkdirSync(OUT, { recursive: true });
  const { browser, address, close } = await openBrowser(chromium, join(root, 'www/dist'));
  try {
    console.log('Opening the page as a first visitor …');
    const first = await firstVisits(browser, address);
    console.log(`Making a video of ${frames} frames …`);
    const maker = await browser.newPage();
    await maker.goto(`${address}#sample=intel-two-cars`);
    await writeLongClip(maker, VIDEO, frames, size);
    const measured = await segmented(browser, address, { quality, workers });
    await writeLongClip(maker, VIDEO, CORRECTED.frames, CORRECTED.size);
    await maker.close();
    const { painting, worked, ...corrected } = await correctedFrames(browser, address, quality);
    const tasks = { ...measured.tasks, painting };
    const report = { frames, size, quality, workers, ...measured, memory: { ...measured.memory, ...worked }, tasks, first, corrected };
    present('page', { command: 'npm run bench -- page', chromium: browser.version() }, report, writeDocs);
  } finally {
    await close();
    rmSync(VIDEO, { force: true });
  }
});

function options(args) {
  const text = { type: 'string' };
  let values;
  try {
    ({ values } = parseArgs({
      args,
      options: { frames: text, size: text, quality: text, workers: text, 'write-docs': { type: 'boolean', default: false } },
    }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const {
    frames = '240',
    size = '1920x1080',
    quality = 'fast',
    workers = String(Math.min(cpus().length > 2 ? cpus().length - 1 : cpus().length, 8)),
    'write-docs': writeDocs,
  } = values;
  if (!/^\d+$/.test(frames) || Number(frames) < 10) throw new Stop('--frames must be a whole number from 10.');
  if (!/^\d+x\d+$/.test(size)) throw new Stop('--size must look like 1920x1080.');
  if (!['fast', 'best'].includes(quality)) throw new Stop('--quality must be fast or best.');
  if (!/^[1-8]$/.test(workers)) throw new Stop('--workers must be a whole number from 1 to 8.');
  return { frames: Number(frames), size: size.split('x').map(Number), quality, workers: Number(workers), writeDocs };
}

/** Segments the video as a person would and returns `{ seconds, memory, tasks }`; memory in bytes. */
async function segmented(browser, address, { quality, workers }) {
  const page = await browser.newPage();
  const processors = workers > 2 ? workers + 1 : workers;
  await page.addInitScript((count) => Object.defineProperty(Navigator.prototype, 'hardwareConcurrency', { get: () => count }), processors);
  page.setDefaultTimeout(0);
  await page.goto(`${address}#sample=intel-two-cars&quality=${quality}&segment=asked`);
  const session = await browser.newBrowserCDPSession();
  const asked = Date.now();
  await open(page);
  console.log(`Opened in ${((Date.now() - asked) / 1000).toFixed(1)} s`);
  const opened = await browserMemory(session);
  await page.evaluate(watchTasks);
  await page.locator('#clip-segment').click();
  await reached(page, '#clip-run', 'working');
  const began = Date.now();
  let [share, most] = [0, opened];
  for (;;) {
    const { phase, text, value } = await page.evaluate(() => ({
      phase: document.querySelector('#clip-run').dataset.phase,
      text: document.querySelector('#clip-detail').textContent,
      value: document.querySelector('#clip-progress').getAttribute('value'),
    }));
    if (phase !== 'working') {
      if (phase !== 'done') throw new Stop(`The run ended as '${phase}': ${await page.locator('#notice').textContent()}`);
      break;
    }
    const bytes = await browserMemory(session);
    most = Math.max(most, bytes);
    // The share begins anew when all pairs are solved.
    if (value !== null && (Number(value) >= share + 0.1 || Number(value) < share)) {
      share = Number(value);
      console.log(`${((Date.now() - began) / 1000).toFixed(0)} s, ${text}, ${Math.round(bytes / 2 ** 20)} MiB`);
    }
    await sleep(INTERVAL);
  }
  const seconds = (Date.now() - began) / 1000;
  const done = await browserMemory(session);
  const segmenting = await page.evaluate(tasksSince);
  const track = page.locator('#track');
  for (const key of ['End', 'Home', ...Array.from({ length: 30 }, () => 'PageUp')]) {
    await track.press(key);
    await reached(page, '#run', 'done');
  }
  const tasks = { segmenting, stepping: await page.evaluate(tasksSince) };
  const memory = {
    opened,
    'at most while segmenting': most,
    segmented: done,
    'after steps to 32 other frames': await browserMemory(session),
  };
  return { seconds, memory, tasks };
}

/** Times from the end of strokes until the stroke is drawn, the corrected frame is, and the correction has spread, milliseconds. */
async function correctedFrames(browser, address, quality) {
  const page = await browser.newPage();
  await page.goto(`${address}#sample=intel-two-cars&quality=${quality}&segment=asked`);
  await open(page);
  await page.locator('#clip-segment').click();
  await reached(page, '#clip-run', 'working');
  await reached(page, '#clip-run', 'done');
  await page.locator('#tools [value=brush]').check();
  await page.locator('#objects > li').nth(1).locator('.motion-facts').click();
  const track = page.locator('#track');
  await page.evaluate(watchTasks);
  const times = [];
  for (const index of CORRECTED.at) {
    await track.press('Home');
    for (let k = 0; k < index; k += 1) await track.press('ArrowRight');
    await page.waitForFunction((index) => document.querySelector('#caption').textContent === `Frame ${index}`, index);
    await reached(page, '#run', 'done');
    times.push(await page.evaluate(strokeTimes));
    await page.locator('#undo').click();
  }
  const painting = await page.evaluate(tasksSince);
  const worked = await memoryOfStrokes(browser, page);
  await page.close();
  const figures = ['stroke', 'frame', 'clip'].map((name) => {
    const sorted = times.map((time) => time[name]).sort((one, other) => one - other);
    return [name, { median: sorted[Math.floor(sorted.length / 2)], worst: sorted.at(-1) }];
  });
  return { painting, worked, ...Object.fromEntries(figures) };
}

/** The memory before and after many strokes that stay in their frames, bytes. */
async function memoryOfStrokes(browser, page) {
  const session = await browser.newBrowserCDPSession();
  const before = await browserMemory(session);
  await page.locator('[name=spread]').selectOption('none');
  for (let k = 0; k < STROKES; k += 1) {
    await page.locator('#track').press(k % CORRECTED.frames === CORRECTED.frames - 1 ? 'Home' : 'ArrowRight');
    await reached(page, '#run', 'done');
    await page.evaluate(strokeTimes);
  }
  return { corrected: before, [`${STROKES} strokes more`]: await browserMemory(session) };
}

/** Runs in the page: draws a stroke across the first object. */
async function strokeTimes() {
  const layers = document.querySelector('.layers');
  const detail = document.querySelector('#clip-detail');
  const run = document.querySelector('#clip-run');
  layers.setPointerCapture = () => undefined; // made pointers cannot be captured
  const { x, y, width, height } = layers.getBoundingClientRect();
  const send = (type, u, v) =>
    layers.dispatchEvent(
      new PointerEvent(type, {
        pointerId: 1,
        isPrimary: true,
        button: type === 'pointermove' ? -1 : 0,
        bubbles: true,
        clientX: x + u * width,
        clientY: y + v * height,
      }),
    );
  const until = (isSo) =>
    new Promise((resolve) => {
      const look = () => (isSo() ? requestAnimationFrame(() => resolve(performance.now())) : undefined);
      const observer = new MutationObserver(look);
      for (const node of [detail, run]) observer.observe(node, { attributes: true, childList: true, characterData: true, subtree: true });
      look();
    });
  send('pointerdown', 0.3, 0.5);
  for (let k = 1; k <= 10; k += 1) send('pointermove', 0.3 + 0.01 * k, 0.5);
  await new Promise(requestAnimationFrame);
  const began = performance.now();
  send('pointerup', 0.4, 0.5);
  const stroke = new Promise(requestAnimationFrame).then(() => performance.now());
  const isDone = () => run.dataset.phase === 'done';
  // The corrected frame comes first, and has changed when the next one is told.
  const [drawn, frame, clip] = await Promise.all([stroke, until(() => isDone() || Number.parseInt(detail.textContent) > 1), until(isDone)]);
  return { stroke: drawn - began, frame: frame - began, clip: clip - began };
}

async function open(page) {
  await page.locator('#open-pair').setInputFiles(VIDEO);
  await page.waitForFunction(() => document.querySelector('#clip-name').textContent.startsWith('long-clip'));
  await reached(page, '#run', 'idle');
}

async function reached(page, selector, phase) {
  await page.waitForFunction(([selector, phase]) => document.querySelector(selector).dataset.phase === phase, [selector, phase]);
}
