// npm run build: the WebAssembly modules, the npm package and the page. With --modules only the modules.

import { buildModules, buildPage } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async (args) => {
  await prepare();
  if (args.includes('--modules')) await buildModules();
  else await buildPage();
});
