// npm run build: the WebAssembly modules, the npm package and the page.

import { buildAll } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  await prepare();
  await buildAll();
});
