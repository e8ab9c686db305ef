// The module of the site, as a page calls it. What it computes is tested in the crate; here are shapes, order, errors, and that nothing is lost.

import assert from 'node:assert/strict';
import test from 'node:test';

import { load } from '../client/module.mjs';

const module = await load();
const flat = (rows) => Float64Array.from(rows.flat());
const near = (found, expected, tolerance) => assert.ok(Math.abs(found - expected) <= tolerance, `${found} is not ${expected}`);
const has = (list, wanted, tolerance) => list.some((one) => wanted.every((value, k) => Math.abs(one[k] - value) <= tolerance));

const MOTIONS = [
  [0.3, -0.2, 0.5, 0.1, 0.4, -0.3],
  [-0.4, 0.3, -0.4, 0.2, -0.1, 0.6],
];

/** A textured frame with a square that has moved by some pixels. */
function frame(moved, width = 96, height = 72) {
  const texture = (x, y, seed) => ((x * x + 3 * y * y + x * y * seed) % 97) + 60;
  const data = new Uint8ClampedArray(4 * width * height).fill(255);
  for (let p = 0; p < width * height; p += 1) {
    const [x, y] = [p % width, Math.floor(p / width)];
    const [a, b] = [x - 20 - moved, y - 15];
    const inside = a >= 0 && a < 30 && b >= 0 && b < 30;
    data.fill(inside ? texture(a >> 2, b >> 2, 7) : texture(x >> 2, y >> 2, 2), 4 * p, 4 * p + 3);
  }
  return { data, width, height };
}

test('the map of points on two lines has two lines', () => {
  const map = module.veroneseMap(flat([[1, 1], [-2, -2], [2, -1], [-1, 0.5], [0.5, 0.5]]), 2, 2);
  assert.deepEqual(map.exponents, [[2, 0], [1, 1], [0, 2]]);
  assert.ok(map.matrix instanceof Float64Array);
  assert.deepEqual([map.rows, map.columns, map.rank, map.complex], [5, 3, 2, 0]);
  assert.deepEqual([...map.matrix.subarray(6, 9)], [4, -2, 1]);
  assert.equal(map.singularValues.length, 3);
  const normals = map.lines.map(([a, b]) => a / b).sort((p, q) => p - q);
  near(normals[0], -1, 1e-9);
  near(normals[1], 0.5, 1e-9);
  const [p, q, r] = map.nullVector;
  near(p + q + r, 0, 1e-12);
  assert.equal(module.veroneseMap(Float64Array.of(2, 3, 5), 3, 2).lines, undefined);
});

test('translations come from one polynomial in the derivatives', () => {
  const flows = [[1, 0.5], [-0.5, -1]];
  const gradients = [[1, 0.3], [-0.4, 1], [0.8, -0.7], [0.2, 1.1], [1.3, 0.6], [-1, 0.9]];
  const found = module.multibodyFlow(flat(flows.flatMap(([u, v]) => gradients.map(([x, y]) => [x, y, -x * u - y * v]))), 2);
  assert.equal(found.coefficients.length, 6);
  assert.equal(found.coefficients[5], 1);
  assert.ok(found.singularValues[5] < 1e-12);
  for (const flow of flows) assert.ok(has(found.factors, flow, 1e-9) && has(found.byDifferentiation, flow, 1e-9));
});

test('derivatives are planes in grey levels', () => {
  const planes = module.derivativesOf(frame(0), frame(1));
  assert.deepEqual([planes.width, planes.height], [96, 72]);
  for (const name of ['horizontal', 'vertical', 'temporal']) {
    assert.ok(planes[name] instanceof Float32Array);
    assert.equal(planes[name].length, 96 * 72);
    assert.ok(planes[name].some((value) => Math.abs(value) > 1));
  }
  assert.equal(planes.temporal[70 * 96 + 90], 0);
});

test('measurements of given motions are solved by each route', () => {
  const { positions, derivatives, labels } = module.motionMeasurements(flat(MOTIONS), Float64Array.of(2, 1), 600, 0, 3);
  assert.deepEqual([positions.length, derivatives.length, labels.length], [1200, 1800, 600]);
  assert.equal(labels.filter((label) => label === 0).length, 400);
  const found = module.paperStages(positions, derivatives, 2);
  assert.equal(found.ambiguous, false);
  for (const motion of MOTIONS) {
    for (const route of ['factorisation', 'differentiation', 'refined']) assert.ok(has(found[route], motion, 1e-5), route);
  }
  assert.deepEqual(found.embedded, { rows: 600, columns: 25 });
  assert.equal(found.multibody.matrix.length, 36);
  assert.equal(found.multibody.matrix[35], 1);
  // Row 3 of every motion is (0, 0, 1): the entry of I_t² and x² is a structural zero.
  assert.equal(found.multibody.matrix[30], 0);
  assert.deepEqual([found.ruleFired, found.ranks], [null, []]);
  assert.equal(found.labels.length, 600);
  assert.equal(found.thirdColumns.length, 2);

  const rule = module.paperStages(positions, derivatives);
  assert.deepEqual([rule.count, rule.ruleFired], [2, true]);
  assert.deepEqual(rule.ranks.map(({ motions, rank, wanted }) => [motions, rank > wanted]), [[1, true], [2, false]]);

  const [one, two] = module.embeddedSpectra(positions, derivatives, 2);
  assert.deepEqual([one.motions, one.rank, one.singularValues.length], [1, 7, 7]);
  assert.deepEqual([two.motions, two.rank, two.singularValues.length], [2, 24, 25]);

  const pixel = module.motionsAtPixel(positions, derivatives, 2, 0.5, 0.4, 0.9);
  assert.deepEqual([pixel.coefficients.length, pixel.coefficients[2], pixel.roots.length], [3, 1, 2]);
  for (const motion of MOTIONS) assert.ok(has(pixel.motions, motion, 1e-7));

  const ours = module.fitMotions(positions, derivatives, { motions: 2 });
  for (const motion of MOTIONS) assert.ok(has(ours.motions.map(({ matrix }) => matrix), motion, 1e-5));
});

