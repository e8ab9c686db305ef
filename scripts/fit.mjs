// npm run fit: tries constants of src/model.rs, searches for better ones on one half of the real sequences, and reports them on the
// other; `-- --help` lists the steps.

import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation', '--example', 'fit', '--'];

await command(async (args) => {
  await checkRust();
  return (await run('cargo', [...CARGO, ...args])).code;
});
