// Cargo's runner for tests in WebAssembly: `node wasm-test-runner.mjs FILE [WORD]` runs the tests of wasm-bindgen-test in what Cargo compiled.
// That crate calls them, catches panics and prints the results; this gives it its JavaScript and the names of the tests. wasm-bindgen's own
// runner (`npm run soak -- wasm-pack`) also has the servers that tests in browsers need, and takes as long to compile as the modules.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [file, word = ''] = process.argv.slice(2).filter((argument) => !argument.startsWith('--'));
const tests = WebAssembly.Module.exports(new WebAssembly.Module(readFileSync(file)))
  .map(({ name }) => name)
  .filter((name) => name.startsWith('__wbgt_'));
const chosen = tests.filter((name) => name.slice(name.indexOf('::') + 2).includes(word));

const folder = mkdtempSync(join(tmpdir(), 'veronese-tests-'));
try {
  execFileSync(process.env.VERONESE_WASM_TOOLS, ['test', file, folder, 'tests'], { stdio: 'inherit' });
  // What the crate expects of its surroundings.
  Object.assign(globalThis, {
    __wbgtest_og_console_log: console.log,
    __wbgtest_og_console_error: console.error,
    __wbg_test_invoke: (test) => test(),
  });
  const wasm = createRequire(import.meta.url)(join(folder, 'tests.js'));
  const { __wasm: exported } = wasm;
  // What a test writes, its panic too, is shown with its failure.
  for (const method of ['debug', 'log', 'info', 'warn', 'error']) console[method] = (...args) => wasm[`__wbgtest_console_${method}`](args);
  const context = new wasm.WasmBindgenTestContext(false);
  context.filtered_count(tests.length - chosen.length);
  process.exitCode = (await context.run(chosen.map((name) => exported[name]))) ? 0 : 1;
} finally {
  rmSync(folder, { recursive: true, force: true });
}
