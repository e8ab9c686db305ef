#!/usr/bin/env node
import { writeSync } from 'node:fs';
import { main } from '../dist/cli.js';

const EXIT = { SIGINT: 130, SIGTERM: 143 };

const stopping = new AbortController();
for (const [signal, code] of Object.entries(EXIT)) {
  process.on(signal, () => {
    stopping.abort();
    process.exit(code);
  });
}

const { stdout, stderr } = process;
// Every thread adds listeners of its own.
stdout.setMaxListeners(0);
stderr.setMaxListeners(0);

function say(text) {
  try {
    writeSync(2, text);
  } catch {
    // Nobody reads the error: the exit code is left.
  }
}

process.exitCode = await main(process.argv.slice(2), {
  // Looked at only by who reads it: opening it has effects.
  get stdin() {
    return process.stdin;
  },
  stdout,
  stderr: { isTTY: stderr.isTTY, hasColors: () => stderr.hasColors?.(), write: say },
  signal: stopping.signal,
});
