// A clip as a stream. A stream cannot be resumed: where the time is up it ends, and the next run begins another one.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { segmentClip } from '../../../pkg/dist/node.js';
import { flatMemory, sameAsBefore } from './checks.mjs';
import { OPTIONS, SIZE, frameAt } from './frames.mjs';

/** Frames after which memory is looked at. */
const BATCH = 50;
/** Frames of the clip that is asked for after each batch. */
const SHORT = 4;

/** Yields how many frames are done after each batch. */
export async function* clip({ from, total, references }) {
  const memory = flatMemory();
  async function* frames() {
    for (let k = from; k < total; k += 1) yield frameAt(k - from);
  }
  let done = from;
  for await (const { index, labels, objects } of segmentClip(frames(), { ...OPTIONS, lookAhead: 2 })) {
    assert.equal(index, done - from, 'frames come in order');
    assert.equal(labels.length, SIZE.width * SIZE.height);
    assert.ok(objects.length < 20, `${objects.length} objects are in frame ${index}, where one square moves`);
    done += 1;
    if (done % BATCH !== 0 && done !== total) continue;
    sameAsBefore(references, 'clip', await short());
    yield { done, note: memory(process.memoryUsage().rss) };
  }
  assert.equal(done, total, 'every frame is answered');
}

/** A hash of the labels of a short clip. */
async function short() {
  const hash = createHash('sha256');
  for await (const { labels } of segmentClip(Array.from({ length: SHORT }, (_, k) => frameAt(k)), OPTIONS)) hash.update(labels);
  return hash.digest('hex');
}
