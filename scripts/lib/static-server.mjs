// A small web server for the built page: files of one folder, on this computer only unless told otherwise.

import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, sep } from 'node:path';

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
  '.png': 'image/png',
  '.svg': 'image/svg+xml',
  '.txt': 'text/plain; charset=utf-8',
  '.wasm': 'application/wasm',
  '.webmanifest': 'application/manifest+json',
  '.webp': 'image/webp',
};
const ATTEMPTS = 20;

/**
 * Serves `folder` and returns the server once it listens; without a wish for a port the next free one is taken. `headers` go with
 * every answer.
 */
export async function serve(folder, { port, host, headers = HEADERS }) {
  const first = port ?? 4173;
  const last = port === undefined ? first + ATTEMPTS : first;
  for (let candidate = first; candidate <= last; candidate += 1) {
    const server = createServer((request, response) => answer({ folder, headers }, request, response));
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

function answer({ folder, headers }, request, response) {
  const refuse = (code, sentence) => {
    response.writeHead(code, { ...headers, 'Content-Type': 'text/plain; charset=utf-8' });
    response.end(`${sentence}\n`);
  };
  if (request.method !== 'GET' && request.method !== 'HEAD') return refuse(405, 'Only GET and HEAD.');
  const path = fileFor(folder, request.url);
  if (!path) return refuse(404, 'Not found.');
  const type = TYPES[extname(path).toLowerCase()] ?? 'application/octet-stream';
  response.writeHead(200, { ...headers, 'Content-Type': type, 'Content-Length': statSync(path).size, 'Cache-Control': 'no-cache' });
  if (request.method === 'HEAD') return response.end();
  return createReadStream(path).on('error', () => response.destroy()).pipe(response);
}

/** The file an address means, or undefined; never one outside the folder. */
function fileFor(folder, url) {
  try {
    const name = decodeURIComponent(new URL(url, 'http://localhost').pathname);
    let path = normalize(join(folder, name));
    if (path !== folder && !path.startsWith(folder + sep)) return undefined;
    if (statSync(path).isDirectory()) path = join(path, 'index.html');
    return statSync(path).isFile() ? path : undefined;
  } catch {
    return undefined; // No such file, or an address that is none.
  }
}
