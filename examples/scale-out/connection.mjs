// The connection to Redis or Valkey that all three programs use.

import { Redis } from 'ioredis';

/** Waits for a server that is away instead of giving up, and logs it once. */
export function connect(url = process.env.REDIS_URL ?? 'redis://127.0.0.1:6379') {
  const connection = new Redis(url, { maxRetriesPerRequest: null, retryStrategy: (attempt) => Math.min(attempt * 100, 2000) });
  let away = false;
  connection.on('error', (error) => {
    if (!away) console.error(`redis: ${error.message || error.code}; waiting for it`);
    away = true;
  });
  connection.on('ready', () => {
    if (away) console.error('redis: there again');
    away = false;
  });
  return connection;
}
