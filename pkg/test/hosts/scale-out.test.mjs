// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readdirSync, readFileSync, truncateSync } from 'node:fs';
import { test } from 'node:test';
import { SegmenterPool } from 'veronese';
import { blockJobOf, missingBlocks, performBlock } from '../../../examples/scale-out/block.mjs';
import { clipJobOf, clipPlaceOf, clipResultOf, framesOf, hashesOf, performClip } from '../../../examples/scale-out/clip.mjs';
import { frame, png } from '../support/frames.mjs';
import { temporaryFolder } from '../support/program.mjs';
import { prove, proveClip, redisServer } from '../support/scale-out.mjs';

const program = redisServer();

test('every pair exactly once, though a worker is killed and the Redis server restarted', { skip: !program && 'there is no redis-server and no valkey-server' }, async () => {
  await prove(program, { pairs: 60, size: { width: 48, height: 36 } });
});

test('a clip in blocks is to the bit what one run writes, though a worker is killed inside a block', { skip: !program && 'there is no redis-server and no valkey-server' }, async () => {
  const { did } = await proveClip(program, { blocks: 3, size: { width: 96, height: 72 } });
  assert.ok(did.length >= 4);
});

test('a clip whose worker is lost goes on after the last pair that was solved, to the same files', async (t) => {
  const folder = temporaryFolder(t);
  const { frames, options, job } = await clipOf(folder, 8);
  const [out, straight] = [folder.path('out'), folder.path('straight')];
  const task = { job, folder: frames, options };

  const lost = new SegmenterPool({ jobs: 1 });
  const running = performClip(lost, { ...task, out });
  const solved = () => (existsSync(`${clipPlaceOf(out, job)}/pairs`) ? readdirSync(`${clipPlaceOf(out, job)}/pairs`).length : 0);
  while (solved() < 3) await new Promise((resume) => setTimeout(resume, 5));
  lost.close();
  await assert.rejects(running);
  assert.equal(await clipResultOf(out, job), undefined);

  const pool = new SegmenterPool({ jobs: 1 });
  t.after(() => pool.close());
  const { did, known } = await performClip(pool, { ...task, out });
  assert.ok(did && known >= 3, `${known} known`);
  assert.deepEqual(await performClip(pool, { ...task, out: straight }), { did: true, known: 0, solved: 7 });
  const found = files(clipPlaceOf(out, job));
  assert.deepEqual(found, files(clipPlaceOf(straight, job)));
  assert.deepEqual(found.map(([name]) => name), [...Array.from({ length: 8 }, (_, k) => `0${k}.png.png`), 'clip.json']);
  assert.deepEqual(await performClip(pool, { ...task, out }), { did: false, known: 0, solved: 0 });
});

test('blocks of a clip are solved once each, and a damaged pair by the clip', async (t) => {
  const folder = temporaryFolder(t);
  const { frames, options, job, hashes } = await clipOf(folder, 8);
  const [out, straight] = [folder.path('out'), folder.path('straight')];
  const task = { folder: frames, options };
  const pool = new SegmenterPool({ jobs: 2 });
  t.after(() => pool.close());
  const blocks = await missingBlocks(out, job, hashes.length, 3);
  assert.deepEqual(blocks, [{ from: 0, to: 3 }, { from: 3, to: 6 }, { from: 6, to: 7 }]);
  const tasks = blocks.map(({ from, to }) => ({ ...task, out, from, to, clip: job, job: blockJobOf(job, hashes.slice(from, to + 1)) }));
  assert.deepEqual(await Promise.all(tasks.map((block) => performBlock(pool, block))), [3, 3, 1].map(() => ({ did: true, known: 0 })));
  assert.deepEqual(await performBlock(pool, tasks[0]), { did: false, known: 3 });
  assert.deepEqual(await missingBlocks(out, job, hashes.length, 3), []);
  truncateSync(`${clipPlaceOf(out, job)}/pairs/2`, 100);
  assert.deepEqual(await performClip(pool, { ...task, job, out }), { did: true, known: 7, solved: 0 });
  await performClip(pool, { ...task, job, out: straight });
  assert.deepEqual(files(clipPlaceOf(out, job)), files(clipPlaceOf(straight, job)));
});

async function clipOf(folder, count) {
  const frames = folder.path('frames');
  mkdirSync(frames);
  for (let k = 0; k < count; k++) folder.file(`frames/${String(k).padStart(2, '0')}.png`, Buffer.from(png(frame(k, { width: 64, height: 48 }))));
  const [options, hashes] = [{ quality: 'fast' }, await hashesOf(frames, await framesOf(frames))];
  return { frames, options, hashes, job: clipJobOf(hashes, options) };
}

function files(place) {
  return readdirSync(place).toSorted().map((name) => [name, readFileSync(`${place}/${name}`, 'base64')]);
}
