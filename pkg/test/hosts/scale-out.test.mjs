// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { SegmenterPool } from 'veronese';
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

test('a clip whose worker is lost goes on at the last frame solved, to the same files', async (t) => {
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
  assert.deepEqual(await performClip(pool, { ...task, out: straight }), { did: true, known: 0, solved: 8 });
  const found = files(clipPlaceOf(out, job));
  assert.deepEqual(found, files(clipPlaceOf(straight, job)));
  assert.deepEqual(found.map(([name]) => name), [...Array.from({ length: 8 }, (_, k) => `0${k}.png.png`), 'clip.json']);
  assert.deepEqual(await performClip(pool, { ...task, out }), { did: false, known: 0, solved: 0 });
});

async function clipOf(folder, count) {
  const frames = folder.path('frames');
  mkdirSync(frames);
  for (let k = 0; k < count; k++) folder.file(`frames/${String(k).padStart(2, '0')}.png`, Buffer.from(png(frame(k, { width: 64, height: 48 }))));
  const [options, hashes] = [{ quality: 'fast' }, await hashesOf(frames, await framesOf(frames))];
  return { frames, options, job: clipJobOf(hashes, options) };
}

function files(place) {
  return readdirSync(place).toSorted().map((name) => [name, readFileSync(`${place}/${name}`, 'base64')]);
}
