// npm run identity: after a change of the addresses in identity.json, writes them wherever they are repeated, then says what still differs.
// Names of packages stand in sources and examples too, and are changed by hand.

import { identityProblems, writeAddresses } from './lib/identity.mjs';
import { prepareNpmPackages } from './lib/npm-packages.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  await prepareNpmPackages();
  for (const file of await writeAddresses()) console.log(`${file}: changed`);
  const problems = await identityProblems();
  for (const problem of problems) console.error(problem);
  return problems.length > 0 ? 1 : 0;
});
