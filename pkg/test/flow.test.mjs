// The flow field of labels and motions, written by `convert` of a pair, and read back by the layouts of the two formats.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { decode } from 'fast-png';
import { encode } from 'veronese/formats';
import { pair, png } from './support/frames.mjs';
import { converted, temporaryFolder, veronese } from './support/program.mjs';

/** As Middlebury describes it: the tag, width, height, then u and v of each pixel; a value above 1e9 is unknown. */
function flo(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  assert.equal(view.getFloat32(0, true), 202021.25);
  const [width, height] = [view.getInt32(4, true), view.getInt32(8, true)];
  assert.equal(bytes.length, 12 + 8 * width * height);
  return { width, height, flow: Array.from({ length: 2 * width * height }, (_, k) => view.getFloat32(12 + 4 * k, true)).map((value) => (Math.abs(value) > 1e9 ? NaN : value)) };
}

/** As NumPy describes it. */
function npy(bytes) {
  assert.equal(bytes.toString('latin1', 0, 8), '\x93NUMPY\x01\x00');
  const begin = 10 + bytes.readUInt16LE(8);
  assert.equal(begin % 64, 0);
  const [, height, width] = /^\{'descr': '<f4', 'fortran_order': False, 'shape': \((\d+), (\d+), 2\), \} *\n$/.exec(bytes.toString('latin1', 10, begin)).map(Number);
  return { width, height, flow: Array.from({ length: (bytes.length - begin) / 4 }, (_, k) => bytes.readFloatLE(begin + 4 * k)) };
}

/** The flow by the definition of a motion's matrix. */
function flowOf({ data, width, height }, motions) {
  const matrices = new Map(motions.map(({ label, matrix }) => [label, matrix]));
  const flow = Array.from(data).flatMap((label, p) => {
    const [a11, a12, a13, a21, a22, a23] = matrices.get(label) ?? Array(6).fill(NaN);
    const [x, y] = [p % width, Math.floor(p / width)];
    return [a11 * x + a12 * y + a13, a21 * x + a22 * y + a23].map(Math.fround);
  });
  return { width, height, flow };
}

const labelsIn = (...path) => decode(readFileSync(join(...path)));

test('of a pair: every pixel moves as its motion says, and none that is unlabelled', async (t) => {
  const { path, file } = temporaryFolder(t);
  const [first, second] = pair({ width: 40, height: 30, background: [0.5, 0] }).map((pixels, k) => file(`${k}.png`, png(pixels)));
  const { code, stderr } = await veronese(['pair', first, second, '--mark-unknown', '--out', path('out')]);
  assert.equal(code, 0, stderr);
  const { files } = await converted(path('out'), '--to', 'flo,npy');
  assert.deepEqual(files, ['flow.flo', 'flow.npy']);
  const { motions, unlabelled } = JSON.parse(readFileSync(path('out', 'result.json')));
  const expected = flowOf(labelsIn(path('out'), 'labels.png'), motions);
  assert.ok(unlabelled > 0 && expected.flow.filter(Number.isNaN).length === 2 * unlabelled);
  assert.deepEqual(flo(readFileSync(path('out', 'flow.flo'))), expected);
  assert.deepEqual(npy(readFileSync(path('out', 'flow.npy'))), expected);
});

test('the call has the same two layouts', async () => {
  const motions = [{ label: 0, matrix: [0, 0, 3, 0, 0, -1] }, { label: 1, matrix: [1, 0, 0.5, 0, 2, 0] }];
  const expected = { width: 2, height: 2, flow: [3, -1, 1.5, 0, NaN, NaN, NaN, NaN] };
  for (const [format, read] of Object.entries({ flo, npy })) {
    const [{ content }] = await encode(format, { labels: Uint8Array.of(0, 1, 7, 255), width: 2, height: 2, motions });
    assert.deepEqual(read(Buffer.from(content)), expected);
  }
});
