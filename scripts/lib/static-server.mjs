// A small web server for the built page. It serves one folder, and only to this computer unless told otherwise.

import { open, realpath, stat } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, sep } from 'node:path';
import { pipeline } from 'node:stream/promises';

import { HEADERS } from './policy.mjs';
import { Stop } from './run.mjs';

const TYPES = {
  '.css': 'text/css; charset=utf-8',
  '.html': 'text/html; charset=utf-8',
  '.ico': 'image/x-icon',
  '.jpg': 'image/jpeg',
  '.js': 'text/javascript; charset=utf-8',
  '.json': 'application/json',
  '.map': 'application/json',
  '.md': 'text/markdown; charset=utf-8',
  '.mjs': 'text/javascript; charset=utf-8',
  '.png': 'image/png',
  '.svg': 'image/svg+xml',
  '.txt': 'text/plain; charset=utf-8',
  '.wasm': 'application/wasm',
  '.webmanifest': 'application/manifest+json',
  '.webp': 'image/webp',
  '.woff2': 'font/woff2',
};
const ATTEMPTS = 20;

/**
 * Serves `folder` and returns the server once it listens, on the next free port if none is given. Every response has `headers`.
 */
export async function serve(folder, { port, host, headers = HEADERS }) {
  const home = await realpath(folder);
  const first = port ?? 4173;
  const last = port === undefined ? first + ATTEMPTS : first;
  for (let candidate = first; candidate <= last; candidate += 1) {
    const server = createServer((request, response) => void answer({ home, headers }, request, response));
    const error = await listening(server, candidate, host);
    if (!error) return server;
    if (error.code !== 'EADDRINUSE') throw new Stop(`The page cannot be served on port ${candidate}: ${error.message}.`);
  }
  const where = first === last ? `Port ${first} is` : `Ports ${first} to ${last} are`;
  throw new Stop(`${where} in use: name another with \`npm start -- --port N\`.`);
}

function listening(server, port, host) {
  return new Promise((resolve) => {
    server.once('error', resolve);
    server.listen(port, host, () => resolve(undefined));
  });
}

async function answer({ home, headers }, request, response) {
  const say = (code, fields) => response.writeHead(code, { ...headers, 'X-Content-Type-Options': 'nosniff', ...fields });
  const refuse = (code, sentence, fields) => say(code, { 'Content-Type': 'text/plain; charset=utf-8', ...fields }).end(`${sentence}\n`);
  if (request.method !== 'GET' && request.method !== 'HEAD') return refuse(405, 'Only GET and HEAD.', { Allow: 'GET, HEAD' });
  const name = fileName(request.url);
  if (name === undefined) return refuse(400, 'No address of a file.');
  const path = await fileFor(home, name);
  const file = path && (await open(path).catch(() => undefined));
  if (!file) return refuse(404, 'Not found.');
  try {
    const { size } = await file.stat();
    const type = TYPES[extname(path).toLowerCase()] ?? 'application/octet-stream';
    say(200, { 'Content-Type': type, 'Content-Length': size, 'Cache-Control': 'no-cache' });
    if (request.method === 'HEAD' || size === 0) return response.end();
    return await pipeline(file.createReadStream({ end: size - 1, autoClose: false }), response);
  } catch {
    return response.destroy(); // The file cannot be read, or nobody is there to take it.
  } finally {
    await file.close();
  }
}

/** The file name in a URL; undefined if a part of it is malformed or hides a separator or NUL. */
function fileName(url) {
  try {
    const parts = new URL(url, 'http://localhost').pathname.split('/').map(decodeURIComponent);
    return parts.some((part) => /[/\\\0]/.test(part)) ? undefined : parts.join('/');
  } catch {
    return undefined;
  }
}

/** The file of that name, or undefined; never a file outside the folder, even through links. */
async function fileFor(home, name) {
  try {
    let path = await realpath(join(home, name));
    if ((await stat(path)).isDirectory()) path = await realpath(join(path, 'index.html'));
    return path.startsWith(home + sep) && (await stat(path)).isFile() ? path : undefined;
  } catch {
    return undefined; // No such file.
  }
}
