// npm run soak: the tests that take long, natively, in WebAssembly and of the package: those that npm test ignores, whole sweeps, and many
// more random cases.

import { buildModules, buildPackage } from './lib/builds.mjs';
import { cargoCounts, nodeCounts } from './lib/counts.mjs';
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
  await buildModules();
  await buildPackage();
  failed += (await tests(nodeCounts, 'npm', ['test', '--silent', '--workspace', 'pkg'], { VERONESE_SOAK: '1' })).failed;
  console.log(failed === 0 ? '\nEverything passed.' : `\n${failed} FAILED`);
  return failed === 0 ? 0 : 1;
});