test('a trial of Figure 1 says how far each method is', () => {
  const trial = module.figure1Trial(2, 0.05, 1);
  assert.equal(trial.truth.length, 2);
  assert.deepEqual(Object.keys(trial.errors), ['factorisation', 'refined', 'best', 'oracle']);
  assert.ok(trial.errors.oracle > 0.01 && trial.errors.oracle < trial.errors.factorisation, JSON.stringify(trial.errors));
  assert.equal(typeof trial.countRight.rule, 'boolean');
  assert.deepEqual(module.figure1Trial(2, 0.05, 1), trial);
});

test('the stages of a pair end in what segmentPair gives', () => {
  const [first, second] = [frame(0), frame(3)];
  for (const options of [undefined, { quality: 'fast', motions: 2, confidence: true }]) {
    const stages = module.segmentPairStages(first, second, options);
    assert.deepEqual(stages.result, module.segmentPair(first, second, options));
    assert.equal(stages.result.count, 2);
    const taken = stages.hypotheses[stages.chosen];
    const pixels = taken.base.width * taken.base.height;
    const planes = [taken.residual, ...Object.values(taken.derivatives), ...Object.values(taken.localFlow)];
    for (const plane of planes) assert.equal(plane.length, pixels);
    assert.ok(taken.candidates.some(({ source }) => source === 'window'));
    assert.ok(taken.candidates.every(({ source, degree }) => (source === 'constraint') === degree > 0));
    assert.deepEqual(taken.selected[0].matrix, taken.dominant);
    assert.equal(taken.draft.labels.length, taken.draft.width * taken.draft.height);
    for (const [motions, { labels, width, height }] of [[taken.selected, taken.selection], [taken.refined, taken.refinement]]) {
      assert.equal(labels.length, width * height);
      assert.ok(labels.every((label) => label < motions.length));
    }
    assert.equal(stages.working.labels.length, 96 * 72);
    assert.equal(stages.detail, null);
    assert.deepEqual(stages.groups.flat().sort(), [0, 1]);
    if (taken.measurements) assert.equal(taken.measurements.derivatives.length, 3 * taken.measurements.weights.length);
  }
});

test('what cannot be computed is an error with a code', () => {
  const code = (call) => {
    try {
      call();
    } catch (error) {
      assert.equal(error.name, 'VeroneseError');
      return error.code;
    }
    return undefined;
  };
  const two = Float64Array.of(1, 2);
  assert.equal(code(() => module.veroneseMap(two, 4, 2)), 'invalid-option');
  assert.equal(code(() => module.veroneseMap(two, 2, 1.5)), 'invalid-option');
  assert.equal(code(() => module.veroneseMap(two, 2, '2')), 'invalid-option');
  assert.equal(code(() => module.veroneseMap(Float64Array.of(1, NaN), 2, 2)), 'not-finite');
  assert.equal(code(() => module.multibodyFlow(two, 2)), 'invalid-input');
  assert.equal(code(() => module.multibodyFlow(Float64Array.of(1, 2, 3), 2)), 'too-few-measurements');
  assert.equal(code(() => module.derivativesOf(frame(0), frame(0, 64, 48))), 'frame-size-mismatch');
  assert.equal(code(() => module.derivativesOf(frame(0), {})), 'invalid-input');
  assert.equal(code(() => module.paperStages(two, Float64Array.of(1, 2, 3))), 'too-few-measurements');
  assert.equal(code(() => module.paperStages(two, Float64Array.of(1, 2, 3), 11)), 'invalid-option');
  assert.equal(code(() => module.motionsAtPixel(two, Float64Array.of(1, 2, 3), 1, 0, 0, 0)), 'too-few-measurements');
  assert.equal(code(() => module.embeddedSpectra(two, Float64Array.of(1, 2, 3), 7)), 'invalid-option');
  assert.equal(code(() => module.figure1Trial(5, 0, 1)), 'invalid-option');
  assert.equal(code(() => module.figure1Trial(2, NaN, 1)), 'invalid-option');
  assert.equal(code(() => module.figure1Trial(2, 0, -1)), 'invalid-option');
  assert.equal(code(() => module.motionMeasurements(flat(MOTIONS), Float64Array.of(1), 10, 0, 1)), 'invalid-option');
  assert.equal(code(() => module.motionMeasurements(two, two, 10, 0, 1)), 'invalid-input');
  assert.equal(code(() => module.segmentPairStages(frame(0), frame(1), { motion: 2 })), 'invalid-option');
});
