// Runs the program: as a call, with streams that collect what it writes, or as a user does, in a process of its own.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Readable, Writable } from 'node:stream';
import { fileURLToPath } from 'node:url';
import { main } from '../../dist/cli.js';
import { stopwatch } from './processor.mjs';

export const program = fileURLToPath(new URL('../../bin/veronese.js', import.meta.url));

/**
 * Runs the program with these arguments, without a process, and with one job where nothing is said of jobs, since each job starts a worker.
 * `onLine(line)` hears each line of its output. Resolves to exit code, output and seconds of a processor.
 */
export async function veronese(args, { stdin = '', onLine } = {}) {
  const seconds = stopwatch();
  const text = { stdout: '', stderr: '' };
  const stdout = new Writable({
    decodeStrings: false,
    write(chunk, _, done) {
      text.stdout += chunk;
      onLine?.(String(chunk));
      done();
    },
  });
  const stderr = { isTTY: false, write: (piece) => (text.stderr += piece) };
  const code = await main(withJobs(args), { stdin: Readable.from([stdin]), stdout, stderr, signal: new AbortController().signal });
  return { code, ...text, seconds: seconds() };
}

function withJobs(args) {
  const [command, ...rest] = args;
  const isSilent = ['batch', 'clip'].includes(command) && !rest.some((arg) => /^(-j|--jobs)/.test(arg));
  return isSilent ? [command, '--jobs', '1', ...rest] : args;
}

/** The line of `veronese convert` for these arguments, which has to work. */
export async function converted(...args) {
  const { code, stdout, stderr } = await veronese(['convert', ...args]);
  assert.equal(code, 0, stderr);
  assert.match(stdout, /^\{.*\}\n$/, 'one line');
  const answer = JSON.parse(stdout);
  assert.equal(stderr, (answer.notes ?? []).map(({ message }) => `veronese: note: ${message}\n`).join(''), 'what the answer says, and nothing else');
  return answer;
}

/** `veronese convert` ends with this error, prints nothing else, and leaves everything below `folder` as it is. */
export async function notConverted(folder, args, errorCode, sentence, exit = 1) {
  const files = () => readdirSync(folder, { recursive: true }).sort();
  const before = files();
  const { code, stdout, stderr } = await veronese(['convert', ...args]);
  assert.deepEqual([code, stdout], [exit, ''], stderr);
  assert.ok(stderr.startsWith(`veronese: error: ${errorCode}: `), stderr);
  assert.match(stderr, sentence);
  assert.deepEqual(files(), before);
}

/** Starts it in a process; `onStart(child)` may send it signals. Resolves to exit code, signal and output. */
export function veroneseProcess(args, { onStart, stdin = 'ignore', stdout = 'pipe', env = {}, timeout = 120_000 } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(process.execPath, [program, ...args], {
      stdio: [stdin, stdout, 'pipe'],
      env: { ...process.env, ...env },
      timeout,
    });
    const text = { stdout: '', stderr: '' };
    child.stdout?.setEncoding('utf8').on('data', (chunk) => (text.stdout += chunk));
    child.stderr.setEncoding('utf8').on('data', (chunk) => (text.stderr += chunk));
    child.on('error', reject);
    child.on('close', (code, signal) => resolve({ code, signal, ...text }));
    onStart?.(child);
  });
}

/** A folder of its own for a test, removed afterwards. */
export function temporaryFolder(t) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-test-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  return {
    path: (...names) => join(folder, ...names),
    file: (name, content) => {
      const path = join(folder, name);
      writeFileSync(path, content);
      return path;
    },
  };
}

/** The names in an output folder, without the list of files that the program wrote. */
export function entries(folder) {
  return readdirSync(folder).filter((name) => name !== '.veronese').sort();
}
