// npm run public-api: writes the names of the crate that semantic versioning covers to tests/public-api.txt.

import { writePublicApi } from './lib/public-api.mjs';
import { command } from './lib/run.mjs';

await command(writePublicApi);
