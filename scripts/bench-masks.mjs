// npm run bench:masks: scores masks of generated scenes and real pairs against an OpenCV baseline; `-- --help` lists the options.
// First the frames are written, then the baseline runs on them (a Python program next to the checkout, not in it), and finally the
// program measures both.

import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { present, withoutDocs } from './lib/documented.mjs';
import { findOpenCv, runOnAll } from './lib/opencv.mjs';
import { root } from './lib/project.mjs';
import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation', '--example', 'masks', '--'];
/** Steps that are measured by themselves, without the baseline. */
const APART = ['ablation', 'calibration'];
const PARTIAL = ['--quick', '--only'];
const DATA = {
  chosenOn: 'generated scenes of other seeds; all real pairs of sequences',
  heldOut: 'the generated scenes; CDnet, Wallflower, Middlebury, FlyingChairs and Yosemite',
};

await command(async (args) => {
  if (args.includes('--help') || args.includes('-h')) return (await run('cargo', [...CARGO, '--help'])).code;
  await checkRust();
  const apart = APART.find((step) => args.includes(`--${step}`));
  const { writeDocs, rest } = withoutDocs(args, apart ? [] : PARTIAL);
  const out = resolve(root, valueOf(args, '--out') ?? 'out/masks');
  const read = (step) => JSON.parse(readFileSync(join(out, `${step}.json`), 'utf8'));
  if (apart) {
    const { code } = await run('cargo', [...CARGO, apart, ...rest.filter((name) => name !== `--${apart}`)]);
    // They take long: a part of the cases is enough, if the figures say which.
    const only = args.includes('--only') ? ` --only ${valueOf(args, '--only')}` : '';
    if (code === 0) present(`masks-${apart}`, { command: `npm run bench:masks -- --${apart}${only}`, data: DATA }, read(apart), writeDocs);
    return code;
  }
  const baselines = join(out, 'baseline');
  for (const folder of [baselines, join(out, 'frames')]) rmSync(folder, { recursive: true, force: true });
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const frames = await run('cargo', [...CARGO, 'frames', ...rest], { output: 'collect' });
  if (frames.code !== 0) {
    process.stderr.write(frames.text);
    return frames.code;
  }
  const cases = frames.stdout.trim().split('\n').map((line) => line.split('\t'));
  await runBaseline(cases, baselines, resolve(root, valueOf(args, '--shared') ?? '../shared'));
  const { code } = await run('cargo', [...CARGO, 'measure', ...rest]);
  if (code !== 0) return code;
  const measured = read('masks');
  present('masks', { command: 'npm run bench:masks', data: DATA }, measured, writeDocs);
  return 0;
});

function valueOf(args, option) {
  const place = args.indexOf(option);
  return place < 0 ? undefined : args[place + 1];
}

/** Runs the baseline on every case, or says what is missing. */
async function runBaseline(cases, folder, shared) {
  const program = join(shared, 'tools', 'baseline.py');
  if (!existsSync(program)) {
    console.error(`Without a baseline to compare with: ${program} is not there.`);
    return;
  }
  const python = await findOpenCv();
  if (!python) return;
  mkdirSync(folder, { recursive: true });
  await runOnAll(python, program, cases, (name, frames) => [frames, '--out', join(folder, name)]);
}
