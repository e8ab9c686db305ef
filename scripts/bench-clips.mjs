// npm run bench:clips: scores labels that persist through time, of generated and real clips; `-- --help` lists the options.
// First the clips are written, then OpenCV's methods run on them, and finally the program measures all.

import { readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { present, withoutDocs } from './lib/documented.mjs';
import { findOpenCv, runOnAll } from './lib/opencv.mjs';
import { root } from './lib/project.mjs';
import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation', '--example', 'clips', '--'];
const PARTIAL = ['--quick', '--only', '--methods'];
const DATA = { chosenOn: 'all real clips; the generated ones were looked at', heldOut: 'nothing' };

await command(async (args) => {
  if (args.includes('--help') || args.includes('-h')) return (await run('cargo', [...CARGO, '--help'])).code;
  await checkRust();
  const { writeDocs, rest } = withoutDocs(args, PARTIAL);
  const place = args.indexOf('--out');
  const out = resolve(root, place < 0 ? 'out/clips' : args[place + 1]);
  for (const folder of ['labels', 'generated']) rmSync(join(out, folder), { recursive: true, force: true });
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const frames = await run('cargo', [...CARGO, 'frames', ...rest], { output: 'collect' });
  if (frames.code !== 0) {
    process.stderr.write(frames.text);
    return frames.code;
  }
  const clips = frames.stdout.trim().split('\n').map((line) => line.split('\t'));
  const python = await findOpenCv();
  if (python) {
    const program = join(root, 'experiments', 'clips', 'peers.py');
    await runOnAll(python, program, clips, (_, folder) => [folder, join(out, 'labels')]);
  }
  const { code } = await run('cargo', [...CARGO, 'measure', ...rest]);
  if (code !== 0) return code;
  const measured = JSON.parse(readFileSync(join(out, 'clips.json'), 'utf8'));
  present('clips', { command: 'npm run bench:clips', data: DATA }, measured, writeDocs);
  return 0;
});
