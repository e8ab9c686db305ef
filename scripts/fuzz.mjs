// npm run fuzz [-- TARGET …] [-- --seconds N]: runs the fuzz targets of fuzz/targets one after another, each for N seconds (600), beginning
// with the inputs in fuzz/corpus. Needs a nightly toolchain and cargo-fuzz. An input that fails is kept in fuzz/artifacts.
//   --seconds N   for each target
//   --keep        adds the inputs that reached something new to fuzz/corpus, as few and as small as possible; otherwise they are forgotten

import { cpSync, existsSync, mkdirSync, readdirSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';

import { root } from './lib/project.mjs';
import { Stop, command, must, run } from './lib/run.mjs';

const FUZZ = join(root, 'fuzz');
const TARGETS = readdirSync(join(FUZZ, 'targets'))
  .map((name) => name.replace(/\.rs$/, ''))
  .sort();
/** Longest input: frames are small, and what is longer shows no more. */
const LONGEST = 4096;
/** One input may take this long, seconds (a busy machine leaves little to what is nice), and this much memory, MiB. A picture of 4096 × 4096 pixels takes 400 MiB. */
const LIMITS = ['-timeout=300', '-rss_limit_mb=2048', `-max_len=${LONGEST}`];
/** All inputs that are kept, bytes. */
const MOST_KEPT = 200_000;

await command(async (args) => {
  const { targets, seconds, keep } = options(args);
  await checkTools();
  console.log('Building the targets if they have changed (some minutes when everything is new) …');
  await must('The targets could not be built.', 'nice', fuzz('build'));
  const failed = [];
  for (const target of targets) {
    const kept = join(FUZZ, 'corpus', target);
    // Inputs that are found go to the first folder.
    const found = join(root, 'out', 'fuzz', target);
    for (const folder of [kept, found]) mkdirSync(folder, { recursive: true });
    console.log(`\n${target}, ${seconds} s …`);
    const { code } = await run(
      'nice',
      fuzz('run', target, found, kept, '--', ...LIMITS, `-max_total_time=${seconds}`, '-print_final_stats=1'),
    );
    if (code !== 0) failed.push(target);
    else if (keep) await minimise(target, kept, found);
  }
  const bytes = TARGETS.reduce((sum, target) => sum + sizeOf(join(FUZZ, 'corpus', target)), 0);
  if (keep && bytes > MOST_KEPT) throw new Stop(`fuzz/corpus has ${bytes} bytes, more than ${MOST_KEPT}: remove some inputs.`);
  console.log(
    failed.length === 0
      ? `\n${targets.length} targets, nothing failed.`
      : `\nFAILED: ${failed.join(', ')}. See above; the inputs are in fuzz/artifacts.`,
  );
  return failed.length === 0 ? 0 : 1;
});

function options(args) {
  let found;
  try {
    const known = { seconds: { type: 'string', default: '600' }, keep: { type: 'boolean', default: false } };
    found = parseArgs({ args, options: known, allowPositionals: true });
  } catch (error) {
    throw new Stop(error.message);
  }
  const { values, positionals } = found;
  const seconds = Number(values.seconds);
  if (!Number.isInteger(seconds) || seconds < 1) throw new Stop('--seconds must be a whole number from 1.');
  const unknown = positionals.filter((name) => !TARGETS.includes(name));
  if (unknown.length > 0) throw new Stop(`There is no target ${unknown.join(' and no ')}: name some of ${TARGETS.join(', ')}.`);
  return { targets: positionals.length > 0 ? positionals : TARGETS, seconds, keep: values.keep };
}

/** One sentence that names what is missing. */
async function checkTools() {
  const works = async (program, args) => (await run(program, args, { output: 'collect' })).code === 0;
  const missing = [];
  if (!(await works('cargo', ['+nightly', '--version']))) missing.push('a nightly toolchain (`rustup toolchain install nightly`)');
  if (!(await works('cargo', ['fuzz', '--version']))) missing.push('cargo-fuzz (`cargo install cargo-fuzz --locked`)');
  if (missing.length > 0) throw new Stop(`Nothing was fuzzed, because there is no ${missing.join(' and no ')}.`);
}

/** The arguments of `nice` for cargo-fuzz, which gives way to everything else. */
function fuzz(step, ...args) {
  return ['-n', '15', 'cargo', '+nightly', 'fuzz', step, '--fuzz-dir', FUZZ, ...args];
}

/** Of the inputs kept and found, the smallest that reach the same. */
async function minimise(target, kept, found) {
  const least = join(root, 'out', 'fuzz', `${target}-least`);
  rmSync(least, { recursive: true, force: true });
  mkdirSync(least, { recursive: true });
  await must(
    `The inputs of ${target} could not be merged.`,
    'nice',
    fuzz('run', target, least, kept, found, '--', '-set_cover_merge=1', '-use_counters=0', ...LIMITS),
    { output: 'collect' },
  );
  rmSync(kept, { recursive: true });
  cpSync(least, kept, { recursive: true });
}

function sizeOf(folder) {
  return existsSync(folder) ? readdirSync(folder).reduce((sum, name) => sum + statSync(join(folder, name)).size, 0) : 0;
}
