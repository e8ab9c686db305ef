// Checks of the long soak after each batch: the same answer to the same question, and no more memory than in the beginning.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';

const MIB = 2 ** 20;
/** Until then, memory may grow: modules are compiled, and heaps find their size. */
const SETTLING = 8;
/** From then on it may, for the collector decides when it collects. */
const LEEWAY = { share: 0.25, bytes: 64 * MIB };

/** A hash of the labels and motions of a pair. */
export function hashOf({ labels, motions }) {
  return createHash('sha256').update(labels).update(JSON.stringify(motions)).digest('hex');
}

/** Takes the memory after each batch; throws once it has grown after it had settled. */
export function flatMemory() {
  const seen = [];
  return (bytes) => {
    seen.push(bytes);
    const settled = Math.max(...seen.slice(0, SETTLING));
    const most = settled * (1 + LEEWAY.share) + LEEWAY.bytes;
    assert.ok(bytes <= most, `memory has grown from ${inMiB(settled)} to ${inMiB(bytes)} MiB in ${seen.length} batches`);
    return `${inMiB(bytes)} MiB`;
  };
}

const inMiB = (bytes) => Math.round(bytes / MIB);

/** Throws unless an answer is the reference. The first one ever becomes it. */
export function sameAsBefore(references, name, hash) {
  references[name] ??= hash;
  assert.equal(hash, references[name], `the reference result of ${name} is another one`);
}
