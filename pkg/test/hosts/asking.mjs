// Servers for the servers: files to fetch, and ways to ask.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { png } from '../support/frames.mjs';
import { frame } from '../support/moving.mjs';

/** Frames of a clip: a square moves over a background that is at rest, or moves by `options`. */
export function clip(length = 8, options) {
  return Array.from({ length }, (_, k) => frame(k, { width: 96, height: 72, ...options }));
}

/** The bytes of a video with exactly these frames. */
export function video(pictures) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-test-'));
  try {
    pictures.forEach((picture, k) => writeFileSync(join(folder, `${k}.png`), png(picture)));
    const file = join(folder, 'video.mkv');
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', '-framerate', '10', '-i', join(folder, '%d.png'), '-c:v', 'ffv1', '-pix_fmt', 'bgr0', file]);
    if (status !== 0) throw new Error(String(stderr));
    return readFileSync(file);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
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
