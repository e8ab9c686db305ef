// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { Segmenter, SegmenterPool } from 'veronese';
import { blockJobOf, performBlock } from '../../../examples/scale-out/block.mjs';
import { clipJobOf, clipPlaceOf, clipResultOf, framesOf, hashesOf, pairsPlaceOf, performClip } from '../../../examples/scale-out/clip.mjs';
import { jobOf, perform, placeOf, resultOf, sha256 } from '../../../examples/scale-out/job.mjs';
import { frame, pair, png } from '../support/frames.mjs';
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

test('a result that was edited, damaged or lost its image is done again', async (t) => {
  const folder = temporaryFolder(t);
  const pool = new SegmenterPool({ jobs: 1 });
  t.after(() => pool.close());
  const options = { quality: 'fast' };
  const [one, two] = pair().map((picture) => Buffer.from(png(picture)));
  const files = { first: folder.file('1.png', one), second: folder.file('2.png', two) };
  const out = folder.path('out');
  const job = jobOf([sha256(one), sha256(two)], options);
  const task = { job, ...files, out, options };
  assert.equal(await resultOf(out, job), undefined);
  assert.equal(await perform(pool, task), true);
  assert.equal(await perform(pool, task), false);
  const place = placeOf(out, job);
  const [json, image] = [place.json, place.png].map((path) => readFileSync(path));
  const damages = {
    'an edited count': () => writeFileSync(place.json, String(json).replace('"count":', '"count":1')),
    'half a report': () => writeFileSync(place.json, json.subarray(0, json.length / 2)),
    'an empty report': () => writeFileSync(place.json, ''),
    'null': () => writeFileSync(place.json, 'null'),
    'an image cut off': () => writeFileSync(place.png, image.subarray(0, -1)),
    'no image': () => rmSync(place.png),
  };
  for (const [title, damage] of Object.entries(damages)) {
    damage();
    assert.equal(await resultOf(out, job), undefined, title);
    assert.equal(await perform(pool, task), true, title);
    assert.deepEqual([place.json, place.png].map((path) => readFileSync(path)), [json, image], title);
  }

  // An error of the frames is a result without an image, and is looked at in the same way.
  const bad = Buffer.from('no image');
  const failing = { ...task, job: jobOf([sha256(bad), sha256(two)], options), first: folder.file('bad.png', bad) };
  assert.equal(await perform(pool, failing), true);
  assert.equal((await resultOf(out, failing.job)).error.code, 'unreadable-image');
  assert.equal(await perform(pool, failing), false);
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

  rmSync(`${clipPlaceOf(out, job)}/03.png.png`);
  assert.equal(await clipResultOf(out, job), undefined, 'an image is missing');
  assert.equal((await performClip(pool, { ...task, out })).did, true);
  assert.deepEqual(files(clipPlaceOf(out, job)), found);
});

test('a frame that cannot be read is told by the job of its clip, not by that of its block', async (t) => {
  const folder = temporaryFolder(t);
  const { frames, options } = await clipOf(folder, 6);
  writeFileSync(`${frames}/03.png`, 'no image');
  const hashes = await hashesOf(frames, await framesOf(frames));
  const [job, out] = [clipJobOf(hashes, options), folder.path('out')];
  const segmenter = new Segmenter();
  t.after(() => segmenter.close());
  const block = { job: blockJobOf(job, hashes.slice(0, 5)), clip: job, folder: frames, from: 0, to: 4, out, options };
  assert.deepEqual(await performBlock(segmenter, block), { did: true, known: 0 });
  assert.deepEqual(readdirSync(pairsPlaceOf(out, job)).toSorted(), ['1', '2']);
  assert.equal((await performClip(segmenter, { job, folder: frames, out, options })).did, true);
  assert.equal((await clipResultOf(out, job)).error.code, 'unreadable-image');
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
