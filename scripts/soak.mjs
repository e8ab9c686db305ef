// npm run soak: the tests that take long, natively and in WebAssembly: those that npm test ignores, and many more random cases.

import { cargoCounts } from './lib/counts.mjs';
import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';
import { tests } from './lib/tests.mjs';

const NATIVE = ['test', '--locked', '--no-fail-fast', '--features', 'codecs'];
const RUNS = [
  ['cargo', [...NATIVE, '--tests', '--', '--ignored']],
  ['cargo', [...NATIVE, '--test', 'properties'], { PROPTEST_CASES: '200000' }],
  ['wasm-pack', ['test', '--node', '--mode', 'no-install', '--', '--locked', '--', '--ignored']],
];

await command(async () => {
  await prepare({});
  let failed = 0;
  for (const [program, args, env] of RUNS) failed += (await tests(cargoCounts, program, args, env)).failed;
  console.log(failed === 0 ? '\nEverything passed.' : `\n${failed} FAILED`);
  return failed === 0 ? 0 : 1;
});
