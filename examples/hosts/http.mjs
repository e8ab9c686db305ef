// A small JSON server for programs, not for pages: who may ask, how much a body may hold, errors with a code.

import { setMaxListeners } from 'node:events';
import { createServer } from 'node:http';

/** Largest body, bytes. One that has not arrived after so many milliseconds never will. */
const LARGEST = 16 * 1024 * 1024;
const PATIENCE = 60_000;
const CONNECTIONS = 32;

/** An answer with the fault of the request. */
export class Refusal extends Error {
  constructor(status, code, message, headers = {}) {
    super(message);
    Object.assign(this, { status, code, headers });
  }
}

/**
 * `routes`: functions of the parsed body and an `AbortSignal` by 'METHOD /path'; the signal is aborted when nobody waits for the answer any
 * more. Listens on this computer alone by default. `knownAs`: the names under which others reach it.
 */
export async function serveJson(routes, { port = 0, host = '127.0.0.1', knownAs = [] } = {}) {
  const known = new Set(['localhost', host, ...knownAs].map((name) => name.toLowerCase()));
  const server = createServer((request, response) => void answer(routes, known, request, response));
  server.requestTimeout = PATIENCE;
  server.maxConnections = CONNECTIONS;
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, host, resolve));
  const { address, port: taken } = server.address();
  const close = () => {
    server.close();
    server.closeAllConnections();
  };
  return { address: `http://${address.includes(':') ? `[${address}]` : address}:${taken}`, close };
}

async function answer(routes, known, request, response) {
  const gone = new AbortController();
  // Every task of a request listens.
  setMaxListeners(0, gone.signal);
  response.once('close', () => gone.abort());
  const send = (status, content, headers = {}) =>
    response.writeHead(status, { 'Content-Type': 'application/json', ...headers }).end(JSON.stringify(content));
  try {
    checkHost(known, request);
    const route = routes[`${request.method} ${request.url.replace(/\?.*/, '').replace(/(?<=.)\/$/, '')}`];
    if (!route) throw new Refusal(404, 'not-found', `there is no ${request.method} ${request.url}`);
    send(200, await route(request.method === 'POST' ? await bodyOf(request) : undefined, gone.signal));
  } catch (error) {
    if (gone.signal.aborted) return;
    // Whatever else was begun for this request has lost its purpose.
    gone.abort();
    const { status, code, message, headers } = refusal(error);
    send(status, { error: { code, message } }, headers);
  }
}

/** A page whose host name was made to point here (DNS rebinding) counts as of one origin with this server, but its browser sends that name. */
function checkHost(known, { headers: { host = '' }, socket }) {
  const name = host
    .replace(/:\d*$/, '')
    .replace(/^\[|\]$/g, '')
    .toLowerCase();
  if (known.has(name) || name === socket.localAddress.replace('::ffff:', '')) return;
  throw new Refusal(403, 'unknown-host', `this server is not known as '${host}': start it with --known-as NAME`);
}

/** The object in a request. A page may send anything but JSON to any server without asking first. */
async function bodyOf(request) {
  if (!/^application\/json *(;|$)/i.test(request.headers['content-type'] ?? '')) {
    throw new Refusal(415, 'not-json', 'the Content-Type of a request is application/json');
  }
  const [pieces, size] = [[], { bytes: 0 }];
  for await (const piece of request) {
    size.bytes += piece.length;
    if (size.bytes > LARGEST) throw new Refusal(413, 'too-large', `a request has at most ${LARGEST} bytes`);
    pieces.push(piece);
  }
  try {
    return Object(JSON.parse(Buffer.concat(pieces).toString()));
  } catch (error) {
    throw new Refusal(400, 'invalid-json', `the request is not JSON: ${error.message}`);
  }
}

/** Errors of Veronese are the request's fault (422), all others ours (500). */
function refusal(error) {
  if (error instanceof Refusal) return error;
  const isRequests = error.name === 'VeroneseError' && !['internal', 'worker-failed', 'wasm-load-failed'].includes(error.code);
  if (!isRequests) console.error(error);
  return new Refusal(isRequests ? 422 : 500, isRequests ? error.code : 'internal', error.message);
}
