// npm run score: the measurement by which changes are judged, then the expectations, what must hold of real cases in words; `-- --help`
// lists the options.

import { experiment, wantsHelp } from './lib/experiments.mjs';
import { command, run } from './lib/run.mjs';

const EXPECTATIONS = [
  'test',
  '--quiet',
  '--release',
  '--locked',
  '--features',
  'codecs',
  '--test',
  'all',
  'expectations::',
  '--',
  '--include-ignored',
];

await command(async (args) => {
  const score = await experiment('score', args);
  if (score !== 0 || wantsHelp(args) || args.includes('--only')) return score;
  const { code, text } = await run('cargo', EXPECTATIONS, { output: 'collect' });
  console.log(code === 0 ? '\nAll expectations hold.' : `\n${text}\nNOT ALL EXPECTATIONS HOLD.`);
  return code;
});
