// An ML backend for Label Studio: every task with two frames gets brush masks of what moves between them.
//
// node label-studio.mjs [--port 9090] [--host 127.0.0.1] [--jobs N]

import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { encodeLabelStudio } from 'veronese/formats';
import { version } from 'veronese';
import { Refusal, serveJson } from './http.mjs';
import { readConfig } from './label-config.mjs';
import { createSegment, score } from './segment.mjs';

export { readConfig };

/** Largest frame file that is fetched, bytes, and how long that may take, milliseconds: Label Studio itself gives up after 100 s. */
const LARGEST = 64 * 1024 * 1024;
const PATIENCE = 30_000;
const MODEL = `veronese-${version}`;

/** Starts the server; `close()` of what it returns ends it. */
export async function startBackend({ port, host, jobs } = {}) {
  const { segment, close } = createSegment({ jobs });
  /** Where tasks with uploaded files are, as Label Studio says at set-up. */
  let studio = { hostname: process.env.LABEL_STUDIO_URL, token: process.env.LABEL_STUDIO_API_KEY };

  const routes = {
    'GET /': health,
    'GET /health': health,
    'GET /versions': () => ({ versions: [MODEL] }),
    'POST /setup': ({ hostname, access_token: token }) => {
      studio = { hostname: studio.hostname ?? hostname, token: studio.token ?? token };
      return { model_version: MODEL };
    },
    'POST /webhook': () => ({ status: 'nothing to learn' }),
    'POST /predict': async ({ tasks, label_config: config }) => {
      if (!Array.isArray(tasks)) throw new Refusal(400, 'invalid-input', 'tasks must be a list');
      const wanted = readConfig(config);
      return { results: await Promise.all(tasks.map((task) => predict(task, wanted))) };
    },
  };

  async function predict({ data }, { fromName, toName, labels, keys }) {
    const files = await Promise.all(keys.map((key) => fetchFrame(data?.[key], key, studio)));
    const found = await segment(files[0], files[1], { confidence: true });
    // The dominant motion, usually the background, is nobody's mask; the others take the labels of the configuration in order.
    const motions = found.motions.slice(1, 1 + labels.length);
    const names = Object.fromEntries(motions.map(({ label }, index) => [label, labels[index]]));
    const meta = { names, labels: motions.map(({ label }) => label), motions: found.motions };
    const task = encodeLabelStudio(found.labels, found.width, found.height, meta, { fromName, toName, modelVersion: MODEL });
    return { result: task.predictions[0].result, score: score(found), model_version: MODEL };
  }

  const server = await serveJson(routes, { port, host });
  return {
    address: `http://${server.address().address}:${server.address().port}`,
    close: () => {
      server.close();
      server.closeAllConnections();
      close();
    },
  };
}

function health() {
  return { status: 'UP', model_class: 'Veronese' };
}

/** A frame by its address; one without a host is a file uploaded to Label Studio, which wants the token. */
async function fetchFrame(address, key, { hostname, token }) {
  if (typeof address !== 'string') throw new Refusal(422, 'invalid-input', `the task has no '${key}'`);
  const own = address.startsWith('/');
  if (own && !hostname) throw new Refusal(422, 'invalid-input', `'${address}' is a file of Label Studio: set LABEL_STUDIO_URL and LABEL_STUDIO_API_KEY`);
  if (!own && !/^https?:/.test(address)) throw new Refusal(422, 'invalid-input', `'${key}' must be an address of http or https`);
  const headers = own && token ? { Authorization: `Token ${token}` } : {};
  let response;
  try {
    response = await fetch(own ? new URL(address, hostname) : address, { headers, signal: AbortSignal.timeout(PATIENCE) });
  } catch (error) {
    throw new Refusal(422, 'file-not-found', `${address} cannot be fetched: ${error.cause?.message ?? error.message}`);
  }
  if (!response.ok) throw new Refusal(422, 'file-not-found', `${address} answered ${response.status}`);
  return limited(response, address);
}

async function limited(response, address) {
  const pieces = [];
  let length = 0;
  for await (const piece of response.body) {
    length += piece.length;
    if (length > LARGEST) throw new Refusal(422, 'unreadable-file', `${address} has more than ${LARGEST} bytes`);
    pieces.push(piece);
  }
  return new Uint8Array(Buffer.concat(pieces));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const text = { type: 'string' };
  const { values } = parseArgs({ options: { port: { ...text, default: '9090' }, host: text, jobs: text } });
  const jobs = values.jobs === undefined ? undefined : Number(values.jobs);
  startBackend({ port: Number(values.port), host: values.host, jobs }).then((server) => {
    console.log(`ML backend at ${server.address}`);
    for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, () => server.close());
  });
}
