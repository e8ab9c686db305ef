// npm test: all tests and checks of every day. `npm test -- WORD` runs the tests whose file or name has the word, `npm test -- --part native,page`
// these parts alone, or with a word these of their tests. What takes long is `npm run soak`.
//
// Two lanes run side by side, and what a part writes is shown when it ends. Cargo takes the cores that the page leaves. A test that fails is
// a failure: nothing is tried again. At the end a table says what each part took.

import { parseArgs } from 'node:util';

import { DAILY, needsOf } from './lib/parts.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command, inPart, say } from './lib/run.mjs';
import { NOTHING } from './lib/tests.mjs';

const NICENESS = { cargo: 10, node: 0 };
const SETUP = 'set-up';

await command(async (args) => {
  const { names, word } = options(args);
  const start = Date.now();
  const setup = { ...(await prepare(needsOf(names.map((name) => DAILY[name])))), word };
  const results = [{ title: SETUP, seconds: (Date.now() - start) / 1000, ...NOTHING }, ...(await runParts(names, setup))];
  const code = summarise(results, (Date.now() - start) / 1000);
  if (word === undefined || results.some(({ passed, failed }) => passed + failed > 0)) return code;
  throw new Stop(`No test has '${word}' in the name of its file or its own.`);
});

/** The parts that run, and the word that their tests are to have. */
function options(args) {
  let found;
  try {
    found = parseArgs({ args, options: { part: { type: 'string' } }, allowPositionals: true });
  } catch (error) {
    throw new Stop(error.message);
  }
  const { values, positionals } = found;
  // Several words are one: names have spaces.
  const word = positionals.length > 0 ? positionals.join(' ') : undefined;
  const all = Object.keys(DAILY).filter((name) => word === undefined || DAILY[name].named);
  const names = values.part?.split(',') ?? all;
  const unknown = names.find((name) => !all.includes(name));
  if (unknown !== undefined) throw new Stop(`There is no part '${unknown}'; there are ${all.join(', ')}. \`npm run soak\` has more.`);
  return { names, word };
}

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
async function runPart(name, setup, options = {}) {
  const { title, run } = DAILY[name];
  return inPart(options, async () => {
    say(`\n=== ${title} ===`);
    const start = Date.now();
    const outcome = await run(setup).catch((error) => {
      if (!(error instanceof Stop)) throw error;
      say(error.message);
      return { ...NOTHING, failed: 1, note: error.message };
    });
    return { title, seconds: (Date.now() - start) / 1000, ...outcome };
  });
}

/** Prints the table, and what failed. Returns the exit code. */
function summarise(results, whole) {
  console.log(`\n=== summary ===\n${row('part', 'tests', 'time')}`);
  for (const { title, passed, failed, skipped, seconds, note, failures } of results) {
    const counts = [passed > 0 || failed > 0 ? `${passed}` : '–', failed > 0 ? `${failed} FAILED` : '', skipped > 0 ? `${skipped} skipped` : ''];
    console.log(row(title, counts.filter(Boolean).join(', '), `${seconds.toFixed(0)} s`));
    if (note) console.log(`        ${note}`);
    for (const failure of failures.slice(0, 10)) console.log(`        failed: ${failure}`);
  }
  const total = (kind) => results.reduce((sum, result) => sum + result[kind], 0);
  console.log(`\n${total('passed')} passed, ${total('failed')} failed, after ${whole.toFixed(0)} s`);
  return total('failed') === 0 ? 0 : 1;
}

function row(title, tests, time) {
  return [title.padEnd(44), tests.padEnd(26), time.padStart(9)].join(' ');
}
