// Golden hashes, in the module that is shipped: tests/golden.json has the calls, and the bits of their answers. tests/golden.rs asks
// the crate for the same natively.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fitMotions, openClip, segmentPair, segmentStream } from 'veronese';
import { decodeImage } from 'veronese/codecs';

const root = new URL('../../', import.meta.url);
const golden = JSON.parse(readFileSync(new URL('tests/golden.json', root), 'utf8'));

/** FNV-1a, 64 bits: the prime is 2⁴⁰ + 435, the two halves are multiplied one by one. */
class Hash {
  #high = 0xcbf29ce4;
  #low = 0x84222325;

  bytes(bytes) {
    for (const byte of bytes) {
      const low = ((this.#low ^ byte) >>> 0) * 435;
      this.#high = (this.#high * 435 + Math.floor(low / 2 ** 32) + ((this.#low ^ byte) << 8 >>> 0)) % 2 ** 32;
      this.#low = low >>> 0;
    }
  }

  /** All numbers, entries in the order of their names. */
  numbers(answer) {
    if (typeof answer === 'number') this.bytes(new Uint8Array(Float64Array.of(answer).buffer));
    else if (Array.isArray(answer)) answer.forEach((value) => this.numbers(value));
    else if (answer !== null && typeof answer === 'object') for (const name of Object.keys(answer).sort()) this.numbers(answer[name]);
  }

  toString() {
    return [this.#high, this.#low].map((half) => half.toString(16).padStart(8, '0')).join('');
  }
}

const decoded = new Map();
const framesOf = (name) => Promise.all(golden.frames[name].map((file) => {
  if (!decoded.has(file)) decoded.set(file, decodeImage(readFileSync(new URL(file, root))));
  return decoded.get(file);
}));

/** Measurements spread by remainders. The crate's test computes them in the same order, so that both have the same bits. */
function measurementsOf({ count, noise, motions }) {
  const spread = (j, factor, modulus) => ((j * factor) % modulus) / Math.floor(modulus / 2) - 1;
  const [positions, derivatives] = [new Float64Array(2 * count), new Float64Array(3 * count)];
  for (let j = 0; j < count; j++) {
    const [x, y] = [spread(j, 37, 101), spread(j, 53, 97)];
    const [ix, iy] = [spread(j, 29, 83), spread(j, 71, 89)];
    const m = motions[j % motions.length];
    const [u, v] = [m[0] * x + m[1] * y + m[2], m[3] * x + m[4] * y + m[5]];
    positions.set([x, y], 2 * j);
    derivatives.set([ix, iy, noise * spread(j, 67, 79) - (ix * u + iy * v)], 3 * j);
  }
  return { positions, derivatives };
}

/** A label at the pixels of a box, 255 elsewhere. */
function filled({ width, height }, [left, top, across, down], label) {
  return Uint8Array.from({ length: width * height }, (_, p) => {
    const [x, y] = [p % width, Math.floor(p / width)];
    return x >= left && x < left + across && y >= top && y < top + down ? label : 255;
  });
}

/** The bytes of an answer, and the rest of it, without what the package adds about the call itself. */
function answered({ labels, confidence, version, milliseconds, settings, ...rest }) {
  return { bytes: [labels, ...(confidence ? [confidence] : [])], rest };
}

const CALLS = {
  segmentPair: async ({ of, options }) => answered(await segmentPair(...(await framesOf(of)), options)),
  segmentClip: async ({ of, options: { lookAhead, markUnknown, ...options }, corrections = [] }) => {
    const frames = await framesOf(of);
    const isStream = lookAhead !== 'all' && corrections.length === 0;
    const clip = isStream ? undefined : await openClip(frames, { markUnknown });
    await clip?.segment(options);
    const annotations = corrections.map(({ frame, box, label }) => ({ frame, labels: filled(frames[0], box, label) }));
    if (annotations.length > 0) await clip.annotate(...annotations);
    const done = [];
    const labelled = clip ? frames.map((_, index) => clip.labels(index)) : segmentStream(frames, { lookAhead, markUnknown, ...options });
    // The size is the package's own.
    for await (const { width, height, ...frame } of labelled) done.push(answered(frame));
    return { bytes: done.flatMap(({ bytes }) => bytes), rest: done.map(({ rest }) => rest) };
  },
  fitMotions: async ({ of, options }) => answered(await fitMotions(measurementsOf(golden.measurements[of]), options)),
};

for (const asked of golden.answers) {
  const { call, of, options, hash } = asked;
  test(`${call} of ${of}, ${JSON.stringify(options)}: the same bits`, async () => {
    const { bytes, rest } = await CALLS[call](asked);
    const found = new Hash();
    bytes.forEach((one) => found.bytes(one));
    found.numbers(rest);
    assert.equal(String(found), hash);
  });
}
