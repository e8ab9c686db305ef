// npm run paper: repeats the paper's experiments with its method and ours; `npm run paper -- --help` lists the options.

import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

await command(async (args) => {
  await checkRust();
  const program = ['run', '--quiet', '--release', '--locked', '--features', 'codecs,stages', '--example', 'paper'];
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  return (await run('cargo', [...program, '--', ...args])).code;
});
