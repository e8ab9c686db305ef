// npm run bench -- masks: scores masks of generated scenes and real pairs against an OpenCV baseline; `-- masks --help` lists the options.
// First the frames are written, then the baseline runs on them (a Python program next to the checkout, not in it), and finally the
// program measures both.

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { present, withoutDocs } from '../lib/documented.mjs';
import { experiment, measured, measuredApart, outOf, runPeers, valueOf, wantsHelp } from '../lib/experiments.mjs';
import { root } from '../lib/project.mjs';
import { command } from '../lib/run.mjs';

/** Steps that are measured by themselves, without the baseline. */
const APART = ['ablation', 'calibration'];
const DATA = {
  chosenOn: 'generated scenes of other seeds; all real pairs of sequences',
  heldOut: 'the generated scenes; CDnet, Wallflower, Middlebury, FlyingChairs and Yosemite',
};

await command(async (args) => {
  if (wantsHelp(args)) return experiment('masks', ['--help']);
  const { writeDocs, rest } = withoutDocs(args, ['--quick', '--only']);
  const out = outOf(args, 'out/masks');
  const apart = APART.find((step) => args.includes(`--${step}`));
  if (apart) {
    present(
      `masks-${apart}`,
      { command: `npm run bench -- masks --${apart}`, data: DATA },
      await measuredApart('masks', apart, rest, out),
      writeDocs,
    );
    return 0;
  }
  const program = join(resolve(root, valueOf(args, '--shared') ?? '../shared'), 'tools', 'baseline.py');
  if (existsSync(program)) {
    mkdirSync(join(out, 'baseline'), { recursive: true });
    await runPeers('masks', rest, {
      out,
      old: ['frames'],
      program,
      argumentsOf: (name, frames) => [frames, '--out', join(out, 'baseline', name)],
    });
  } else console.error(`Without a baseline to compare with: ${program} is not there.`);
  await measured('masks', ['measure', ...rest]);
  present('masks', { command: 'npm run bench -- masks', data: DATA }, JSON.parse(readFileSync(join(out, 'masks.json'), 'utf8')), writeDocs);
  return 0;
});
