// npm run animation: writes docs/images/passing-cars.webp, the first picture of README: the bundled clip, and beside it what
// `veronese clip` finds in it. It takes ffmpeg with libwebp.

import { mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { buildPackage } from './lib/builds.mjs';
import { prepare } from './lib/prepare.mjs';
import { root, which } from './lib/project.mjs';
import { Stop, command, must, say } from './lib/run.mjs';

const FRAMES = 'www/public/samples/passing-cars/frames';
const FILE = 'docs/images/passing-cars.webp';
const FRAMES_PER_SECOND = '12.5';
/** Both pictures together, pixels. */
const WIDTH = 960;
/** Pages load it at once. */
const LARGEST = 1.5 * 1024 ** 2;

await command(async () => {
  if (!which('ffmpeg')) throw new Stop('ffmpeg was not found; it joins the pictures (Debian: apt-get install ffmpeg).');
  await prepare();
  await buildPackage();
  const folder = mkdtempSync(join(tmpdir(), 'veronese-'));
  try {
    await must('The clip could not be segmented.', process.execPath, ['pkg/bin/veronese.js', 'clip', FRAMES, '--out', folder, '--overlay'], {
      output: 'collect',
    });
    const [frames, overlays] = [join(root, FRAMES, '%02d.webp'), join(folder, 'overlay', '%02d.png')];
    const input = ['-framerate', FRAMES_PER_SECOND, '-i', frames, '-framerate', FRAMES_PER_SECOND, '-i', overlays];
    const joined = ['-filter_complex', `[0][1]hstack,scale=${WIDTH}:-2:flags=lanczos`];
    const output = ['-c:v', 'libwebp', '-loop', '0', '-q:v', '60', '-compression_level', '6', FILE];
    const quietly = ['-hide_banner', '-loglevel', 'error', '-y'];
    await must('The animation could not be written.', 'ffmpeg', [...quietly, ...input, ...joined, ...output]);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
  const { size } = statSync(join(root, FILE));
  if (size > LARGEST) throw new Stop(`${FILE} has ${size} bytes, more than ${LARGEST}.`);
  say(`${FILE}: ${Math.round(size / 1024)} KiB`);
});
