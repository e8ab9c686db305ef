// npm run bench:page: opens a long generated video in the page, segments all of it and steps through it, in headless Chromium, and samples
// the memory of all processes of the browser (Linux only). Writes out/bench/page.json and prints a table. Options:
//   --frames N     length of the video (2000)
//   --size WxH     size of its frames (1920x1080)
//   --quality Q    fast or best (fast)
//   --write-docs   writes the table to docs/performance.md as well

import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { cpus } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';

import { buildAll } from './lib/builds.mjs';
import { writeLongClip } from './lib/long-clip.mjs';
import { writeMarked } from './lib/marked.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';

const HOST = '127.0.0.1';
const OUT = join(root, 'out/bench');
const VIDEO = join(OUT, 'long-clip.webm');
/** Between samples of the memory, milliseconds. */
const INTERVAL = 1000;
/** Rows of the table while the clip is segmented. */
const ROWS = 10;

await command(async (args) => {
  const { frames, size, quality, writeDocs } = options(args);
  if (process.platform !== 'linux') throw new Stop('The memory of processes is read from /proc, which only Linux has.');
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildAll();
  mkdirSync(OUT, { recursive: true });
  const server = await serve(join(root, 'www/dist'), { host: HOST });
  const address = `http://${HOST}:${server.address().port}/`;
  const { chromium: engine } = createRequire(join(root, 'www/package.json'))('@playwright/test');
  const browser = await engine.launch({ executablePath: chromium.path, args: ['--no-sandbox'] });
  try {
    console.log(`Making a video of ${frames} frames …`);
    const maker = await browser.newPage();
    await maker.goto(`${address}#sample=intel-two-cars`);
    await writeLongClip(maker, VIDEO, frames, size);
    await maker.close();
    const measured = await segmented(browser, address, quality);
    const report = { date: new Date().toISOString().slice(0, 10), processor: cpus()[0].model, cores: cpus().length, chromium: browser.version(), frames, size, quality, ...measured };
    writeFileSync(join(OUT, 'page.json'), `${JSON.stringify(report, undefined, 2)}\n`);
    const text = tableOf(report);
    console.log(`\n${text}`);
    if (writeDocs) writeMarked('docs/performance.md', { page: text });
  } finally {
    await browser.close();
    server.close();
    server.closeAllConnections();
    rmSync(VIDEO, { force: true });
  }
});

function options(args) {
  const text = { type: 'string' };
  let values;
  try {
    ({ values } = parseArgs({ args, options: { frames: text, size: text, quality: text, 'write-docs': { type: 'boolean', default: false } } }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const { frames = '2000', size = '1920x1080', quality = 'fast', 'write-docs': writeDocs } = values;
  if (!/^\d+$/.test(frames) || Number(frames) < 10) throw new Stop('--frames must be a whole number from 10.');
  if (!/^\d+x\d+$/.test(size)) throw new Stop('--size must look like 1920x1080.');
  if (!['fast', 'best'].includes(quality)) throw new Stop('--quality must be fast or best.');
  return { frames: Number(frames), size: size.split('x').map(Number), quality, writeDocs };
}

/** Segments the video as a person would and returns `{ seconds, opened, samples, done, stepped }`; memory in bytes. */
async function segmented(browser, address, quality) {
  const page = await browser.newPage();
  page.setDefaultTimeout(0);
  await page.goto(`${address}#sample=intel-two-cars&quality=${quality}&masks=groups`);
  await reached(page, '#run', 'done');
  const session = await browser.newBrowserCDPSession();
  await page.locator('#open-pair').setInputFiles(VIDEO);
  await page.waitForFunction(() => document.querySelector('#clip-name').textContent !== '');
  await reached(page, '#run', 'done');
  const opened = await memory(session);
  await page.locator('#clip-segment').click();
  await reached(page, '#clip-run', 'working');
  const began = Date.now();
  const samples = [];
  let share = 0;
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
    samples.push({ seconds: (Date.now() - began) / 1000, share: value === null ? null : Number(value), text, bytes: await memory(session) });
    // The share begins anew when all pairs are solved.
    if (value !== null && (Number(value) >= share + 0.1 || Number(value) < share)) {
      share = Number(value);
      console.log(`${samples.at(-1).seconds.toFixed(0)} s, ${text}, ${mib(samples.at(-1).bytes)} MiB`);
    }
    await sleep(INTERVAL);
  }
  const seconds = (Date.now() - began) / 1000;
  const status = await page.locator('#clip-status').textContent();
  const done = await memory(session);
  const track = page.locator('#track');
  for (const key of ['End', 'Home', ...Array.from({ length: 30 }, () => 'PageUp')]) {
    await track.press(key);
    await reached(page, '#run', 'done');
  }
  return { seconds, status, opened, samples, done, stepped: await memory(session) };
}

async function reached(page, selector, phase) {
  await page.waitForFunction(([selector, phase]) => document.querySelector(selector).dataset.phase === phase, [selector, phase]);
}

/** The memory of all processes of the browser, what they share counted once, bytes. */
async function memory(session) {
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  return processInfo.reduce((sum, { id }) => sum + proportional(id), 0);
}

function proportional(id) {
  try {
    return 1024 * Number(/^Pss:\s+(\d+) kB/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, 'utf8'))?.[1] ?? 0);
  } catch {
    return 0; // It has ended meanwhile.
  }
}

function tableOf({ date, processor, cores, chromium, frames, size, quality, seconds, status, opened, samples, done, stepped }) {
  const head = `${processor}, ${cores} cores, Chromium ${chromium}, ${date}: ${frames} frames of ${size.join(' × ')} pixels, quality *${quality}*, in ${seconds.toFixed(0)} seconds, ${(frames / seconds).toFixed(1)} frames a second. “${status}”`;
  const at = Array.from({ length: ROWS }, (_, k) => samples[Math.floor(((k + 1) / ROWS) * (samples.length - 1))]);
  const rows = [['opened', opened], ...at.map(({ seconds, bytes }) => [`after ${seconds.toFixed(0)} s`, bytes]), ['segmented', done], ['after steps to 32 other frames', stepped]];
  return [head, '', '| | memory of the browser, MiB |', '| --- | --- |', ...rows.map(([name, bytes]) => `| ${name} | ${mib(bytes)} |`)].join('\n');
}

function mib(bytes) {
  return (bytes / 2 ** 20).toFixed(0);
}
