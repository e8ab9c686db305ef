// Starts other programs.

import { AsyncLocalStorage } from 'node:async_hooks';
import { spawn } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { setPriority } from 'node:os';

import { isKnown, watchProcessor } from './processor.mjs';
import { environment, root } from './project.mjs';

/** A failure that one sentence explains to the user; commands print it without a stack trace. */
export class Stop extends Error {}

const running = new Set();
const parts = new AsyncLocalStorage();

/**
 * Runs `main` as a part of the work: its messages and the output of its programs go to `write`, where that is given, and its programs get this
 * `niceness` (0 to 19; where cores are short, those with less go first). Returns what `main` returns as `outcome`, with the seconds of
 * processor that its programs took, where the system tells them.
 */
export async function inPart({ write, niceness = 0 }, main) {
  const part = { write, niceness, processor: isKnown ? 0 : undefined };
  return { outcome: await parts.run(part, main), processor: part.processor };
}

/** Shows a line. */
export function say(line = '') {
  show(`${line}\n`, process.stdout);
}

function show(piece, stream) {
  const write = parts.getStore()?.write;
  if (write) write(piece);
  else stream.write(piece);
}

/**
 * Runs a program to its end and never throws.
 *
 * `output`: `inherit` shows what it writes, `collect` keeps it, `both` does both.
 * Returns `{ code, text }`: the exit code (127 if the program could not be started, 128 for a signal) and what it
 * wrote, with standard output in `stdout` alone as well.
 */
export function run(program, args, { output = 'inherit', env = {}, cwd = root } = {}) {
  const part = parts.getStore();
  const pipe = output === 'inherit' && !part?.write ? 'inherit' : 'pipe';
  return new Promise((resolve) => {
    // A process group of its own, so that an interruption reaches the programs that it starts as well.
    const child = spawn(program, args, { cwd, env: merged(env), stdio: ['ignore', pipe, pipe], detached: true });
    if (child.pid) {
      running.add(child);
      if (part?.niceness) giveWay(child.pid, part.niceness);
    }
    const processor = part && isKnown && child.pid ? watchProcessor(child.pid) : undefined;
    const pieces = [];
    const written = [];
    child.stdout?.on('data', (piece) => {
      pieces.push(piece);
      written.push(piece);
      if (output !== 'collect') show(piece, process.stdout);
    });
    child.stderr?.on('data', (piece) => {
      pieces.push(piece);
      if (output !== 'collect') show(piece, process.stderr);
    });
    const finish = (code, note = '') => {
      running.delete(child);
      if (processor) part.processor += processor();
      resolve({ code, text: Buffer.concat(pieces) + note, stdout: Buffer.concat(written).toString() });
    };
    child.on('error', (error) => finish(127, `${program}: ${error.message}\n`));
    child.on('close', (code) => finish(code ?? 128));
  });
}

/** Where cores are short, a program and what it starts get less of them. Linux divides them between sessions first, which have a niceness too. */
function giveWay(pid, niceness) {
  setPriority(pid, niceness);
  try {
    writeFileSync(`/proc/${pid}/autogroup`, `${niceness}`);
  } catch {
    // Another system, or one that knows no sessions.
  }
}

/** Like `run`, but a failure stops the command with `sentence`, after printing the program's output if it was not shown. */
export async function must(sentence, program, args, options = {}) {
  const result = await run(program, args, options);
  if (result.code === 0) return result;
  if (options.output === 'collect') show(result.text, process.stderr);
  throw new Stop(sentence);
}

/**
 * Announces a long step, runs it quietly and reports every minute that it is still running. If the user watches a terminal and
 * nothing else runs at the same time, pass `output: 'inherit'` to show the program's own progress instead.
 */
export async function longStep(announcement, sentence, program, args, options = {}) {
  console.log(`${announcement} …`);
  const start = Date.now();
  const what = announcement.replace(/ \(.*$/, '');
  const reminder = setInterval(() => {
    console.log(`… ${what}: ${Math.round((Date.now() - start) / 60_000)} min so far`);
  }, 60_000);
  try {
    return await must(sentence, program, args, { output: 'collect', ...options });
  } finally {
    clearInterval(reminder);
  }
}

/** Runs a command's main function: a `Stop` becomes one line and exit code 1; any other error keeps its stack trace. */
export async function command(main) {
  try {
    process.exitCode = (await main(process.argv.slice(2))) ?? 0;
  } catch (error) {
    if (!(error instanceof Stop)) throw error;
    console.error(`\n${error.message}`);
    process.exitCode = 1;
  }
}

// The programs started here end with this one, which an interruption ends.
process.on('exit', () => {
  for (const { pid } of running) {
    try {
      process.kill(-pid, 'SIGTERM');
    } catch {
      // It has just ended.
    }
  }
});
const INTERRUPTIONS = { SIGINT: 130, SIGTERM: 143 };
const handlers = Object.entries(INTERRUPTIONS).map(([signal, code]) => {
  const handler = () => process.exit(code);
  process.on(signal, handler);
  return [signal, handler];
});

/** Waits for an interruption, which is the normal way to end from now on; a second one has no effect. */
export function interruption() {
  for (const [signal, handler] of handlers) process.off(signal, handler);
  return new Promise((resolve) => {
    for (const signal of Object.keys(INTERRUPTIONS)) process.on(signal, resolve);
  });
}

/** The environment with changes; `undefined` removes a variable. */
function merged(changes) {
  const env = { ...environment, ...changes };
  for (const [name, value] of Object.entries(changes)) if (value === undefined) delete env[name];
  return env;
}
