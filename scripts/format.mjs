// npm run format: writes the layout of TypeScript and JavaScript in the folders that are checked.
// npm run format -- FOLDER …: in these.

import { FORMATTED, format } from './lib/formatting.mjs';
import { prepareNpmPackages } from './lib/npm-packages.mjs';
import { command } from './lib/run.mjs';

await command(async (folders) => {
  await prepareNpmPackages();
  return (await format(folders.length > 0 ? folders : FORMATTED)) ? 0 : 1;
});
