// The memory of the module. It never shrinks, so its size is the most that was ever in use at once.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { glue } from '../build/module/glue.js';
import { glue as pointsGlue } from '../build/module/glue-points.js';
import { frame, pair, points } from './support/frames.mjs';
import { soaking } from './support/soak.mjs';

const MIB = 2 ** 20;
const moduleOf = (file) => new WebAssembly.Module(readFileSync(new URL(`../wasm/${file}_bg.wasm`, import.meta.url)));
const [module, pointsModule] = ['veronese', 'points/veronese_points'].map(moduleOf);

/** The size of a fresh instance's memory in MiB, whenever it is asked. */
async function freshMemory(of = glue, from = module) {
  of.forgetInstance();
  const { memory } = await of.instantiate(from);
  return () => memory.buffer.byteLength / MIB;
}

function segment([first, second], options) {
  return glue.segmentPair(first, second, options, () => {});
}

describe('after some calls, further ones take no more memory', () => {
  /** Does all rounds of calls; after the first ones the memory has its size. */
  async function staysAfter(first, rounds, round, ...of) {
    const size = await freshMemory(...of);
    for (let k = 0; k < first; k++) round();
    const settled = size();
    for (let k = 0; k < rounds; k++) round();
    assert.equal(size(), settled);
  }
  const [small, larger] = [pair(), pair({ width: 160, height: 120 })];

  // The allocator needs some calls of different needs in turn until its free pieces fit all of them.
  test('with everything that can be asked for', () => staysAfter(24, soaking ? 48 : 24, () => segment(small, { quality: 'best', confidence: true, markUnknown: true })));

  test('calls that are refused', () => staysAfter(24, soaking ? 48 : 24, () => {
    assert.throws(() => segment(larger, { quality: 'good' }), { code: 'invalid-option' });
    assert.throws(() => segment([larger[0], small[0]], {}), { code: 'frame-size-mismatch' });
  }));

  test('many pairs of different sizes and motions', async () => {
    const sizes = [[64, 48], [160, 120], [96, 128], [200, 150]];
    const pairs = Array.from({ length: soaking ? 20 : 8 }, (_, k) => {
      const [width, height] = sizes[k % sizes.length];
      return pair({ width, height, background: [k % 3, (k % 5) / 4], square: [2 - (k % 7), 1 + (k % 4)] });
    });
    await staysAfter(3, soaking ? 97 : 3, () => pairs.forEach((of, k) => segment(of, { quality: k % 3 === 0 ? 'best' : 'fast', confidence: k % 2 === 0 })));
  });

  test('measurements', () => {
    const { positions, derivatives } = points(320, 1, 0.5);
    return staysAfter(4, 24, () => pointsGlue.fitMotions(positions, derivatives, {}, () => {}), pointsGlue, pointsModule);
  });
});

describe('the most that is in use', () => {
  for (const quality of ['fast', 'best']) {
    test(`${quality}, 640 × 480: at most 24 MiB`, async () => {
      const size = await freshMemory();
      segment(pair({ width: 640, height: 480 }), { quality });
      assert.ok(size() <= 24, `${size()} MiB`);
    });
  }

  test('the largest frames there may be, with all that takes memory: at most 1 GiB', { skip: !soaking && 'npm run soak -- package' }, async () => {
    const size = await freshMemory();
    const [first, second] = [0, 1].map((t) => tiled(frame(t, { width: 512, height: 512 }), 8));
    const result = segment([first, second], { quality: 'best', confidence: true, markUnknown: true });
    assert.equal(result.labels.length, 4096 * 4096);
    assert.ok(size() <= 1024, `${size()} MiB`);
    const error = { code: 'frame-size-unsupported', message: /4097×4096.*between \d+ and 4096/ };
    const tooWide = { data: new Uint8Array(4 * 4097 * 4096), width: 4097, height: 4096 };
    assert.throws(() => segment([tooWide, tooWide], {}), error);
  });
});

/** The frame `times` times beside and below itself. */
function tiled({ data, width, height }, times) {
  const row = 4 * width;
  const band = new Uint8Array(times * data.length);
  for (let y = 0; y < height; y++) {
    for (let k = 0; k < times; k++) band.set(data.subarray(y * row, (y + 1) * row), (y * times + k) * row);
  }
  const all = new Uint8Array(times * band.length);
  for (let k = 0; k < times; k++) all.set(band, k * band.length);
  return { data: all, width: times * width, height: times * height };
}
