// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { SegmenterPool } from 'veronese';
import { jobOf, perform, placeOf, resultOf, sha256 } from '../../../examples/scale-out/job.mjs';
import { prove, redisServer } from '../../../scripts/lib/scale-out.mjs';
import { pair, png } from '../support/frames.mjs';
import { temporaryFolder } from '../support/program.mjs';

const program = await redisServer();

test('every pair exactly once, though a worker is killed and the Redis server restarted', { skip: !program && 'there is no redis-server and no valkey-server' }, async () => {
  const { pairs } = await prove(program, { pairs: 60, size: { width: 48, height: 36 } });
  assert.equal(pairs, 60);
});

test('a result that was edited, damaged or lost its image is done again', async (t) => {
  const folder = temporaryFolder(t);
  const pool = new SegmenterPool({ jobs: 1 });
  t.after(() => pool.close());
  const options = { quality: 'fast', seed: 1 };
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

  // What lies in the frames is a result without an image, and is looked at in the same way.
  const bad = Buffer.from('no image');
  const failing = { ...task, job: jobOf([sha256(bad), sha256(two)], options), first: folder.file('bad.png', bad) };
  assert.equal(await perform(pool, failing), true);
  assert.equal((await resultOf(out, failing.job)).error.code, 'unreadable-image');
  assert.equal(await perform(pool, failing), false);
});
