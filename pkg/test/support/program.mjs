// Runs the program as a user does.

import { spawn } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const program = fileURLToPath(new URL('../../bin/veronese.js', import.meta.url));

/** Starts it; `onStart(child)` may send it signals. Resolves to exit code, signal, output and seconds. */
export function veronese(args, { onStart, stdout = 'pipe', env = {}, timeout = 60_000 } = {}) {
  return new Promise((resolve, reject) => {
    const started = performance.now();
    const child = spawn(process.execPath, [program, ...args], {
      stdio: ['ignore', stdout, 'pipe'],
      env: { ...process.env, ...env },
      timeout,
    });
    const text = { stdout: '', stderr: '' };
    child.stdout?.setEncoding('utf8').on('data', (chunk) => (text.stdout += chunk));
    child.stderr.setEncoding('utf8').on('data', (chunk) => (text.stderr += chunk));
    child.on('error', reject);
    child.on('close', (code, signal) => resolve({ code, signal, ...text, seconds: (performance.now() - started) / 1000 }));
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

/** What is in an output folder, beside the list of files that the program wrote. */
export function entries(folder) {
  return readdirSync(folder).filter((name) => name !== '.veronese').sort();
}
