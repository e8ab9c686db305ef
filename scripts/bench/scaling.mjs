// npm run bench -- scaling [CLIP]: what a frame of a clip costs in one worker, in sizes and qualities; frames are the first of a folder, scaled by
// ffmpeg. --write-docs writes the figures to docs/figures, and docs/scaling.md from them.

import { mkdirSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { buildPackage } from '../lib/builds.mjs';
import { present } from '../lib/documented.mjs';
import { prepare } from '../lib/prepare.mjs';
import { root } from '../lib/project.mjs';
import { Stop, command, must } from '../lib/run.mjs';

const CLIP = '../shared/data/clips/car-turn/frames';
const SIZES = [
  [320, 240],
  [640, 480],
  [854, 480],
  [1920, 1080],
];
const QUALITIES = ['fast', 'best'];
/** Frames that are segmented, of large ones fewer: no measurement is to take minutes. */
const framesOf = ([width]) => (width > 1000 ? 9 : 13);
const PROGRAM = fileURLToPath(new URL('../lib/cost-of-frame.mjs', import.meta.url));

await command(async (args) => {
  const [clip = CLIP, ...others] = args.filter((name) => name !== '--write-docs');
  if (others.length > 0) throw new Stop(`Give one folder of frames, not ${others[0]} too.`);
  await prepare();
  await buildPackage();
  const folder = mkdtempSync(join(tmpdir(), 'veronese-scaling-'));
  try {
    const frames = {};
    for (const size of SIZES) {
      const place = await scaled(resolve(root, clip), join(folder, size.join('x')), size, framesOf(size));
      const name = size.join(' × ');
      frames[name] = {};
      for (const quality of QUALITIES) {
        const { stdout } = await must('The frames could not be measured.', process.execPath, [PROGRAM, place, quality], {
          output: 'collect',
        });
        frames[name][quality] = JSON.parse(stdout);
        console.log(`${name}, ${quality}: ${stdout}`);
      }
    }
    present('scaling', { command: 'npm run bench -- scaling', node: process.versions.node }, { frames }, args.includes('--write-docs'));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

/** The first frames of a clip as JPEG files of another size. */
async function scaled(clip, place, [width, height], count) {
  mkdirSync(place);
  const from = ['-pattern_type', 'glob', '-i', join(clip, `*.${readdirSync(clip)[0].split('.').at(-1)}`)];
  const to = ['-vf', `scale=${width}:${height}`, '-frames:v', String(count), '-q:v', '2', join(place, '%04d.jpg')];
  await must('The frames could not be scaled; that takes the program ffmpeg.', 'ffmpeg', ['-v', 'error', ...from, ...to], {
    output: 'collect',
  });
  if (readdirSync(place).length < count) throw new Stop(`${clip} has fewer than ${count} frames.`);
  return place;
}
