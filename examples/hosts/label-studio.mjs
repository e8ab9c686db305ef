// An ML backend for Label Studio: every task with two frames gets brush masks of what moves between them, every task with a video
// boxes that follow its objects.
//
// node label-studio.mjs [--port 9090] [--host 127.0.0.1] [--known-as NAME …] [--allow ORIGIN …] [--jobs N] [--tasks N] [--pixels N]
//                       [--frames N] [--seconds N]

import { fileURLToPath } from 'node:url';
import { encode } from 'veronese/formats';
import { version } from 'veronese';
import { boxesOf, rateOf } from './boxes.mjs';
import { run } from './command-line.mjs';
import { createFetch, originOf } from './fetch-file.mjs';
import { Refusal, isObject, serveJson } from './http.mjs';
import { readConfig } from './label-config.mjs';
import { createSegment, score } from './segment.mjs';
import { createFollow } from './video.mjs';

export { readConfig };

/** Most numbers in the masks and boxes of one answer: they wait in memory until the last task is done. */
const NUMBERS = 32 * 1024 * 1024;
/** Numbers of a box in a frame, about. */
const BOX = 8;
const MODEL = `veronese-${version}`;

/**
 * Starts the server; `close()` of what it returns ends it. `studio` is where tasks with uploaded files are, for as long as the
 * server runs; `token` opens them, or else what the studio sends at set-up.
 */
export async function startBackend({
  port, host, knownAs, largest, jobs, tasks: most, pixels, frames, seconds, allow,
  studio = process.env.LABEL_STUDIO_URL,
  token: configured = process.env.LABEL_STUDIO_API_KEY,
} = {}) {
  const home = studio ? originOf(studio) : undefined;
  const fetchFile = createFetch({ home, allow });
  const { segment, perform, close } = createSegment({ jobs, tasks: most, pixels });
  const follow = createFollow({ frames, seconds, pixels });
  let token = configured;

  const routes = {
    'GET /': health,
    'GET /health': health,
    'GET /versions': () => ({ versions: [MODEL] }),
    'POST /setup': ({ hostname, access_token: sent }) => {
      if (!configured && home && isToken(sent) && URL.canParse(hostname) && new URL(hostname).origin === home) token = sent;
      return { model_version: MODEL };
    },
    'POST /webhook': () => ({ status: 'nothing to learn' }),
    'POST /predict': async ({ tasks, label_config: config }, signal) => {
      if (!Array.isArray(tasks) || !tasks.every(isObject)) throw new Refusal(400, 'invalid-input', 'tasks must be a list of objects');
      const wanted = readConfig(config);
      const predict = wanted.video === undefined ? masks : boxes;
      let numbers = 0;
      const results = await perform(tasks, async (task) => {
        const prediction = await predict(task, wanted, signal);
        for (const { value } of prediction.result) numbers += value.rle?.length ?? BOX * value.sequence.length;
        if (numbers > NUMBERS) throw new Refusal(413, 'too-large', 'the results of so many tasks are too much for one answer');
        return prediction;
      }, signal);
      return { results };
    },
  };

  /** Of two frames. */
  async function masks({ data }, { fromName, toName, labels, keys }, signal) {
    const files = await Promise.all(keys.map(async (key) => fetchFile(addressIn(data, key), { token, signal })));
    const found = await segment(files[0], files[1], { confidence: true, signal });
    // The dominant motion, usually the background, is nobody's mask; the others take the labels of the configuration in order.
    const motions = found.motions.slice(1, 1 + labels.length);
    const names = Object.fromEntries(motions.map(({ label }, index) => [label, labels[index]]));
    const metadata = { names, labels: motions.map(({ label }) => label), fromName, toName, modelVersion: MODEL };
    const [{ content }] = await encode('label-studio', found, metadata);
    return { result: JSON.parse(content)[0].predictions[0].result, score: score(found), model_version: MODEL };
  }

  /** Of a video: Label Studio has no masks there. */
  async function boxes({ data }, { video, frameRate, ...names }, signal) {
    const file = await fetchFile(addressIn(data, video), { token, signal, kind: 'video' });
    const found = await follow(file, (clip) => boxesOf(clip, rateOf(frameRate, data), { ...names, modelVersion: MODEL }), signal);
    return { ...found, model_version: MODEL };
  }

  const server = await serveJson(routes, { port, host, knownAs, largest });
  return {
    address: server.address,
    close: () => {
      server.close();
      close();
    },
  };
}

function addressIn(data, key) {
  if (typeof data?.[key] !== 'string') throw new Refusal(422, 'invalid-input', `the task has no '${key}'`);
  return data[key];
}

function health() {
  return { status: 'UP', model_class: 'Veronese' };
}

/** Whether a text is allowed in a header. */
function isToken(text) {
  return typeof text === 'string' && /^[\x21-\x7e]+$/.test(text);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  await run('ML backend', startBackend, { port: 9090, lists: ['allow'], limits: ['frames', 'seconds'] });
}
