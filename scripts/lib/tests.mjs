// Runs test programs.

import { run } from './run.mjs';

/** With these, `cargo test` runs tests as WebAssembly in Node. */
export const IN_WASM = {
  args: ['--target', 'wasm32-unknown-unknown'],
  env: { CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER: 'wasm-bindgen-test-runner', WASM_BINDGEN_TEST_ONLY_NODE: '1' },
};

/** Runs a test program. Its exit code decides: a crash fails the part, and so does a run without tests. */
export async function tests(count, program, args, env = {}) {
  const { code, text } = await run(program, args, { output: 'both', env });
  const counts = count(text);
  if (code !== 0 && counts.failed === 0) return { ...counts, failed: 1, note: `${program} ended with code ${code}` };
  if (counts.passed + counts.failed === 0) return { ...counts, failed: 1, note: 'no test ran' };
  return counts;
}
