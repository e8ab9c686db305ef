// npm run bench: the native benchmarks; arguments go to criterion (`npm run bench -- NAME`).

import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

await command(async (args) => {
  await checkRust();
  return (await run('cargo', ['bench', '--locked', '--package', 'benches', '--benches', '--', ...args])).code;
});
