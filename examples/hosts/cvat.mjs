// A function for CVAT as nuclio runs it: two frames in, masks of what moves between them out.
//
// Under nuclio `handler` is the function (see function.yaml). Elsewhere: node cvat.mjs [--port 8070] [--host 127.0.0.1] [--jobs N]

import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { encodeCoco } from 'veronese/formats';
import { Refusal, serveJson } from './http.mjs';
import { createSegment, score } from './segment.mjs';

/** Polygons beside the masks may leave the border by so many pixels: nobody wants a vertex for each. */
const TOLERANCE = 1;

let shared;

/** nuclio's handler: `event.body` as JSON, the answer by `context.callback`. */
export async function handler(context, event) {
  shared ??= createSegment();
  const respond = (status, value) =>
    context.callback(new context.Response(JSON.stringify(value), {}, 'application/json', status));
  try {
    const body = Buffer.isBuffer(event.body) ? JSON.parse(event.body.toString()) : event.body;
    respond(200, await detect(shared.segment, body));
  } catch (error) {
    const known = error instanceof Refusal || error.name === 'VeroneseError';
    respond(error.status ?? (known ? 422 : 500), { error: { code: known ? error.code : 'internal', message: error.message } });
  }
}

/**
 * CVAT's request has the base64 of one `image`; what moves can only be seen in two, so the caller adds `second`, the frame after
 * it. The answer is that of CVAT's own detectors: for each mask a polygon, and the pixels of its box followed by
 * the box's corners, both inclusive.
 */
export async function detect(segment, request) {
  const { image, second, threshold = 0 } = Object(request);
  const found = await segment(decoded('image', image), decoded('second', second), { confidence: true });
  const { labels, width, height, motions } = found;
  const confidence = score(found);
  if (confidence < Number(threshold)) return [];
  return motions.slice(1).map(({ label, bbox: [left, top, boxWidth, boxHeight] }) => {
    const mask = [];
    for (let y = top; y < top + boxHeight; y++) {
      for (let x = left; x < left + boxWidth; x++) mask.push(Number(labels[y * width + x] === label));
    }
    const coco = encodeCoco(labels, width, height, { labels: [label] }, { shape: 'polygon', tolerance: TOLERANCE });
    const points = largest(coco.annotations[0].segmentation);
    mask.push(left, top, left + boxWidth - 1, top + boxHeight - 1);
    return { confidence: String(confidence), label: `motion-${label}`, type: 'mask', points, mask };
  });
}

function decoded(name, text) {
  if (typeof text !== 'string' || text === '') throw new Refusal(422, 'invalid-input', `'${name}' must be an image file as base64`);
  return new Uint8Array(Buffer.from(text, 'base64'));
}

function largest(rings) {
  return rings.reduce((most, ring) => (ring.length > most.length ? ring : most), []);
}

/** The same over plain HTTP, as nuclio puts it on the network. */
export async function startFunction({ port, host, jobs } = {}) {
  const { segment, close } = createSegment({ jobs });
  const server = await serveJson({ 'POST /': (body) => detect(segment, body), 'GET /health': () => ({ status: 'UP' }) }, { port, host });
  return {
    address: `http://${server.address().address}:${server.address().port}`,
    close: () => {
      server.close();
      server.closeAllConnections();
      close();
    },
  };
}

/** Ends the workers that `handler` started. */
export function end() {
  shared?.close();
  shared = undefined;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const text = { type: 'string' };
  const { values } = parseArgs({ options: { port: { ...text, default: '8070' }, host: text, jobs: text } });
  const jobs = values.jobs === undefined ? undefined : Number(values.jobs);
  startFunction({ port: Number(values.port), host: values.host, jobs }).then((server) => {
    console.log(`CVAT function at ${server.address}`);
    for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, () => server.close());
  });
}
