// Runs all tests of the package, several files in each process: every process loads and compiles the package anew. Those that measure or
// change their process, or what it has loaded, have one of their own.
//
// node test/all.mjs, or node test/all.mjs FILE … for these in one process

import { spawn } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { before, describe } from 'node:test';
import { fileURLToPath } from 'node:url';

const ALONE = ['entries', 'hostile', 'loading', 'long', 'memory', 'warming'].map((name) => `./${name}.test.mjs`);
const PROCESSES = 6;

const given = process.argv.slice(2);
if (given.length > 0) await runHere(given);
else await runAll();

async function runHere(names) {
  for (const name of names) {
    await import(new URL(name, import.meta.url));
    // Suites and tests run in the order in which they were made.
    await new Promise((resolve) => describe(`end of ${name}`, () => before(() => resolve())));
  }
}

async function runAll() {
  const names = ['./', './scripts/'].flatMap((folder) => readdirSync(new URL(folder, import.meta.url)).filter((name) => name.endsWith('.test.mjs')).map((name) => folder + name));
  const shared = names.filter((name) => !ALONE.includes(name));
  const groups = Array.from({ length: PROCESSES }, (_, k) => shared.filter((_, at) => at % PROCESSES === k));
  groups.push(...ALONE.map((name) => [name]));
  const lane = async () => {
    for (let group = groups.shift(); group; group = groups.shift()) await run(group);
  };
  await Promise.all(Array.from({ length: Math.max(1, availableParallelism() - 1) }, lane));
}

/** Runs files in a process and shows what it says when it has ended. */
function run(group) {
  return new Promise((resolve) => {
    const child = spawn(process.execPath, ['--test-reporter=tap', fileURLToPath(import.meta.url), ...group], { stdio: ['ignore', 'pipe', 'inherit'] });
    const pieces = [];
    child.stdout.on('data', (piece) => pieces.push(piece));
    child.on('close', (code) => {
      process.stdout.write(Buffer.concat(pieces));
      if (code !== 0) process.exitCode = 1;
      resolve();
    });
  });
}
