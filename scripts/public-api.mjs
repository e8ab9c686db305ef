// npm run public-api: writes the names of the crate that semantic versioning covers to tests/public-api.txt. With --install it installs what
// that takes, and writes nothing.

import { writePublicApi } from './lib/public-api.mjs';
import { command } from './lib/run.mjs';
import { preparePublicApi } from './lib/rust.mjs';

await command(async (args) => {
  if (args.length > 0 && (args.length > 1 || args[0] !== '--install')) {
    console.error(`npm run public-api [-- --install], not ${args.join(' ')}`);
    return 2;
  }
  await (args.length > 0 ? preparePublicApi() : writePublicApi());
  return 0;
});
