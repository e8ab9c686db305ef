// npm run figures: measures everything in the tables of docs/*.md and writes it there, dated. It takes about an hour on two cores, on
// which nothing else should run. Real pairs and clips are measured if they lie in ../shared/data.
//   --tables   measures nothing: writes the tables from the figures in docs/figures

import { rmSync } from 'node:fs';
import { join } from 'node:path';

import { writePages } from './lib/pages/index.mjs';
import { root } from './lib/project.mjs';
import { Stop, command, must } from './lib/run.mjs';

const PAIRS = 'out/annotator/pairs';
/** In this order: the pairs of the clips are solved once, and the annotator goes on with their results. */
const PROGRAMS = [
  ['bench', 'masks'],
  ['bench', 'masks', '--ablation'],
  ['bench', 'masks', '--calibration'],
  ['bench', 'clips', '--pairs', PAIRS],
  ['bench', 'clips', '--ablation'],
  ['annotator'],
  ['annotator', '--page', '--only', 'soccerball,car-turn'],
  ['bench', 'browser'],
  ['bench', 'page'],
  ['bench', 'scaling'],
  ['paper', '--trials', '200', '--seed', '1'],
];

await command(async (args) => {
  const unknown = args.find((name) => name !== '--tables');
  if (unknown !== undefined) throw new Stop(`There is no option '${unknown}', only --tables.`);
  if (args.length > 0) return writePages();
  // Of this version alone.
  rmSync(join(root, PAIRS), { recursive: true, force: true });
  const began = Date.now();
  for (const [program, ...options] of PROGRAMS) {
    const said = ['npm', 'run', program, '--', ...options].join(' ');
    console.log(`\n=== ${said}, after ${Math.round((Date.now() - began) / 60_000)} min ===`);
    await must(`${said} failed.`, process.execPath, [join('scripts', `${program}.mjs`), ...options, '--write-docs']);
  }
  console.log(`\nAll figures are of today, after ${Math.round((Date.now() - began) / 60_000)} min.`);
  return 0;
});
