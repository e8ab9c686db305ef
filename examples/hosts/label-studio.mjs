// An ML backend for Label Studio: every task with two frames gets brush masks of what moves between them.
//
// node label-studio.mjs [--port 9090] [--host 127.0.0.1] [--known-as NAME …] [--allow ORIGIN …] [--jobs N]

import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import PQueue from 'p-queue';
import { SegmenterPool, version } from 'veronese';
import { encode } from 'veronese/formats';
import { createFetch, originOf } from './fetch-file.mjs';
import { Refusal, serveJson } from './http.mjs';
import { readConfig } from './label-config.mjs';

/** Tasks that are worked on at once, and all that may be asked for. */
const JOBS = 2;
const TASKS = 256;
const MODEL = `veronese-${version}`;

/**
 * Starts the server; `close()` of what it returns ends it. `studio` is where tasks with uploaded files are, for as long as the
 * server runs; `token` opens them, or else what the studio sends at set-up.
 */
export async function startBackend({
  port,
  host,
  knownAs,
  allow,
  jobs = JOBS,
  studio = process.env.LABEL_STUDIO_URL,
  token: configured = process.env.LABEL_STUDIO_API_KEY,
} = {}) {
  const home = studio ? originOf(studio) : undefined;
  const fetchFile = createFetch({ home, allow });
  const pool = new SegmenterPool({ jobs });
  const queue = new PQueue({ concurrency: jobs });
  let token = configured;

  const health = () => ({ status: 'UP', model_class: 'Veronese' });
  const routes = {
    'GET /': health,
    'GET /health': health,
    'GET /versions': () => ({ versions: [MODEL] }),
    'POST /setup': ({ hostname, access_token: sent }) => {
      const isOurs = URL.canParse(hostname) && new URL(hostname).origin === home;
      if (!configured && isOurs && typeof sent === 'string' && /^[\x21-\x7e]+$/.test(sent)) token = sent;
      return { model_version: MODEL };
    },
    'POST /webhook': () => ({ status: 'nothing to learn' }),
    'POST /predict': async ({ tasks, label_config: config }, signal) => {
      if (!Array.isArray(tasks)) throw new Refusal(400, 'invalid-input', 'tasks must be a list');
      if (tasks.length > TASKS) throw new Refusal(413, 'too-many-tasks', `a request has at most ${TASKS} tasks`);
      if (tasks.length > TASKS - queue.size - queue.pending)
        throw new Refusal(503, 'busy', 'others are waiting already', { 'Retry-After': '10' });
      const wanted = readConfig(config);
      const results = await Promise.all(tasks.map((task) => queue.add(() => masks(Object(task).data, wanted, signal), { signal })));
      return { results: results.map((result) => ({ ...result, model_version: MODEL })) };
    },
  };

  /** Of two frames. */
  async function masks(data, { fromName, toName, labels, keys }, signal) {
    const files = await Promise.all(keys.map((key) => fetchFile(addressIn(data, key), { token, signal })));
    const found = await pool.segmentPair(...files.map((file) => new Blob([file])), { confidence: true, signal });
    // The dominant motion, usually the background, is nobody's mask; the others take the labels of the configuration in order.
    const motions = found.motions.slice(1, 1 + labels.length);
    const names = Object.fromEntries(motions.map(({ label }, index) => [label, labels[index]]));
    const metadata = { names, labels: motions.map(({ label }) => label), fromName, toName, modelVersion: MODEL };
    const [{ content }] = await encode('label-studio', found, metadata);
    // The mean probability that a pixel's label is right.
    const score = found.confidence.reduce((sum, value) => sum + value, 0) / (255 * found.confidence.length);
    return { result: JSON.parse(content)[0].predictions[0].result, score };
  }

  const server = await serveJson(routes, { port, host, knownAs });
  const close = () => {
    server.close();
    pool.close();
  };
  return { address: server.address, close };
}

function addressIn(data, key) {
  if (typeof data?.[key] !== 'string') throw new Refusal(422, 'invalid-input', `the task has no '${key}'`);
  return data[key];
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [text, list] = [{ type: 'string' }, { type: 'string', multiple: true }];
  const { values } = parseArgs({ options: { port: { ...text, default: '9090' }, host: text, 'known-as': list, allow: list, jobs: text } });
  const numbers = Object.fromEntries(
    ['port', 'jobs'].flatMap((name) => (values[name] === undefined ? [] : [[name, Number(values[name])]])),
  );
  const server = await startBackend({ ...values, ...numbers, knownAs: values['known-as'] });
  console.log(`ML backend at ${server.address}`);
  for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, server.close);
}
