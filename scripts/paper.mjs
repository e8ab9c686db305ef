// npm run paper: repeats the paper's experiments with its method and ours; `npm run paper -- --help` lists the options.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { present, showPictures, withoutDocs } from './lib/documented.mjs';
import { experiment, outOf, wantsHelp } from './lib/experiments.mjs';
import { command } from './lib/run.mjs';

const PICTURES = ['figure-1.svg', 'leader-follower.png', 'paper-two-cars.png'];

await command(async (args) => {
  const { writeDocs, rest } = withoutDocs(args, []);
  const code = await experiment('paper', rest);
  if (code !== 0 || wantsHelp(rest)) return code;
  const out = outOf(rest, 'out/paper');
  const measured = JSON.parse(readFileSync(join(out, 'experiments.json'), 'utf8'));
  if (writeDocs) showPictures(out, PICTURES);
  present('experiments', { command: `npm run paper -- --trials ${measured.trials} --seed ${measured.seed}` }, measured, writeDocs);
  return 0;
});
