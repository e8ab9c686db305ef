// npm run bench -- clips: scores labels that persist through time, of generated and real clips; `-- clips --help` lists the options.
// First the clips are written, then OpenCV's methods run on them, and finally the program measures all.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { present, withoutDocs } from '../lib/documented.mjs';
import { experiment, measured, measuredApart, outOf, runPeers, wantsHelp } from '../lib/experiments.mjs';
import { root } from '../lib/project.mjs';
import { command } from '../lib/run.mjs';

const DATA = { chosenOn: 'all real clips; the generated ones were looked at', heldOut: 'nothing' };

await command(async (args) => {
  if (wantsHelp(args)) return experiment('clips', ['--help']);
  const { writeDocs, rest } = withoutDocs(args, ['--quick', '--only', '--methods', '--speed']);
  const out = outOf(args, 'out/clips');
  if (args.includes('--ablation')) {
    present(
      'clips-ablation',
      { command: 'npm run bench -- clips --ablation', data: DATA },
      await measuredApart('clips', 'ablation', rest, out),
      writeDocs,
    );
    return 0;
  }
  const program = join(root, 'experiments', 'clips', 'peers.py');
  await runPeers('clips', rest, { out, old: ['labels', 'generated'], program, argumentsOf: (_, folder) => [folder, join(out, 'labels')] });
  await measured('clips', ['measure', ...rest]);
  present('clips', { command: 'npm run bench -- clips', data: DATA }, JSON.parse(readFileSync(join(out, 'clips.json'), 'utf8')), writeDocs);
  return 0;
});
