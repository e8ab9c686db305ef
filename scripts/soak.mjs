// npm run soak [-- PART …]: the parts of the tests that npm test leaves out, each to its end: RARE of lib/parts.mjs. Each run goes on where the
// last one stopped, begins nothing after the minutes given, and ends with a line for each part and when it last passed. The state is in
// out/soak/state.json.
//   --minutes N   for this run (15)
//   --again       forgets that these parts are done
//   --list        shows when each part last passed, and runs nothing

import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { buildPackage } from './lib/builds.mjs';
import { RARE, needsOf } from './lib/parts.mjs';
import { prepare } from './lib/prepare.mjs';
import { inProject, projectText, root } from './lib/project.mjs';
import { Stop, command, run } from './lib/run.mjs';

/** Where these have changed, nothing is done yet. */
const BUILT = [
  'pkg/wasm/veronese_bg.wasm',
  'pkg/wasm/codecs/veronese_codecs_bg.wasm',
  'pkg/dist/node.js',
  'pkg/dist/calls.js',
  'pkg/dist/web.js',
];
const STATE = 'out/soak/state.json';

await command(async (args) => {
  const { parts, minutes, again, list } = parse(args);
  if (list) {
    conclude(parts, stored());
    return 0;
  }
  const setup = await prepare(needsOf(parts.map((part) => RARE[part])));
  await buildPackage();
  const state = resumed(parts, again);
  const until = Date.now() + 60_000 * minutes;
  let failed = 0;
  for (const part of parts.filter((part) => !state.done[part])) {
    if (Date.now() >= until) break;
    try {
      await perform(part, setup);
      state.done[part] = true;
      state.passed[part] = { at: new Date().toISOString(), commit: await commit() };
      store(state);
    } catch (error) {
      // The parts after it are independent of it.
      console.error(`${part} FAILED: ${error instanceof Stop ? error.message : error.stack}`);
      failed += 1;
    }
  }
  conclude(parts, state);
  return failed > 0 ? 1 : 0;
});

async function perform(part, setup) {
  const { title, run: runTests } = RARE[part];
  console.log(`${part}: ${title}`);
  const { passed, failed, skipped, failures, note } = await runTests(setup);
  if (failed > 0) throw new Stop([`${failed} of ${passed + failed} failed`, ...failures, ...(note ? [note] : [])].join('\n  '));
  console.log(`  ${passed} passed${skipped > 0 ? `, ${skipped} skipped` : ''}`);
}

/** A line for each part. */
function conclude(parts, { passed }) {
  console.log();
  for (const part of parts) {
    const last = passed[part]
      ? `last passed ${passed[part].at.slice(0, 16).replace('T', ' ')} UTC, commit ${passed[part].commit}`
      : 'has not passed yet';
    console.log(`${part.padEnd(12)} ${last}`);
  }
}

function parse(args) {
  const flag = { type: 'boolean', default: false };
  let found;
  try {
    found = parseArgs({ args, options: { minutes: { type: 'string', default: '15' }, again: flag, list: flag }, allowPositionals: true });
  } catch (error) {
    throw new Stop(error.message);
  }
  const {
    values: { minutes, again, list },
    positionals,
  } = found;
  const unknown = positionals.filter((part) => !Object.hasOwn(RARE, part));
  if (unknown.length > 0) throw new Stop(`There is no part ${unknown.join(' and no ')}: name some of ${Object.keys(RARE).join(', ')}.`);
  if (!(Number(minutes) > 0 && Number(minutes) <= 600)) throw new Stop('--minutes must be a number of minutes up to 600.');
  return { parts: positionals.length > 0 ? positionals : Object.keys(RARE), again, list, minutes: Number(minutes) };
}

function stored() {
  const none = { done: {}, passed: {} };
  return inProject(STATE) ? { ...none, ...JSON.parse(projectText(STATE)) } : none;
}

/** The stored state: no part is done if the package is another one, or if it is asked for again. */
function resumed(parts, again) {
  const sum = createHash('sha256');
  for (const file of BUILT) sum.update(readFileSync(join(root, file)));
  const built = sum.digest('hex');
  const { built: old, done, passed } = stored();
  const kept = old === built ? Object.entries(done).filter(([part]) => !(again && parts.includes(part))) : [];
  return { built, done: Object.fromEntries(kept), passed };
}

async function commit() {
  if (!existsSync(join(root, '.git'))) return 'unknown';
  const [head, changes] = await Promise.all(
    [
      ['rev-parse', '--short', 'HEAD'],
      ['status', '--porcelain', '--untracked-files=no'],
    ].map((args) => run('git', args, { output: 'collect' })),
  );
  return `${head.stdout.trim()}${changes.stdout === '' ? '' : ' with changes'}`;
}

function store(state) {
  mkdirSync(join(root, 'out/soak'), { recursive: true });
  writeFileSync(join(root, STATE), `${JSON.stringify(state, null, 2)}\n`);
}
