// npm test: all tests and checks of every day; `npm test -- native page` runs the named parts only. What takes long is `npm run soak`.
//
// Two lanes run side by side, and what a part writes is shown when it ends. Cargo takes the cores that the page leaves. A test that fails is
// a failure: nothing is tried again. At the end a table says what each part took, and which took more than its budget (budgets.json).

import { DAILY, needsOf } from './lib/parts.mjs';
import { prepare } from './lib/prepare.mjs';
import { secondsOf, secondsOfMachine } from './lib/processor.mjs';
import { projectText } from './lib/project.mjs';
import { Stop, command, inPart, say } from './lib/run.mjs';

const NICENESS = { cargo: 10, node: 0 };
const SETUP = 'set-up';
/** A budget is what a part took when everything was new. Machines differ by so much before it is worth a word. */
const AIR = 1.15;
const NOTHING = { passed: 0, failed: 0, skipped: 0, failures: [] };

await command(async (args) => {
  const unknown = args.filter((name) => !Object.hasOwn(DAILY, name));
  if (unknown.length > 0) {
    console.error(`There is no part '${unknown[0]}'; there are ${Object.keys(DAILY).join(', ')}. \`npm run soak\` has more.`);
    return 2;
  }
  const names = args.length > 0 ? args : Object.keys(DAILY);
  const machine = secondsOfMachine();
  const start = Date.now();
  const setup = await inPart({ name: SETUP }, () => prepare(needsOf(names.map((name) => DAILY[name]))));
  const results = [{ name: SETUP, title: SETUP, seconds: (Date.now() - start) / 1000, ...NOTHING }, ...(await runParts(names, setup))];
  return summarise(results, { seconds: (Date.now() - start) / 1000, machine: secondsOfMachine() - machine });
});

/** Runs parts in their lanes; the results have the order of `names`. */
async function runParts(names, setup) {
  const lanes = Object.keys(NICENESS).map((lane) => names.filter((name) => DAILY[name].lane === lane)).filter((own) => own.length > 0);
  const results = {};
  await Promise.all(
    lanes.map(async (own) => {
      for (const name of own) results[name] = lanes.length === 1 ? await runPart(name, setup) : await runBeside(name, setup);
    }),
  );
  return names.map((name) => results[name]);
}

/** Runs a part while others run, and shows what it has written when it ends. */
async function runBeside(name, setup) {
  const { title, lane } = DAILY[name];
  console.log(`… ${title}: begin`);
  const pieces = [];
  try {
    return await runPart(name, setup, { write: (piece) => pieces.push(Buffer.from(piece)), niceness: NICENESS[lane] });
  } finally {
    process.stdout.write(Buffer.concat(pieces));
    console.log(`… ${title}: end`);
  }
}

/** Runs one part; a failure does not stop the parts after it. */
async function runPart(name, setup, options) {
  const { title, run } = DAILY[name];
  return inPart({ name, ...options }, async () => {
    say(`\n=== ${title} ===`);
    const start = Date.now();
    const outcome = await run(setup).catch((error) => {
      if (!(error instanceof Stop)) throw error;
      say(error.message);
      return { ...NOTHING, failed: 1, note: error.message };
    });
    return { name, title, seconds: (Date.now() - start) / 1000, ...outcome };
  });
}

/** Prints the table, and what failed. Returns the exit code. */
function summarise(results, whole) {
  const budgets = JSON.parse(projectText('scripts/budgets.json'));
  console.log(`\n=== summary ===\n${row('part', 'tests', 'processor', 'time', 'budget')}`);
  for (const { name, title, passed, failed, skipped, seconds, note, failures } of results) {
    const processor = secondsOf(name);
    const counts = [passed > 0 || failed > 0 ? `${passed}` : '–', failed > 0 ? `${failed} FAILED` : '', skipped > 0 ? `${skipped} skipped` : ''];
    const over = processor > AIR * budgets[name] ? '  over budget' : '';
    console.log(`${row(title, counts.filter(Boolean).join(', '), inSeconds(processor), inSeconds(seconds), inSeconds(budgets[name]))}${over}`);
    if (note) console.log(`        ${note}`);
    for (const failure of failures.slice(0, 10)) console.log(`        failed: ${failure}`);
  }
  const total = (kind) => results.reduce((sum, result) => sum + result[kind], 0);
  const budget = results.reduce((sum, { name }) => sum + budgets[name], 0);
  console.log(row('the whole machine', '', inSeconds(whole.machine), inSeconds(whole.seconds), inSeconds(budget)));
  console.log(`\n${total('passed')} passed, ${total('failed')} failed`);
  return total('failed') === 0 ? 0 : 1;
}

function row(title, tests, ...numbers) {
  return [title.padEnd(44), tests.padEnd(26), ...numbers.map((number) => number.padStart(9))].join(' ');
}

function inSeconds(value) {
  return value === undefined ? '–' : `${value.toFixed(0)} s`;
}
