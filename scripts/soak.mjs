// npm run soak: the tests that take long, natively, in WebAssembly, of the package and of the page: those that npm test ignores, whole
// sweeps, and many more random cases.

import { buildAll } from './lib/builds.mjs';
import { cargoCounts, nodeCounts, playwrightCounts } from './lib/counts.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command } from './lib/run.mjs';
import { IN_WASM, tests } from './lib/tests.mjs';

const NATIVE = ['test', '--locked', '--no-fail-fast', '--features', 'codecs'];
const RUNS = [
  ['cargo', [...NATIVE, '--tests', '--', '--ignored']],
  ['cargo', [...NATIVE, '--test', 'properties'], { PROPTEST_CASES: '200000' }],
  ['cargo', ['test', ...IN_WASM.args, '--locked', '--', '--ignored'], IN_WASM.env],
];

await command(async () => {
  const { chromium } = await prepare({ browser: true });
  if (chromium.problem) throw new Stop(chromium.problem);
  let failed = 0;
  for (const [program, args, env] of RUNS) failed += (await tests(cargoCounts, program, args, env)).failed;
  await buildAll();
  const env = { VERONESE_SOAK: '1', VERONESE_CHROMIUM: chromium.path };
  failed += (await tests(nodeCounts, 'npm', ['test', '--silent', '--workspace', 'pkg'], env)).failed;
  failed += (await tests(playwrightCounts, 'npm', ['test', '--silent', '--workspace', 'www', '--', 'screens', 'same-bits'], env)).failed;
  console.log(failed === 0 ? '\nEverything passed.' : `\n${failed} FAILED`);
  return failed === 0 ? 0 : 1;
});
