// npm run bench:annotator: scores what an annotator gets for what he says of a clip; `-- --help` lists the options, `-- fit`
// fits the constants, `-- --page` has an expert annotate clips in the page.
// First OpenCV's baseline runs on the real clips, then the program measures them and generated clips.

import { readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { present, withoutDocs } from './lib/documented.mjs';
import { findOpenCv, runOnAll } from './lib/opencv.mjs';
import { root } from './lib/project.mjs';
import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation', '--example', 'annotator', '--'];
const DATA = {
  chosenOn: 'the propagation on half of the real clips each, confirmed on the other; views on the generated clips; clips as such on the ten old ones first',
  heldOut: 'nothing entirely',
};

await command(async (args) => {
  if (args.includes('--page')) return (await run(process.execPath, [join(root, 'scripts/bench-annotator-page.mjs'), ...args])).code;
  if (args.includes('--help') || args.includes('-h')) return (await run('cargo', [...CARGO, '--help'])).code;
  await checkRust();
  const { writeDocs, rest } = withoutDocs(args, ['--only']);
  if (args.includes('fit')) return (await run('cargo', [...CARGO, ...args])).code;
  const place = args.indexOf('--out');
  const out = resolve(root, place < 0 ? 'out/annotator' : args[place + 1]);
  // What pairs of frames told is kept from run to run, but the page must not be of another version.
  const old = writeDocs ? ['baseline', 'pairs'] : ['baseline'];
  for (const folder of old) rmSync(join(out, folder), { recursive: true, force: true });
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const frames = await run('cargo', [...CARGO, 'frames', ...rest], { output: 'collect' });
  if (frames.code !== 0) {
    process.stderr.write(frames.text);
    return frames.code;
  }
  const clips = frames.stdout.split('\n').filter(Boolean).map((line) => line.split('\t'));
  const python = clips.length > 0 && (await findOpenCv());
  if (python) {
    const program = join(root, 'experiments', 'annotator', 'peers.py');
    await runOnAll(python, program, clips, (_, folder) => [folder, join(out, 'baseline')]);
  }
  for (const step of ['measure', 'objects', 'pairs']) {
    const { code } = await run('cargo', [...CARGO, step, ...rest]);
    if (code !== 0) return code;
  }
  const rows = (step) => readFileSync(join(out, `${step}.jsonl`), 'utf8').split('\n').filter(Boolean).map(JSON.parse);
  const [real, objects] = [rows('measure'), rows('objects')];
  const { quality } = [...real, ...objects][0];
  present('annotator', { command: 'npm run bench:annotator', data: DATA }, { quality, real, objects, strokes: rows('pairs') }, writeDocs);
  return 0;
});
