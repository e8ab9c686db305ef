// The contract of results, field by field.

import assert from 'node:assert/strict';

const finite = (value, name) => assert.ok(typeof value === 'number' && Number.isFinite(value), `${name} is ${value}`);
const whole = (value, name) => assert.ok(Number.isInteger(value) && value >= 0, `${name} is ${value}`);

export function checkMatrix(matrix) {
  assert.ok(Array.isArray(matrix));
  assert.equal(matrix.length, 6);
  for (const entry of matrix) finite(entry, 'a matrix entry');
}

function checkMilliseconds(milliseconds) {
  for (const [stage, value] of Object.entries(milliseconds)) {
    finite(value, stage);
    assert.ok(value >= 0, stage);
    assert.match(stage, /^[a-z][a-zA-Z0-9]*$/);
  }
  finite(milliseconds.total, 'total');
}

function checkCandidates(candidates) {
  assert.ok(Array.isArray(candidates));
  for (const { motions, score } of candidates) {
    assert.ok(Number.isInteger(motions) && motions >= 1 && motions <= 10);
    finite(score, 'score');
  }
}

function checkJunctions({ junctions, count, width, height }) {
  assert.ok(Array.isArray(junctions));
  let last = -1;
  for (const { labels, likelihood, border, ...others } of junctions) {
    assert.deepEqual(others, {});
    const [one, other] = labels;
    assert.equal(labels.length, 2);
    whole(one, 'a label of a junction');
    assert.ok(one < other && other < count, 'labels of a junction');
    assert.ok(one * count + other > last, 'junctions by labels');
    last = one * count + other;
    finite(likelihood, 'a likelihood');
    assert.ok(likelihood >= 0 && likelihood <= 1);
    whole(border, 'a border');
    assert.ok(border > 0 && border < 2 * width * height);
  }
}

/** The JSON of a pair, without labels. */
export function checkPair(result, width, height) {
  assert.equal(result.version, 1);
  assert.equal(result.width, width);
  assert.equal(result.height, height);
  assert.equal(result.count, result.motions.length);
  assert.ok(result.count >= 1 && result.count <= 10);
  let pixels = result.unlabelled;
  whole(result.unlabelled, 'unlabelled');
  result.motions.forEach((motion, index) => {
    assert.equal(motion.label, index);
    checkMatrix(motion.matrix);
    whole(motion.pixels, 'pixels');
    pixels += motion.pixels;
    assert.ok(Math.abs(motion.share - motion.pixels / (width * height)) < 1e-12);
    finite(motion.residual, 'residual');
    assert.ok(motion.residual >= 0 && motion.residual <= 255);
    assert.equal(motion.bbox.length, 4);
    for (const side of motion.bbox) whole(side, 'bbox');
    const [x, y, w, h] = motion.bbox;
    assert.ok(x + w <= width && y + h <= height);
    whole(motion.group, 'group');
    assert.ok(motion.group <= index, 'groups are numbered in the order of labels');
    if (index > 0) assert.ok(motion.pixels <= result.motions[index - 1].pixels, 'labels by decreasing size');
  });
  assert.equal(pixels, width * height);
  checkJunctions(result);
  checkCandidates(result.evidence.candidates);
  checkMilliseconds(result.milliseconds);
  assert.match(result.settings.software, /^veronese \d+\.\d+\.\d+/);
}

/** Labels agree with the JSON. */
export function checkLabels(labels, result) {
  assert.equal(labels.length, result.width * result.height);
  const counts = new Map();
  for (const label of labels) counts.set(label, (counts.get(label) ?? 0) + 1);
  assert.equal(counts.get(255) ?? 0, result.unlabelled);
  for (const { label, pixels, bbox } of result.motions) {
    assert.equal(counts.get(label) ?? 0, pixels);
    assert.deepEqual(bbox, boundingBox(labels, result.width, label));
    counts.delete(label);
  }
  counts.delete(255);
  assert.equal(counts.size, 0, 'a label without a motion');
}

function boundingBox(labels, width, wanted) {
  let [left, top, right, bottom] = [Infinity, Infinity, -1, -1];
  labels.forEach((label, index) => {
    if (label !== wanted) return;
    const [x, y] = [index % width, Math.floor(index / width)];
    [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x), Math.max(bottom, y)];
  });
  return right < 0 ? [0, 0, 0, 0] : [left, top, right - left + 1, bottom - top + 1];
}

/** The JSON of points; `labels` as an array or a Uint8Array. */
export function checkPoints(result, count) {
  assert.equal(result.version, 1);
  assert.equal(result.count, result.motions.length);
  assert.equal(result.labels.length, count);
  const counts = new Map();
  for (const label of result.labels) counts.set(label, (counts.get(label) ?? 0) + 1);
  result.motions.forEach(({ label, matrix, measurements }, index) => {
    assert.equal(label, index);
    checkMatrix(matrix);
    assert.equal(measurements, counts.get(label) ?? 0);
  });
  for (const value of result.evidence.singularValues) finite(value, 'a singular value');
  checkCandidates(result.evidence.candidates);
  for (const matrix of [...(result.stages?.factorisation ?? []), ...(result.stages?.refined ?? [])]) checkMatrix(matrix);
  checkMilliseconds(result.milliseconds);
}

/** A result without what differs between two runs. */
export function timeless({ milliseconds, ...rest }) {
  return { ...rest, stages: { ...rest.stages }, timed: Object.keys(milliseconds) };
}

/** The error that a call rejects with. */
export async function failure(promise) {
  try {
    await promise;
  } catch (error) {
    return error;
  }
  assert.fail('there was no error');
}

/** Everything that an iterator gives. */
export async function all(outcomes) {
  const list = [];
  for await (const outcome of outcomes) list.push(outcome);
  return list;
}

/** The indices that a clip returns before it fails, if it does, and its error. */
export async function until(clip) {
  const given = [];
  try {
    for await (const { index } of clip) given.push(index);
  } catch (error) {
    return { given, error };
  }
  return { given, error: undefined };
}
