// npm run soak [-- PART …]: what takes long, in parts. Each run goes on where the last one stopped, begins nothing after the minutes given, and
// ends with a line for each part that says when it last passed. What is done is in out/soak/state.json.
//
// Tests that npm test leaves out, each a program that runs to its end: those of lib/parts.mjs, RARE. Others count, for one build of the package,
// in quality fast at 320 × 240:
//   pairs         10,000 pairs in Node
//   clip          5,000 frames of a clip as a stream
// After each batch the memory must not have grown, and a reference pair must still have the same answer.
//   --minutes N   for this run (15)
//   --count N     another number for the part that is named
//   --jobs N      workers of pools (2)
//   --again       forgets what is done of these parts
//   --list        says when each part last passed, and runs nothing

import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildPackage } from './lib/builds.mjs';
import { RARE, needsOf } from './lib/parts.mjs';
import { prepare } from './lib/prepare.mjs';
import { inProject, projectText, root } from './lib/project.mjs';
import { Stop, command, run } from './lib/run.mjs';

/** The files that are tested. */
const BUILT = ['pkg/wasm/veronese_bg.wasm', 'pkg/wasm/codecs/veronese_codecs_bg.wasm', 'pkg/dist/node.js', 'pkg/dist/calls.js'];
const STATE = 'out/soak/state.json';
/** How many, of what, and the generator. Those that need the built package are imported once it is there. */
const COUNTED = {
  pairs: { total: 10_000, unit: 'pairs', load: async () => (await import('./lib/soak/pairs.mjs')).pairs },
  clip: { total: 5000, unit: 'frames', load: async () => (await import('./lib/soak/clip.mjs')).clip },
};
const PROGRAMS = Object.entries(RARE).map(([name, part]) => [name, { total: 1, unit: part.title, needs: part.needs, load: async () => programOf(part) }]);
const PARTS = { ...Object.fromEntries(PROGRAMS), ...COUNTED };
/** Between lines about the progress, milliseconds. */
const PAUSE = 15_000;

await command(async (args) => {
  const { parts, minutes, again, list, ...options } = parse(args);
  if (list) {
    conclude(parts, stored(), options.count);
    return 0;
  }
  const setup = await prepare(needsOf(parts.map((part) => PARTS[part])));
  await buildPackage();
  const state = resumed(parts, again);
  const until = Date.now() + 60_000 * minutes;
  let failed = 0;
  for (const part of parts) {
    if (Date.now() >= until) break;
    try {
      await go(part, state, until, { ...options, setup });
    } catch (error) {
      // The parts after it are independent of it.
      console.error(`${part} FAILED: ${error instanceof Stop ? error.message : error.stack}`);
      failed += 1;
    }
  }
  conclude(parts, state, options.count);
  return failed > 0 ? 1 : 0;
});

/** Goes on with a part until it is done or the time is up. */
async function go(part, state, until, { setup, count, ...options }) {
  const { total: usual, unit, load } = PARTS[part];
  const total = count ?? usual;
  let done = state.done[part] ?? 0;
  if (done >= total) return;
  console.log(`${part}: ${total === 1 ? unit : `${total} ${unit}`}${done > 0 ? `, going on after ${done}` : ''}`);
  const generator = await load();
  let said = 0;
  for await (const { done: now, note } of generator({ from: done, total, references: state.references, setup, ...options })) {
    done = state.done[part] = now;
    if (done >= total) state.passed[part] = { at: new Date().toISOString(), commit: await commit() };
    store(state);
    if (note && Date.now() - said >= PAUSE) {
      console.log(`  ${done} of ${total}, ${note}`);
      said = Date.now();
    }
    if (Date.now() >= until) break;
  }
}

/** A test program as a part: all of it or nothing. */
function programOf({ run: runTests }) {
  return async function* ({ setup }) {
    const { passed, failed, skipped, failures, note } = await runTests(setup);
    if (failed > 0) throw new Stop([`${failed} of ${passed + failed} failed`, ...failures, ...(note ? [note] : [])].join('\n  '));
    console.log(`  ${passed} passed${skipped > 0 ? `, ${skipped} skipped` : ''}`);
    yield { done: 1 };
  };
}

/** A line for each part. */
function conclude(parts, { done, passed }, count) {
  console.log();
  for (const part of parts) {
    const { total: usual, unit } = PARTS[part];
    const total = count ?? usual;
    const last = passed[part] ? `last passed ${passed[part].at.slice(0, 16).replace('T', ' ')} UTC, commit ${passed[part].commit}` : 'has not passed yet';
    const under = (done[part] ?? 0) > 0 && done[part] < total ? `; ${done[part]} of ${total} ${unit} done since` : '';
    console.log(`${part.padEnd(12)} ${last}${under}`);
  }
}

function parse(args) {
  const text = (value) => ({ type: 'string', ...(value === undefined ? {} : { default: value }) });
  const flag = { type: 'boolean', default: false };
  let found;
  try {
    const known = { minutes: text('15'), count: text(), jobs: text('2'), again: flag, list: flag };
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
  if (values.count !== undefined && !(parts.length === 1 && Object.hasOwn(COUNTED, parts[0]))) throw new Stop(`--count is for one of ${Object.keys(COUNTED).join(', ')}.`);
  return {
    parts,
    again: values.again,
    list: values.list,
    minutes: number('minutes', (value) => value > 0 && value <= 600, 'a number of minutes up to 600'),
    jobs: number('jobs', positive, 'a whole number from 1'),
    count: values.count === undefined ? undefined : number('count', positive, 'a whole number from 1'),
  };
}

function stored() {
  const none = { references: {}, done: {}, passed: {} };
  return inProject(STATE) ? { ...none, ...JSON.parse(projectText(STATE)) } : none;
}

/** The stored state: empty if the package is another one, or the parts are complete and asked for again. When parts passed stays. */
function resumed(parts, again) {
  const sum = createHash('sha256');
  for (const file of BUILT) sum.update(readFileSync(join(root, file)));
  const built = sum.digest('hex');
  const old = stored();
  if (old.built !== built) return { built, references: {}, done: {}, passed: old.passed };
  if (again) for (const part of parts) delete old.done[part];
  return old;
}

async function commit() {
  if (!existsSync(join(root, '.git'))) return 'unknown';
  const [head, changes] = await Promise.all([['rev-parse', '--short', 'HEAD'], ['status', '--porcelain', '--untracked-files=no']].map((args) => run('git', args, { output: 'collect' })));
  return `${head.stdout.trim()}${changes.stdout === '' ? '' : ' with changes'}`;
}

function store(state) {
  mkdirSync(join(root, 'out/soak'), { recursive: true });
  writeFileSync(join(root, STATE), `${JSON.stringify(state, null, 2)}\n`);
}
