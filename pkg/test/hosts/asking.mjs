// Servers for the servers: files to fetch, and ways to ask.

import { createServer } from 'node:http';
import { frame } from '../support/moving.mjs';

/** Frames of a clip: a square moves over a background that is at rest, or moves by `options`. */
export function clip(length = 8, options) {
  return Array.from({ length }, (_, k) => frame(k, { width: 96, height: 72, ...options }));
}

/** A server on loopback that ends with the test, and its origin. */
export async function listen(t, answer) {
  const server = createServer(answer);
  await new Promise((resolve, reject) => server.once('error', reject).listen(0, '127.0.0.1', resolve));
  t.after(() => {
    server.close();
    server.closeAllConnections();
  });
  return `http://127.0.0.1:${server.address().port}`;
}

/** Sends a server this `body` as JSON. */
export async function post(address, body, headers = {}) {
  const response = await fetch(address, { method: 'POST', headers: { 'Content-Type': 'application/json', ...headers }, body: JSON.stringify(body) });
  return { status: response.status, body: await response.json() };
}
