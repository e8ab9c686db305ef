// npm run soak [-- PART …]: what takes long, in parts. Each run goes on where the last one stopped, begins nothing after the minutes given,
// and says how far it is. Everything is in quality fast at 320 × 240. What is done is in out/soak/state.json, for one build of the package.
//   tests      the long tests: those that npm test ignores, whole sweeps, many more random cases. Each program runs to its end
//   pairs      10,000 pairs in Node
//   page       2,000 pairs in a page of headless Chromium
//   clip       5,000 frames of a clip as a stream
//   kills      200 worker threads that are ended while they work
//   hostile    20,000 calls at random with values that do not belong there
// After each batch the memory must not have grown, and a reference pair must still have the same answer.
//   --minutes N   for this run (15)
//   --count N     another number for the part that is named
//   --seed S      of hostile and kills (1)
//   --jobs N      workers of pools (2)
//   --again       forgets what is done of these parts

import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildModules, buildPackage, buildPage } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { inProject, projectText, root } from './lib/project.mjs';
import { Stop, command } from './lib/run.mjs';
import { RUN_COUNT, tests } from './lib/soak/tests.mjs';

/** What is tested. */
const BUILT = ['pkg/wasm/veronese_bg.wasm', 'pkg/wasm/codecs/veronese_codecs_bg.wasm', 'pkg/dist/node.js', 'pkg/dist/calls.js', 'pkg/dist/web.js'];
const STATE = 'out/soak/state.json';
/** How many, of what, and the generator. Those that need the built package are imported once it is there. */
const PARTS = {
  pairs: [10_000, 'pairs', async () => (await import('./lib/soak/pairs.mjs')).pairs],
  page: [2000, 'pairs in the page', async () => (await import('./lib/soak/page.mjs')).page],
  clip: [5000, 'frames', async () => (await import('./lib/soak/clip.mjs')).clip],
  kills: [200, 'kills', async () => (await import('./lib/soak/kills.mjs')).kills],
  hostile: [20_000, 'calls', async () => (await import('./lib/soak/hostile.mjs')).hostile],
  tests: [RUN_COUNT, 'programs', async () => tests],
};
/** Between lines about the progress, milliseconds. */
const PAUSE = 15_000;

await command(async (args) => {
  const { parts, minutes, count, seed, jobs, again } = options(args);
  const { chromium } = await prepare({ browser: parts.some((part) => part === 'page' || part === 'tests') });
  await buildModules();
  await buildPackage();
  if (parts.includes('tests')) await buildPage();
  const until = Date.now() + 60_000 * minutes;
  const state = stored(parts, again, seed);
  for (const part of parts) {
    const [usual, unit, load] = PARTS[part];
    const total = count ?? usual;
    let done = Math.min(state.done[part] ?? 0, total);
    if (done < total && Date.now() >= until) break;
    const generator = await load();
    let said = 0;
    if (done < total) console.log(`${part}: ${total} ${unit}${done > 0 ? `, going on after ${done}` : ''}`);
    for await (const { done: now, note } of done < total ? generator({ from: done, total, references: state.references, seed, jobs, chromium }) : []) {
      done = now;
      state.done[part] = done;
      store(state);
      if (Date.now() - said >= PAUSE) {
        console.log(`  ${done} of ${total}, ${note}`);
        said = Date.now();
      }
      if (Date.now() >= until) break;
    }
  }
  const rows = parts.map((part) => ({ part, unit: PARTS[part][1], total: count ?? PARTS[part][0], done: state.done[part] ?? 0 }));
  console.log(`\n${rows.map(({ part, unit, total, done }) => `${part}: ${Math.min(done, total)} of ${total} ${unit}${done >= total ? ', done' : ''}`).join('\n')}`);
  const isDone = rows.every(({ done, total }) => done >= total);
  console.log(isDone ? 'Everything has passed; --again begins anew.' : 'Nothing has failed; run it again to go on.');
});

function options(args) {
  const text = (value) => ({ type: 'string', ...(value === undefined ? {} : { default: value }) });
  let found;
  try {
    const known = { minutes: text('15'), count: text(), seed: text('1'), jobs: text('2'), again: { type: 'boolean', default: false } };
    found = parseArgs({ args, options: known, allowPositionals: true });
  } catch (error) {
    throw new Stop(error.message);
  }
  const { values, positionals } = found;
  const unknown = positionals.filter((part) => !Object.hasOwn(PARTS, part));
  if (unknown.length > 0) throw new Stop(`There is no part ${unknown.join(' and no ')}: name some of ${Object.keys(PARTS).join(', ')}.`);
  const parts = positionals.length > 0 ? positionals : Object.keys(PARTS);
  const number = (name, isRight, words) => {
    const value = Number(values[name]);
    if (!isRight(value)) throw new Stop(`--${name} must be ${words}.`);
    return value;
  };
  const positive = (value) => Number.isInteger(value) && value > 0;
  if (values.count !== undefined && (parts.length !== 1 || parts[0] === 'tests')) throw new Stop('--count is for one part: name it, and not tests.');
  return {
    parts,
    again: values.again,
    minutes: number('minutes', (value) => value > 0 && value <= 600, 'a number of minutes up to 600'),
    seed: number('seed', (value) => Number.isInteger(value) && value >= 0 && value < 2 ** 31, 'a whole number from 0'),
    jobs: number('jobs', positive, 'a whole number from 1'),
    count: values.count === undefined ? undefined : number('count', positive, 'a whole number from 1'),
  };
}

/** What is done: nothing if the module or the seed is another one. */
function stored(parts, again, seed) {
  const sum = createHash('sha256');
  for (const file of BUILT) sum.update(readFileSync(join(root, file)));
  const module = sum.digest('hex');
  const old = inProject(STATE) ? JSON.parse(projectText(STATE)) : {};
  if (old.module !== module || old.seed !== seed) return { module, seed, references: {}, done: {} };
  if (again) for (const part of parts) delete old.done[part];
  return old;
}

function store(state) {
  mkdirSync(join(root, 'out/soak'), { recursive: true });
  writeFileSync(join(root, STATE), `${JSON.stringify(state, null, 2)}\n`);
}
