// npm run check: formatting, lints, types, links, spelling.

import { runChecks, runLints } from './lib/checks.mjs';
import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  await prepare({ checks: true });
  const failed = (await runLints()).failed + (await runChecks()).failed;
  return failed === 0 ? 0 : 1;
});
