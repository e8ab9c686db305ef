import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { relabel, segmentPair } from 'veronese';
import { frame, pair } from './support/frames.mjs';
import { failure } from './support/shapes.mjs';

const SIZE = { width: 96, height: 72, square: [3, 1] };
const frames = pair(SIZE);

/** One set of labels per pixel: `set` within `radius` of (x, y). */
function disc({ width, height }, x, y, radius, set) {
  const evidence = new Uint16Array(width * height);
  for (let p = 0; p < evidence.length; p++) {
    if (Math.hypot((p % width) - x, Math.floor(p / width) - y) <= radius) evidence[p] = set;
  }
  return evidence;
}

describe('relabel', () => {
  test('changes nothing where nothing is said', async () => {
    const found = await segmentPair(...frames);
    const again = await relabel(...frames, found, new Uint16Array(found.labels.length));
    assert.deepEqual({ ...again, milliseconds: null }, { ...found, milliseconds: null });
  });

  test('obeys a stroke, keeps what is far from it, and leaves its input alone', async () => {
    const found = await segmentPair(...frames);
    assert.equal(found.count, 2);
    const before = Uint8Array.from(found.labels);
    const [x, y, w, h] = found.motions[1].bbox;
    const evidence = disc(found, x + w / 2, y + h / 2, 4, 0b01);
    const corrected = await relabel(...frames, found, evidence);
    evidence.forEach((set, p) => set === 0 || assert.equal(corrected.labels[p], 0));
    assert.deepEqual(found.labels, before);
    assert.equal(corrected.motions[1].pixels, corrected.labels.filter((label) => label === 1).length);
    assert.deepEqual(corrected.motions[1].matrix, found.motions[1].matrix);
    assert.ok(corrected.milliseconds.labels >= 0);
  });

  test('gives an object back from one stroke', async () => {
    const found = await segmentPair(...frames);
    const lost = { ...found, labels: new Uint8Array(found.labels.length) };
    const [x, y, w, h] = found.motions[1].bbox;
    const mended = await relabel(...frames, lost, disc(found, x + w / 2, y + h / 2, 3, 0b10));
    const both = mended.labels.filter((label, p) => label === 1 && found.labels[p] === 1).length;
    assert.ok(both > 0.8 * found.motions[1].pixels, `${both} of ${found.motions[1].pixels}`);
  });

  test('refuses what does not belong together', async () => {
    const found = await segmentPair(...frames);
    const evidence = new Uint16Array(found.labels.length);
    const cases = [
      ['invalid-option', () => relabel(...frames, found, evidence.subarray(1))],
      ['invalid-option', () => relabel(...frames, found, evidence.map(() => 0b100))],
      ['invalid-option', () => relabel(...frames, { ...found, labels: found.labels.map(() => 7) }, evidence)],
      ['invalid-option', () => relabel(...frames, found, evidence, { nonsense: 1 })],
      ['invalid-input', () => relabel(...frames, found, new Uint8Array(found.labels.length))],
      ['invalid-input', () => relabel(...frames, {}, evidence)],
      ['frame-size-mismatch', () => relabel(frames[0], frame(1), found, evidence)],
    ];
    for (const [code, call] of cases) assert.equal((await failure(call())).code, code);
  });
});
