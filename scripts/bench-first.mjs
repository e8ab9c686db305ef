// npm run bench:first: the first call in a worker against later ones, without a warm-up, with one that began some time before there
// were frames, and after a whole one; in Node and in headless Chromium. Each run has a process of its own. Options:
//   --runs N       runs of each kind (9)
//   --write-docs   writes the figures to docs/figures, and docs/performance.md from them

import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildPackage } from './lib/builds.mjs';
import { present } from './lib/documented.mjs';
import { launchChromium } from './lib/launch-chromium.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command, must } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';
import { median } from './lib/statistics.mjs';

const FRAMES = join(root, 'out/bench/first');
const SIZES = ['320x240', '640x480'];
/** Milliseconds between the begin of the warm-up and the call; null for none, 'whole' for all that it takes. */
const AHEAD = [null, 50, 100, 200, 'whole'];
const CALLS = 9;
/** Calls that are not counted as later ones: the compiler is still at work. */
const EARLY = 3;
const HOST = '127.0.0.1';

await command(async (args) => {
  const { runs, writeDocs } = options(args);
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  await buildPackage();
  mkdirSync(FRAMES, { recursive: true });
  console.log('Generating the frames (building the native program first if it has changed) …');
  await must('The frames could not be generated.', 'cargo', ['run', '--quiet', '--release', '--locked', '--package', 'benches', '--example', 'ratio', '--', 'scenes', FRAMES, ...SIZES]);
  const server = await serve(root, { host: HOST, headers: {} });
  const address = `http://${HOST}:${server.address().port}/benches/first-call.html`;
  let version = '';
  const places = {
    Node: async (task) => {
      const program = [join(root, 'benches/first-call.mjs'), JSON.stringify(task), FRAMES];
      return JSON.parse((await must('The run failed.', process.execPath, program, { output: 'collect' })).stdout);
    },
    Chromium: async (task) => {
      const browser = await launchChromium(chromium.path);
      try {
        version = browser.version();
        const page = await browser.newPage();
        await page.goto(address, { waitUntil: 'load' });
        return await page.evaluate((task) => globalThis.firstCalls(task), { ...task, frames: '/out/bench/first' });
      } finally {
        await browser.close();
      }
    },
  };
  try {
    const found = {};
    for (let run = 0; run < runs; run += 1) {
      console.log(`Run ${run + 1} of ${runs}`);
      for (const [place, measure] of Object.entries(places)) {
        for (const size of SIZES) for (const ahead of AHEAD) ((found[`${place} ${size}`] ??= {})[ahead] ??= []).push(await measure({ size, ahead, calls: CALLS }));
      }
    }
    const origin = { command: 'npm run bench:first', node: process.versions.node, chromium: version };
    present('first', origin, { quality: 'fast', runs, rows: rowsOf(found) }, writeDocs);
  } finally {
    server.close();
    server.closeAllConnections();
    rmSync(FRAMES, { recursive: true, force: true });
  }
});

function options(args) {
  let values;
  try {
    ({ values } = parseArgs({ args, options: { runs: { type: 'string', default: '9' }, 'write-docs': { type: 'boolean', default: false } } }));
  } catch (error) {
    throw new Stop(error.message);
  }
  const runs = Number(values.runs);
  if (!Number.isInteger(runs) || runs < 1) throw new Stop('--runs must be a whole number from 1.');
  return { runs, writeDocs: values['write-docs'] };
}

/** Medians in milliseconds: of later calls, and of the first one by how long before it the warm-up began. */
function rowsOf(found) {
  return Object.entries(found).map(([name, byAhead]) => {
    const [place, size] = name.split(' ');
    const later = median(Object.values(byAhead).flat().flatMap((times) => times.slice(EARLY)));
    const first = AHEAD.map((ahead) => ({ ahead, milliseconds: median(byAhead[ahead].map(([first]) => first)) }));
    return { place, size, later, first };
  });
}
