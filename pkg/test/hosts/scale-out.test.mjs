// examples/scale-out, where there is a Redis or Valkey server.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { prove, redisServer } from '../../../scripts/lib/scale-out.mjs';

const program = await redisServer();

test('every pair exactly once, though a worker is killed and the Redis server restarted', { skip: !program && 'there is no redis-server and no valkey-server' }, async () => {
  const { pairs } = await prove(program, { pairs: 60, size: { width: 48, height: 36 } });
  assert.equal(pairs, 60);
});
