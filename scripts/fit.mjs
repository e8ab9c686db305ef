// npm run fit: tries constants of src/model.rs, searches for better ones on one half of the real sequences, and reports them on the
// other; `-- --help` lists the steps.

import { experiment } from './lib/experiments.mjs';
import { command } from './lib/run.mjs';

await command((args) => experiment('fit', args));
