// npm run annotator: scores what an annotator gets for annotations of a clip; `-- --help` lists the options, `-- fit` fits the constants,
// `-- --page` has an expert annotate clips in the page.
// First OpenCV's baseline runs on the real clips, then the program measures them and generated clips.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import { present, withoutDocs } from './lib/documented.mjs';
import { experiment, measured, outOf, runPeers, wantsHelp } from './lib/experiments.mjs';
import { root } from './lib/project.mjs';
import { command, run } from './lib/run.mjs';

const DATA = {
  chosenOn:
    'the propagation on half of the real clips each, confirmed on the other; views on the generated clips; clips as such on the ten old ones first',
  heldOut: 'nothing entirely',
};

await command(async (args) => {
  if (args.includes('--page')) return (await run(process.execPath, [join(root, 'scripts/annotator-page.mjs'), ...args])).code;
  if (wantsHelp(args) || args.includes('fit')) return experiment('annotator', args);
  const { writeDocs, rest } = withoutDocs(args, ['--only']);
  const out = outOf(args, 'out/annotator');
  const program = join(root, 'experiments', 'annotator', 'peers.py');
  await runPeers('annotator', rest, { out, old: ['baseline'], program, argumentsOf: (_, folder) => [folder, join(out, 'baseline')] });
  for (const step of ['measure', 'harm', 'points', 'objects']) await measured('annotator', [step, ...rest]);
  const rows = (step) =>
    readFileSync(join(out, `${step}.jsonl`), 'utf8')
      .split('\n')
      .filter(Boolean)
      .map(JSON.parse);
  const [real, objects] = [rows('measure'), rows('objects')];
  const { quality } = [...real, ...objects][0];
  present(
    'annotator',
    { command: 'npm run annotator', data: DATA },
    { quality, real, harm: rows('harm').flat(), points: rows('points').flat(), objects },
    writeDocs,
  );
  return 0;
});
