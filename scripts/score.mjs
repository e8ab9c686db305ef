// npm run score: the measurement by which changes are judged, then the expectations; `-- --help` lists the options.

import { existsSync } from 'node:fs';
import { join } from 'node:path';

import { root } from './lib/project.mjs';
import { command, run } from './lib/run.mjs';
import { checkRust } from './lib/rust.mjs';

const SCORE = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation', '--example', 'score', '--'];
const EXPECTATIONS = ['test', '--quiet', '--release', '--locked', '--features', 'codecs', '--test', 'all', 'expectations::', '--', '--include-ignored'];

await command(async (args) => {
  await checkRust();
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const { code } = await run('cargo', [...SCORE, ...args]);
  if (code !== 0 || args.some((name) => ['--help', '-h', '--only'].includes(name))) return code;
  return expectations();
});

/** What must hold of real cases, in words. */
async function expectations() {
  if (!existsSync(join(root, 'tests', 'expectations.rs'))) {
    console.log('\nThere are no expectations.');
    return 0;
  }
  const { code, text } = await run('cargo', EXPECTATIONS, { output: 'collect' });
  console.log(code === 0 ? '\nAll expectations hold.' : `\n${text}\nNOT ALL EXPECTATIONS HOLD.`);
  return code;
}
