// A small JSON server: bodies with a limit, errors with a code, nothing else.

import { createServer } from 'node:http';

/** Largest body, bytes: two frames of 4096 × 4096 pixels as base64 of PNG. */
const LARGEST = 256 * 1024 * 1024;

/** An answer that says what is wrong with the request. */
export class Refusal extends Error {
  constructor(status, code, message) {
    super(message);
    Object.assign(this, { status, code });
  }
}

/** `routes`: functions of the parsed body by 'METHOD /path'. Listens on this computer alone unless told otherwise. */
export async function serveJson(routes, { port = 0, host = '127.0.0.1' } = {}) {
  const server = createServer(async (request, response) => {
    const send = (status, body) => response.writeHead(status, { 'Content-Type': 'application/json' }).end(JSON.stringify(body));
    try {
      const { pathname } = new URL(request.url, 'http://localhost');
      const route = routes[`${request.method} ${pathname.replace(/(?<=.)\/$/, '')}`];
      if (!route) throw new Refusal(404, 'not-found', `there is no ${request.method} ${pathname}`);
      send(200, await route(request.method === 'POST' ? await body(request) : undefined));
    } catch (error) {
      const { status, code, message } = refusal(error);
      if (!response.headersSent) send(status, { error: { code, message } });
    }
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, host, resolve));
  return server;
}

/** What Veronese refuses is the request's fault (422); what else happens is ours (500). */
function refusal(error) {
  if (error instanceof Refusal) return error;
  if (error.name !== 'VeroneseError') console.error(error);
  const ours = error.name !== 'VeroneseError' || ['internal', 'worker-failed', 'wasm-load-failed'].includes(error.code);
  return new Refusal(ours ? 500 : 422, error.name === 'VeroneseError' ? error.code : 'internal', error.message);
}

async function body(request) {
  const pieces = [];
  let length = 0;
  for await (const piece of request) {
    length += piece.length;
    if (length > LARGEST) throw new Refusal(413, 'too-large', `a request has at most ${LARGEST} bytes`);
    pieces.push(piece);
  }
  try {
    return JSON.parse(Buffer.concat(pieces).toString() || '{}');
  } catch (error) {
    throw new Refusal(400, 'invalid-json', `the request is not JSON: ${error.message}`);
  }
}
