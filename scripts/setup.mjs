// npm run setup: sets up everything, including what only the tests need.

import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  const { chromium, python } = await prepare({ checks: true, browser: true, hosts: true, python: true });
  if (python.problem) console.log(python.problem);
  if (chromium.problem) console.log(chromium.problem);
  console.log(chromium.problem ? 'Everything else is ready.' : 'Everything is ready.');
  return chromium.problem ? 1 : 0;
});
