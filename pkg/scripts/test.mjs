// Runs the tests of the package. Files share processes, of which each loads and compiles the package once; those that measure or change
// their process, or what it has loaded, have one of their own.
//
// node scripts/test.mjs

import { spawn } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { fileURLToPath } from 'node:url';

const ALONE = ['annotations', 'entries', 'formats', 'hostile', 'loading', 'long', 'memory', 'readers'];
const PROCESSES = 6;

const tests = fileURLToPath(new URL('../test/', import.meta.url));
const names = ['', 'scripts/'].flatMap((folder) => readdirSync(tests + folder).filter((name) => name.endsWith('.test.mjs')).map((name) => folder + name));
const isAlone = (name) => ALONE.includes(name.replace('.test.mjs', ''));
const shared = names.filter((name) => !isAlone(name));
const groups = [...Array.from({ length: PROCESSES }, (_, k) => shared.filter((_, at) => at % PROCESSES === k)), ...names.filter(isAlone).map((name) => [name])];

/** Runs files in a process and shows what it says when it has ended. */
function run(group) {
  return new Promise((resolve) => {
    const child = spawn(process.execPath, ['--test-reporter=tap', `${tests}support/together.mjs`, ...group], { stdio: ['ignore', 'pipe', 'inherit'] });
    const pieces = [];
    child.stdout.on('data', (piece) => pieces.push(piece));
    child.on('close', (code) => {
      process.stdout.write(Buffer.concat(pieces));
      if (code !== 0) process.exitCode = 1;
      resolve();
    });
  });
}

const lane = async () => {
  for (let group = groups.shift(); group; group = groups.shift()) await run(group);
};
await Promise.all(Array.from({ length: Math.max(1, availableParallelism() - 1) }, lane));
