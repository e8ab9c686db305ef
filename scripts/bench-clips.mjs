// npm run bench:clips: scores labels that persist through time, of generated and real clips; `-- --help` lists the options.
// First the clips are written, then OpenCV's methods run on them, and finally the program measures all.

import { rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { findOpenCv, runOnAll } from './lib/opencv.mjs';
import { root } from './lib/project.mjs';
import { checkRust } from './lib/rust.mjs';
import { command, run } from './lib/run.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--features', 'codecs,ablation', '--example', 'clips', '--'];

await command(async (args) => {
  if (args.includes('--help') || args.includes('-h')) return (await run('cargo', [...CARGO, '--help'])).code;
  await checkRust();
  const place = args.indexOf('--out');
  const out = resolve(root, place < 0 ? 'out/clips' : args[place + 1]);
  for (const folder of ['labels', 'generated']) rmSync(join(out, folder), { recursive: true, force: true });
  console.error('Building the program if it has changed (some minutes when everything is new) …');
  const frames = await run('cargo', [...CARGO, 'frames', ...args], { output: 'collect' });
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
  return (await run('cargo', [...CARGO, 'measure', ...args])).code;
});
