// npm run proof:scale-out: two workers process 200 pairs from Redis; one worker is killed in the middle of a job, and the server is
// restarted once. Then two workers share the blocks of a clip, and one of them is killed inside a block.

import { buildPackage } from './lib/builds.mjs';
import { SCALE_OUT, prepareNpmPackages } from './lib/npm-packages.mjs';
import { prepare } from './lib/prepare.mjs';
import { Stop, command } from './lib/run.mjs';
import { prove, proveClip, redisServer } from './lib/scale-out.mjs';

await command(async () => {
  await prepare();
  await prepareNpmPackages(SCALE_OUT);
  await buildPackage();
  const program = await redisServer({ install: true });
  if (!program) throw new Stop('There is no redis-server and no valkey-server: install one (Debian: `apt-get install redis-server`).');
  const { pairs, seconds, jobsFinished, foundDone } = await prove(program, { pairs: 200, size: { width: 48, height: 36 }, say: console.log });
  console.log(`Every one of ${pairs} pairs is in the output exactly once, after ${seconds.toFixed(1)} s.`);
  console.log(`Workers reported ${jobsFinished} finished jobs; ${foundDone} of them found an existing result.`);
  const { did } = await proveClip(program, { blocks: 6, size: { width: 96, height: 72 }, say: console.log });
  console.log(`The clip is to the bit what one run alone writes. Jobs that workers finished: ${did.map((job) => JSON.stringify(job)).join(' ')}`);
});
