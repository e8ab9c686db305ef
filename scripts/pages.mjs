// npm run pages: writes the tables of docs/*.md from the figures in docs/figures.

import { writePages } from './lib/pages/index.mjs';
import { command } from './lib/run.mjs';

await command(() => writePages());
