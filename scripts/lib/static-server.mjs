// A web server for built pages: sirv, with headers of our own. It serves one folder, and only to this computer unless told otherwise.

import { createServer } from 'node:http';

import { HEADERS } from './policy.mjs';
import { Stop } from './run.mjs';

const ATTEMPTS = 20;

/**
 * Serves `folder` and returns the server once it listens, on the next free port if none is given. Every response has `headers`.
 */
export async function serve(folder, { port, host, headers = HEADERS }) {
  // Loaded when it is needed: this file is also imported before npm has installed anything.
  const { default: sirv } = await import('sirv');
  // Files are looked up when they are asked for, those of .tools too.
  const files = sirv(folder, { dev: true, dotfiles: true });
  const answer = (request, response) => {
    for (const [name, value] of Object.entries({ ...headers, 'X-Content-Type-Options': 'nosniff' })) response.setHeader(name, value);
    if (request.method === 'GET' || request.method === 'HEAD') files(request, response);
    else response.writeHead(405, { Allow: 'GET, HEAD' }).end();
  };
  const first = port ?? 4173;
  const last = port === undefined ? first + ATTEMPTS : first;
  for (let candidate = first; candidate <= last; candidate += 1) {
    const server = createServer(answer);
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
