// npm run scaling: simulates clips in one tab, in a pool of workers and on a farm, with the measured constants of experiments/scaling.json.
// Options:
//   --measure CLIP   measures the constants anew on a folder of frames (needs ffmpeg and redis-server; some minutes)
//   --write-docs     writes the tables to docs/scaling.md as well

import { writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';

import { writeMarked } from './lib/marked.mjs';
import { projectText, root } from './lib/project.mjs';
import { Stop, command } from './lib/run.mjs';
import { checkTable, constantTable, farmTable, poolTable } from './lib/scaling/tables.mjs';

const CONSTANTS = 'experiments/scaling.json';

await command(async (args) => {
  const values = options(args);
  if (values.measure) {
    const { measured } = await import('./lib/scaling/measure.mjs');
    writeFileSync(join(root, CONSTANTS), `${JSON.stringify(await measured(resolve(values.measure), console.log), null, 1)}\n`);
  }
  const constants = JSON.parse(projectText(CONSTANTS));
  const parts = { constants: constantTable(constants), check: checkTable(constants), pool: poolTable(constants), farm: farmTable(constants) };
  console.log(Object.values(parts).join('\n\n'));
  if (values['write-docs']) writeMarked('docs/scaling.md', parts);
});

function options(args) {
  try {
    return parseArgs({ args, options: { measure: { type: 'string' }, 'write-docs': { type: 'boolean', default: false } } }).values;
  } catch (error) {
    throw new Stop(error.message);
  }
}
