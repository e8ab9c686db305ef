// A small JSON server for programs, not for pages: who may ask, how much a body may hold, errors with a code.

import { setMaxListeners } from 'node:events';
import { createServer } from 'node:http';
import ipaddr from 'ipaddr.js';

/** Largest body, bytes, and how many bytes of bodies may be held at once for all requests together. */
const LARGEST = 16 * 1024 * 1024;
const HELD = 4;
/** A body that has not arrived after so many milliseconds never will. */
const PATIENCE = 60_000;
const CONNECTIONS = 256;

/** An answer with the fault of the request. */
export class Refusal extends Error {
  constructor(status, code, message, headers = {}) {
    super(message);
    Object.assign(this, { status, code, headers });
  }
}

/**
 * `routes`: functions of the parsed body and an `AbortSignal` by 'METHOD /path'; the signal is aborted when nobody waits for the answer
 * any more. Listens on this computer alone by default. `knownAs`: the names under which others reach it, beside
 * `host`, the address itself and `localhost`.
 */
export async function serveJson(routes, { port = 0, host = '127.0.0.1', knownAs = [], largest = LARGEST } = {}) {
  const known = new Set(['localhost', host, ...knownAs].map((name) => hostname(name)));
  const budget = { largest, left: HELD * largest };
  const server = createServer((request, response) => void answer({ routes, known, budget }, request, response));
  server.requestTimeout = PATIENCE;
  server.maxConnections = CONNECTIONS;
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, host, resolve));
  const { address, port: taken } = server.address();
  return {
    address: `http://${address.includes(':') ? `[${address}]` : address}:${taken}`,
    close: () => {
      server.close();
      server.closeAllConnections();
    },
  };
}

async function answer({ routes, known, budget }, request, response) {
  const gone = new AbortController();
  // Every task of a request listens.
  setMaxListeners(0, gone.signal);
  response.once('close', () => gone.abort());
  const send = (status, body, headers = {}) => {
    const type = { 'Content-Type': 'application/json', 'X-Content-Type-Options': 'nosniff' };
    response.writeHead(status, { ...type, ...headers }).end(JSON.stringify(body));
  };
  const held = { bytes: 0 };
  try {
    checkHost(known, request);
    const route = routes[`${request.method} ${path(request)}`];
    if (!route) throw new Refusal(404, 'not-found', `there is no ${request.method} ${request.url}`);
    send(200, await route(request.method === 'POST' ? await body(request, budget, held) : undefined, gone.signal));
  } catch (error) {
    if (gone.signal.aborted) return;
    // Whatever else was begun for this request has lost its purpose.
    gone.abort();
    const { status, code, message, headers } = refusal(error);
    if (!response.headersSent) send(status, { error: { code, message } }, headers);
  } finally {
    budget.left += held.bytes;
  }
}

/**
 * A page whose host name was made to point here (DNS rebinding) counts as of one origin with this server, but its browser
 * sends that name.
 */
function checkHost(known, { headers, socket }) {
  const name = hostname(headers.host ?? '');
  if (name !== '' && (known.has(name) || name === plain(socket.localAddress))) return;
  throw new Refusal(403, 'unknown-host', `this server is not known as '${headers.host ?? ''}': start it with --known-as NAME`);
}

/** An address as it is written in URLs: that of IPv4 where a socket of IPv6 has one. */
function plain(address) {
  return ipaddr.isValid(address ?? '') ? ipaddr.process(address).toString() : undefined;
}

/** The name in `name`, `name:port` or `[::1]:port`, written in the one way that URLs have; empty where there is none. */
function hostname(text) {
  const name = text.includes(':') && !text.startsWith('[') && ipaddr.isValid(text) ? `[${text}]` : text;
  if (/[/\\?#@\s]/.test(name) || !URL.canParse(`http://${name}`)) return '';
  return new URL(`http://${name}`).hostname.replace(/^\[|\]$/g, '');
}

function path({ url }) {
  if (!URL.canParse(url, 'http://localhost')) throw new Refusal(400, 'invalid-input', `'${url}' is no address`);
  return new URL(url, 'http://localhost').pathname.replace(/(?<=.)\/$/, '');
}

/** Errors of Veronese are the request's fault (422), all others ours (500). */
function refusal(error) {
  if (error instanceof Refusal) return error;
  if (error.name !== 'VeroneseError') console.error(error);
  const ours = error.name !== 'VeroneseError' || ['internal', 'worker-failed', 'wasm-load-failed'].includes(error.code);
  return new Refusal(ours ? 500 : 422, error.name === 'VeroneseError' ? error.code : 'internal', error.message);
}

async function body(request, budget, held) {
  // A page may send anything else to any server without asking first; for JSON its browser asks, and gets no leave.
  if (!/^application\/json *(;|$)/i.test(request.headers['content-type'] ?? '')) {
    throw new Refusal(415, 'not-json', 'the Content-Type of a request is application/json');
  }
  return parse(await received(request, budget, held));
}

/** The bytes of a body. What follows a refusal is discarded by the server, so that the sender gets to read it. */
function received(request, budget, held) {
  return new Promise((resolve, reject) => {
    const pieces = [];
    const refuse = (error) => {
      request.off('data', take);
      pieces.length = 0;
      reject(error);
    };
    const tooLarge = () => refuse(new Refusal(413, 'too-large', `a request has at most ${budget.largest} bytes`));
    const take = (piece) => {
      if (held.bytes + piece.length > budget.largest) return tooLarge();
      if (piece.length > budget.left) return refuse(new Refusal(503, 'busy', 'too many requests at once', { 'Retry-After': '10' }));
      budget.left -= piece.length;
      held.bytes += piece.length;
      return pieces.push(piece);
    };
    if (Number(request.headers['content-length']) > budget.largest) return tooLarge();
    request.on('data', take).once('end', () => resolve(Buffer.concat(pieces)));
    return request.once('error', reject).once('close', () => reject(new Refusal(400, 'invalid-input', 'the request has no end')));
  });
}

/** A JSON object: nothing that is asked here is anything else. */
function parse(bytes) {
  let value;
  try {
    value = JSON.parse(bytes.toString());
  } catch (error) {
    throw new Refusal(400, 'invalid-json', `the request is not JSON: ${error.message}`);
  }
  if (!isObject(value)) throw new Refusal(400, 'invalid-input', 'a request is a JSON object');
  return value;
}

export function isObject(value) {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
