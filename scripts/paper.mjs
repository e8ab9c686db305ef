// npm run paper: repeats the paper's experiments with its method and ours; `npm run paper -- --help` lists the options.

import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { present, showPictures, withoutDocs } from './lib/documented.mjs';
import { root } from './lib/project.mjs';
import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const PROGRAM = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'plot', '--example', 'paper', '--'];
const PICTURES = ['figure-1.svg', 'leader-follower.png', 'paper-two-cars.png'];

await command(async (args) => {
  await checkRust();
  const { writeDocs, rest } = withoutDocs(args, ['--table']);
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const { code } = await run('cargo', [...PROGRAM, ...rest]);
  if (code !== 0 || ['--table', '--help', '-h'].some((option) => rest.includes(option))) return code;
  const place = rest.indexOf('--out');
  const out = resolve(root, place < 0 ? 'out/paper' : rest[place + 1]);
  const measured = JSON.parse(readFileSync(join(out, 'experiments.json'), 'utf8'));
  if (writeDocs) showPictures(out, PICTURES);
  present('experiments', { command: `npm run paper -- --trials ${measured.trials} --seed ${measured.seed}` }, measured, writeDocs);
  return 0;
});
