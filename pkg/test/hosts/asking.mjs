// Servers for the servers: files to fetch, and ways to ask.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer, request } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { startBackend } from '../../../examples/hosts/label-studio.mjs';
import { png } from '../support/frames.mjs';
import { frame, pair } from '../support/moving.mjs';

export const frames = pair();

/** Frames of a clip: a square moves over a background that is at rest, or moves by `options`. */
export function clip(length = 8, options) {
  return Array.from({ length }, (_, k) => frame(k, { width: 96, height: 72, ...options }));
}

export const CONFIG = `<View>
  <Image name="before" value="$first"/><Image name="after" value="$second"/>
  <BrushLabels name="moving" toName="before"><Label value="car &amp; shadow" background="#f00"/><Label value="second"/></BrushLabels>
</View>`;

/** For boxes on a video. */
export const VIDEO_CONFIG = `<View>
  <Labels name="kinds" toName="film"><Label value="car"/><Label value="other"/></Labels>
  <Video name="film" value="$video" frameRate="$fps"/><VideoRectangle name="box" toName="film"/>
</View>`;

/** Why there can be no videos, or false. */
export const withoutVideos = ['ffmpeg', 'ffprobe'].some((name) => spawnSync(name, ['-version']).status !== 0) && 'the program ffmpeg is not installed';

/** The bytes of a video with exactly these frames. */
export function video(pictures, { rate = 10, format = 'matroska' } = {}) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-test-'));
  try {
    pictures.forEach((picture, k) => writeFileSync(join(folder, `${k}.png`), png(picture)));
    const file = join(folder, 'video');
    const codec = ['-c:v', 'ffv1', '-pix_fmt', 'bgr0', '-f', format];
    const { status, stderr } = spawnSync('ffmpeg', ['-v', 'error', '-framerate', String(rate), '-i', join(folder, '%d.png'), ...codec, file]);
    if (status !== 0) throw new Error(String(stderr));
    return readFileSync(file);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** A request of Label Studio for the boxes of one video. */
export function videoTask(address, data = { fps: 10 }) {
  return { tasks: [{ data: { video: address, ...data } }], label_config: VIDEO_CONFIG };
}

/** The address of a Label Studio backend that ends with the test. */
export async function backend(t, options = {}) {
  const started = await startBackend({ jobs: 1, ...options });
  t.after(() => started.close());
  return started.address;
}

/** A server on loopback that ends with the test, and its origin. */
export async function listen(t, answer, host = '127.0.0.1') {
  const server = createServer(answer);
  await new Promise((resolve, reject) => server.once('error', reject).listen(0, host, resolve));
  t.after(() => {
    server.close();
    server.closeAllConnections();
  });
  return `http://${host}:${server.address().port}`;
}

/**
 * The frames on a server of their own; those below /data want a token, and that everything is accepted, as Label Studio's uploads
 * do. `asked` is what came.
 */
export async function files(t) {
  const asked = [];
  const origin = await listen(t, (incoming, response) => {
    const { url, headers } = incoming;
    asked.push({ url, token: headers.authorization });
    const [, index] = /^\/(?:data\/)?(?:upload\/.*-)?(\d)\.png$/.exec(url) ?? [];
    const upload = url.startsWith('/data/');
    if (upload && headers.authorization !== 'Token secret') response.writeHead(401).end();
    else if (upload && headers.accept !== '*/*') response.writeHead(406).end();
    else if (!frames[index]) response.writeHead(404).end();
    else response.end(png(frames[index]));
  });
  return { origin, asked };
}

/** Sends a server this `body`; a text is sent as it is. */
export async function post(address, body, headers = {}) {
  const text = typeof body === 'string' ? body : JSON.stringify(body);
  const response = await fetch(address, { method: 'POST', headers: { 'Content-Type': 'application/json', ...headers }, body: text });
  return { status: response.status, headers: response.headers, body: await response.json() };
}

/** As `post`, with a `Host` that fetch would not send. */
export function postAs(host, address, body, method = 'POST') {
  return new Promise((resolve, reject) => {
    const headers = { Host: host, 'Content-Type': 'application/json' };
    const asking = request(address, { method, headers }, async (response) => {
      const pieces = await response.toArray();
      resolve({ status: response.statusCode, body: JSON.parse(Buffer.concat(pieces)) });
    });
    asking.on('error', reject).end(body && JSON.stringify(body));
  });
}

/**
 * The bodies of /setup and /predict that Label Studio 1.23.2 sent, word for word but for the token: `pairs` of a project with the first
 * configuration of its page, `videos` with the second. `label-studio start` of PyPI's package sent them, when a model was connected and
 * predictions were retrieved. Here Label Studio is at `origin`.
 */
export function recorded(origin) {
  const text = readFileSync(new URL('label-studio.json', import.meta.url), 'utf8');
  return JSON.parse(text.replaceAll('http://localhost:8097', origin));
}

/** A request of Label Studio for the masks of one task. */
export function task(first, second) {
  return { tasks: [{ data: { first, second } }], label_config: CONFIG };
}
