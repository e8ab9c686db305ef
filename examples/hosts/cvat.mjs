// A function for CVAT as nuclio runs it: two frames in, masks of what moves between them out.
//
// Under nuclio `handler` is the function (see function.yaml). Elsewhere:
// node cvat.mjs [--port 8070] [--host 127.0.0.1] [--known-as NAME …] [--jobs N] [--tasks N] [--pixels N]

import { fileURLToPath } from 'node:url';
import { encodeCoco } from 'veronese/formats';
import { run } from './command-line.mjs';
import { Refusal, isObject, parse, refusal, serveJson } from './http.mjs';
import { createSegment, score } from './segment.mjs';

/** Largest request, bytes: two frames of 4K as base64 of PNG. */
const LARGEST = 64 * 1024 * 1024;

/** Polygons beside the masks may leave the border by so many pixels: nobody wants a vertex for each. */
const TOLERANCE = 1;

let shared;

/** nuclio's handler: `event.body` as JSON, the answer by `context.callback`. */
export async function handler(context, event) {
  shared ??= createDetect();
  const respond = (status, value, headers = {}) =>
    context.callback(new context.Response(JSON.stringify(value), headers, 'application/json', status));
  try {
    const parsed = isObject(event.body) && !Buffer.isBuffer(event.body);
    respond(200, await shared.detect(parsed ? event.body : parse(event.body)));
  } catch (error) {
    const { status, code, message, headers } = refusal(error);
    respond(status, { error: { code, message } }, headers);
  }
}

/** `detect` for a few requests at a time. */
function createDetect(options) {
  const { segment, perform, close } = createSegment(options);
  const one = async (request, signal) => {
    const [found] = await perform([request], () => detect((...files) => segment(...files, { confidence: true, signal }), request), signal);
    return found;
  };
  return { detect: one, close };
}

/**
 * CVAT's request has the base64 of one `image`; what moves can only be seen in two, so the caller adds `second`, the frame after
 * it. The answer is that of CVAT's own detectors: for each mask a polygon, and the pixels of its box followed by
 * the box's corners, both inclusive.
 */
export async function detect(segment, request) {
  const { image, second, threshold = 0 } = Object(request);
  if (!(Number(threshold) >= 0)) throw new Refusal(422, 'invalid-input', "'threshold' must be a number from 0 to 1");
  const found = await segment(decoded('image', image), decoded('second', second));
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
export async function startFunction({ port, host, knownAs, largest = LARGEST, ...limits } = {}) {
  const { detect: found, close } = createDetect(limits);
  const server = await serveJson({ 'POST /': found, 'GET /health': () => ({ status: 'UP' }) }, { port, host, knownAs, largest });
  return {
    address: server.address,
    close: () => {
      server.close();
      close();
    },
  };
}

/** Ends the workers that `handler` started. */
export function end() {
  shared?.close();
  shared = undefined;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await run('CVAT function', startFunction, { port: 8070 });
