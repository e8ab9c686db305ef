// npm run check: formatting, lints, documentation, types, links, spelling.

import { runChecks } from './lib/checks.mjs';
import { prepare } from './lib/prepare.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  await prepare({ checks: true });
  const { failed } = await runChecks();
  return failed === 0 ? 0 : 1;
});
