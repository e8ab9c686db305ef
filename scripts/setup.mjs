// npm run setup: sets up everything, including what only the tests need.

import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  const { chromium, python, ownPython } = await prepare({ checks: true, browser: true, hosts: true, python: true, ownPython: true });
  for (const { problem } of [python, ownPython]) if (problem) console.log(problem);
  if (chromium.problem) console.log(chromium.problem);
  console.log(chromium.problem ? 'Everything else is ready.' : 'Everything is ready.');
  return chromium.problem ? 1 : 0;
});
