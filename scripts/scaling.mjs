// npm run scaling: simulates clips in one tab, in a pool of workers and on a farm, with the measured constants of docs/figures/scaling.json.
// Options:
//   --measure CLIP   measures the constants anew on a folder of frames (needs ffmpeg and redis-server; some minutes)
//   --write-docs     writes what was measured to docs/figures, and docs/scaling.md from it

import { resolve } from 'node:path';
import { parseArgs } from 'node:util';

import { present } from './lib/documented.mjs';
import { figuresOf } from './lib/figures.mjs';
import { tablesOf, writePages } from './lib/pages/index.mjs';
import { Stop, command } from './lib/run.mjs';

await command(async (args) => {
  const { measure, 'write-docs': writeDocs } = options(args);
  if (measure) {
    const { measured } = await import('./lib/scaling/measure.mjs');
    const origin = { command: 'npm run scaling -- --measure CLIP', node: process.versions.node };
    return present('scaling', origin, await measured(resolve(measure), console.log), writeDocs);
  }
  console.log(tablesOf('scaling', figuresOf('scaling')));
  return writeDocs ? writePages() : undefined;
});

function options(args) {
  try {
    return parseArgs({ args, options: { measure: { type: 'string' }, 'write-docs': { type: 'boolean', default: false } } }).values;
  } catch (error) {
    throw new Stop(error.message);
  }
}
