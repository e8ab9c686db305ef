// Servers for the servers: files to fetch, and ways to ask.

import { createServer, request } from 'node:http';
import { png } from '../support/frames.mjs';
import { pair } from '../support/moving.mjs';

export const frames = pair();

export const CONFIG = `<View>
  <Image name="before" value="$first"/><Image name="after" value="$second"/>
  <BrushLabels name="moving" toName="before"><Label value="car &amp; shadow" background="#f00"/><Label value="second"/></BrushLabels>
</View>`;

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
    const [, index] = /^\/(?:data\/)?(\d)\.png$/.exec(url) ?? [];
    const upload = url.startsWith('/data/');
    if (upload && headers.authorization !== 'Token secret') response.writeHead(401).end();
    else if (upload && headers.accept !== '*/*') response.writeHead(406).end();
    else if (!frames[index]) response.writeHead(404).end();
    else response.end(png(frames[index]));
  });
  return { origin, asked };
}

/** Asks a server for what `body` says; a text is sent as it is. */
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

/** A request of Label Studio for the masks of one task. */
export function task(first, second) {
  return { tasks: [{ data: { first, second } }], label_config: CONFIG };
}
