// npm test: all tests and checks of every day, of which those run whose inputs have changed since they passed.
//   npm test -- --all                              all of them
//   npm test -- WORD                               the tests whose file or name has the word
//   npm test -- --part native,page [WORD]          these parts, or these of their tests
//   npm test -- --stress [--times N] [WORD]        looks for tests that fail on a busy or slow machine: see lib/stress.mjs
// What takes long is `npm run soak`.
//
// Two lanes run side by side, and what a part writes is shown when it ends. Cargo goes first where cores are short: much of it runs on one
// core, and the page, whose tests fill all of them, comes last. A test that fails is a failure: nothing is tried again. At the end a table
// says what each part took.

import { parseArgs } from 'node:util';

import { DAILY, needsOf } from './lib/parts.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command, inPart, run, say } from './lib/run.mjs';
import { versionOfRust } from './lib/rust.mjs';
import { TIMES, stress } from './lib/stress.mjs';
import { NOTHING } from './lib/tests.mjs';
import { keepPassed, passedBefore, stateOf } from './lib/unchanged.mjs';

const NICENESS = { cargo: 0, node: 10 };
const SETUP = { title: 'set-up', budget: 225 };

await command(async (args) => {
  const { names, word, all, times } = options(args);
  const start = Date.now();
  const setup = await measured(SETUP, {}, async () => ({ ...NOTHING, setup: await prepare(needsOf(names.map((name) => DAILY[name]))) }));
  if (setup.failed > 0) throw new Stop(setup.note);
  if (times !== undefined)
    return stress(
      names.map((name) => DAILY[name]),
      { ...setup.setup, word },
      times,
    );
  const results = [setup, ...(await runParts(names, { ...setup.setup, word, all, versions: await versionsOf(setup.setup) }))];
  const code = summarise(results, (Date.now() - start) / 1000);
  if (word === undefined || results.some(({ passed, failed }) => passed + failed > 0)) return code;
  throw new Stop(`No test has '${word}' in the name of its file or its own.`);
});

/** What runs: the parts, the word that their tests are to have, whether those that have passed run again, how often with `--stress`. */
function options(args) {
  let found;
  try {
    const flag = { type: 'boolean', default: false };
    found = parseArgs({
      args,
      options: { part: { type: 'string' }, all: flag, stress: flag, times: { type: 'string' } },
      allowPositionals: true,
    });
  } catch (error) {
    throw new Stop(error.message);
  }
  const { values, positionals } = found;
  // Several words are one: names have spaces.
  const word = positionals.length > 0 ? positionals.join(' ') : undefined;
  const known = Object.keys(DAILY).filter((name) => (word === undefined || DAILY[name].named) && (!values.stress || DAILY[name].stressed));
  const names = values.part?.split(',') ?? known;
  const unknown = names.find((name) => !known.includes(name));
  if (unknown !== undefined) throw new Stop(`There is no part '${unknown}'; there are ${known.join(', ')}. \`npm run soak\` has more.`);
  if (values.times !== undefined && !(values.stress && /^[1-9]\d?$/.test(values.times)))
    throw new Stop('--times is a number from 1 to 99, with --stress.');
  // Who names parts or a word wants to see them run.
  return {
    names,
    word,
    all: values.all || values.part !== undefined || word !== undefined,
    times: values.stress ? Number(values.times ?? TIMES) : undefined,
  };
}

/** The versions of the programs that tests run with. */
async function versionsOf({ chromium, ownPython }) {
  const asked = [
    [chromium?.path, '--version'],
    [ownPython?.python, '--version'],
  ].filter(([program]) => program !== undefined);
  const told = await Promise.all(asked.map(async ([program, flag]) => (await run(program, [flag], { output: 'collect' })).text));
  return [process.version, process.arch, await versionOfRust(), ...told];
}

