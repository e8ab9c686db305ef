// wasm-pack, which many use for modules: what it makes of the crate `wasm` is what is shipped, and it runs the tests.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { MODULES, buildModules, ofModule, ofProject } from './builds.mjs';
import { root } from './project.mjs';
import { run, say } from './run.mjs';
import { prepareWasmPack } from './rust.mjs';

/** Builds the modules with wasm-pack and compares their files, then runs the tests of the crate. Returns counts, as tests.mjs. */
export async function testWithWasmPack() {
  await buildModules();
  await prepareWasmPack();
  const failures = [];
  for (const { name, folder, title, features } of MODULES) {
    const out = join(root, 'out', 'wasm-pack', name);
    const args = [
      'build',
      'wasm',
      '--release',
      '--target',
      'web',
      '--mode',
      'no-install',
      '--no-pack',
      '--out-dir',
      out,
      '--out-name',
      name,
    ];
    const { code } = await run('wasm-pack', [...args, '--', ...ofModule(features)], { env: ofProject() });
    const differs = (file) => !readFileSync(join(out, file)).equals(readFileSync(join(root, folder, file)));
    if (code !== 0 || [`${name}_bg.wasm`, `${name}.js`, `${name}.d.ts`].some(differs)) failures.push(title);
  }
  const { code } = await run(
    'wasm-pack',
    ['test', 'wasm', '--node', '--mode', 'no-install', '--release', '--', '--locked', '--test', 'algebra'],
    { env: ofProject() },
  );
  if (code !== 0) failures.push('wasm-pack test');
  for (const failure of failures) say(`FAILED  ${failure}`);
  return { passed: MODULES.length + 1 - failures.length, failed: failures.length, skipped: 0, failures };
}
