// npm run notices: writes THIRD-PARTY-NOTICES. With --check it only compares.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { NOTICES, notices } from './lib/notices.mjs';
import { projectText, inProject, root } from './lib/project.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  const text = await notices();
  if (!process.argv.includes('--check')) for (const path of NOTICES) writeFileSync(join(root, path), text);
  const stale = NOTICES.filter((path) => !inProject(path) || projectText(path) !== text);
  if (stale.length > 0) console.error(`${stale.join(' and ')}: not of the packages that are used now; run npm run notices`);
  return stale.length > 0 ? 1 : 0;
});
