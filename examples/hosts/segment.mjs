// The function behind the server: two image files in, labels and motions out. It holds a few pairs at a time, however many
// are asked for.

import { imageSize } from 'image-size';
import PQueue from 'p-queue';
import { SegmenterPool } from 'veronese';
import { decodeImage } from 'veronese/codecs';
import { Refusal } from './http.mjs';

/** Pairs that are worked on at once, and all that may be asked for. */
const JOBS = 2;
const TASKS = 256;
/** Most pixels of a frame: 4K in every shape. A pair takes about 60 bytes for each while it is worked on. */
export const PIXELS = 4096 * 2304;
/** A header is read in the first bytes of a file, where metadata may come before the size. */
const HEADER = 256 * 1024;

/**
 * `segment` decodes two image files and segments them in a worker thread, so that the server answers meanwhile. `perform` does
 * some work, fetching and segmenting, for each of some items: `jobs` at once, the others wait; where more than `tasks` would,
 * it refuses. `close()` ends the workers.
 */
export function createSegment({ jobs = JOBS, tasks = TASKS, pixels = PIXELS } = {}) {
  const pool = new SegmenterPool({ jobs });
  const queue = new PQueue({ concurrency: jobs });

  async function segment(firstFile, secondFile, options = {}) {
    for (const file of [firstFile, secondFile]) checkSize(size(file), pixels);
    const first = await decodeImage(firstFile);
    options.signal?.throwIfAborted();
    const second = await decodeImage(secondFile);
    // Not every header can be read without decoding.
    for (const frame of [first, second]) checkSize(frame, pixels);
    return pool.segmentPair(first, second, options);
  }

  async function perform(items, work, signal) {
    if (items.length > tasks) throw new Refusal(413, 'too-many-tasks', `a request has at most ${tasks} tasks`);
    if (items.length > tasks - queue.size - queue.pending) {
      throw new Refusal(503, 'busy', `${queue.size + queue.pending} tasks are waiting already`, { 'Retry-After': '10' });
    }
    return Promise.all(items.map((item) => queue.add(() => work(item), { signal })));
  }

  return { segment, perform, close: () => pool.close() };
}

/** Throws where a frame is larger than what is worked on. */
export function checkSize({ width, height }, pixels) {
  if (width * height <= pixels) return;
  throw new Refusal(422, 'frame-size-unsupported', `a frame of ${width}×${height} pixels is too large: this server takes ${pixels} at most`);
}

/** The size that the header states, or none where the decoder has to say. */
function size(file) {
  try {
    return imageSize(file.subarray(0, HEADER));
  } catch {
    return { width: 0, height: 0 };
  }
}

/**
 * How sure the result is as a whole, from 0 to 1: the mean probability that a pixel's label is right.
 * Needs `confidence: true` among the options.
 */
export function score({ confidence }) {
  return confidence.reduce((sum, value) => sum + value, 0) / (255 * confidence.length);
}
