// The tests that take long, natively, in WebAssembly, of the package and of the page: those that npm test ignores, whole sweeps, and many
// more random cases.

import { Stop } from '../run.mjs';
import { cargo, node, playwright } from '../test-programs.mjs';
import { tests as runTests } from '../tests.mjs';

const NATIVE = ['test', '--locked', '--no-fail-fast', '--features', 'codecs'];
const SOAK = { VERONESE_SOAK: '1' };
const RUNS = [
  [cargo, 'cargo', [...NATIVE, '--tests', '--', '--ignored']],
  [cargo, 'cargo', [...NATIVE, '--test', 'properties'], { PROPTEST_CASES: '200000' }],
  [cargo, 'wasm-pack', ['test', '--node', '--mode', 'no-install', '--', '--locked', '--', '--ignored']],
  [node, 'npm', ['test', '--silent', '--workspace', 'pkg'], SOAK],
  [playwright, 'npm', ['test', '--silent', '--workspace', 'www', '--', 'same-bits'], SOAK],
];

export const RUN_COUNT = RUNS.length;

/** Yields how many of the test programs have passed after each. */
export async function* tests({ from, chromium }) {
  if (chromium.problem) throw new Stop(chromium.problem);
  for (let done = from; done < RUNS.length; done += 1) {
    const [kind, program, args, env = {}] = RUNS[done];
    const { failed } = await runTests(kind, program, args, { ...env, VERONESE_CHROMIUM: chromium.path });
    if (failed > 0) throw new Stop(`${failed} FAILED`);
    yield { done: done + 1, note: program };
  }
}