/** Runs parts in their lanes: a lane that has no more of its own takes those that are for either. The results have the order of `names`. */
async function runParts(names, setup) {
  const waiting = [...names];
  const next = (lane) => waiting.splice(waiting.findIndex((name) => DAILY[name].lane === lane) >>> 0, 1)[0];
  const results = {};
  const runLane = async (lane) => {
    for (let name; (name = next(lane) ?? next('either')) !== undefined;) {
      results[name] = names.length === 1 ? await runPart(name, setup) : await runBeside(name, setup, NICENESS[lane]);
    }
  };
  await Promise.all(Object.keys(NICENESS).map(runLane));
  return names.map((name) => results[name]);
}

/** Runs a part while others run, and shows what it has written when it ends. */
async function runBeside(name, setup, niceness) {
  const { title } = DAILY[name];
  console.log(`… ${title}: begin`);
  const pieces = [];
  try {
    return await runPart(name, setup, { write: (piece) => pieces.push(Buffer.from(piece)), niceness });
  } finally {
    process.stdout.write(Buffer.concat(pieces));
    console.log(`… ${title}: end`);
  }
}

/** Runs one part, unless it has passed with what there is; a failure does not stop the parts after it. */
function runPart(name, setup, options = {}) {
  const part = DAILY[name];
  return measured(part, options, async () => {
    say(`\n=== ${part.title} ===`);
    const state = part.inputs && setup.word === undefined ? await stateOf(part.inputs, setup.versions) : undefined;
    const before = setup.all ? undefined : passedBefore(name, state);
    if (before !== undefined) {
      say(`Nothing has changed since they passed; \`npm test -- --all\` runs them.`);
      return { ...NOTHING, unchanged: before.passed };
    }
    const outcome = await part.run(setup);
    if (setup.word === undefined) keepPassed(name, outcome.failed === 0 && outcome.note === undefined ? state : undefined, outcome.passed);
    return outcome;
  });
}

/** The outcome of a part, with its title and budget and the seconds that it took. */
async function measured({ title, budget }, options, main) {
  const start = Date.now();
  const { outcome, processor } = await inPart(options, () =>
    main().catch((error) => {
      if (!(error instanceof Stop)) throw error;
      say(error.message);
      return { ...NOTHING, failed: 1, note: error.message };
    }),
  );
  return { title, budget, processor, seconds: (Date.now() - start) / 1000, ...outcome };
}

/** Prints the table, and what failed. Returns the exit code. */
function summarise(results, whole) {
  console.log(`\n=== summary ===\n${row('part', 'tests', 'time', 'processor', 'budget')}`);
  for (const { title, passed, failed, skipped, unchanged, seconds, processor, budget, note, failures } of results) {
    const counts = [
      passed > 0 || failed > 0 ? `${passed}` : '',
      failed > 0 ? `${failed} FAILED` : '',
      skipped > 0 ? `${skipped} skipped` : '',
      unchanged === undefined ? '' : `${unchanged} unchanged`,
    ];
    const over = processor > budget && unchanged === undefined ? ' (over)' : '';
    console.log(
      row(title, counts.filter(Boolean).join(', ') || '–', inSeconds(seconds), inSeconds(processor), `${inSeconds(budget)}${over}`),
    );
    if (note) console.log(`        ${note}`);
    for (const failure of failures.slice(0, 10)) console.log(`        failed: ${failure}`);
  }
  const total = (kind) => results.reduce((sum, result) => sum + (result[kind] ?? 0), 0);
  const unchanged = total('unchanged');
  console.log(row('all', '', inSeconds(whole), inSeconds(total('processor') || undefined), inSeconds(total('budget'))));
  if (unchanged > 0) console.log(`\n${unchanged} tests have passed before, with the same inputs. \`npm test -- --all\` runs them again.`);
  console.log(`\n${total('passed')} passed, ${total('failed')} failed, after ${whole.toFixed(0)} s`);
  return total('failed') === 0 ? 0 : 1;
}

function row(title, tests, time, processor, budget) {
  return [title.padEnd(44), tests.padEnd(26), time.padStart(8), processor.padStart(10), budget.padStart(8)].join(' ');
}

function inSeconds(seconds) {
  return seconds === undefined ? '–' : `${seconds.toFixed(0)} s`;
}
