// The contract of results, field by field.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import Ajv from 'ajv/dist/2020.js';

const isResult = new Ajv().compile(JSON.parse(readFileSync(new URL('../../schemas/result.schema.json', import.meta.url), 'utf8')));

const finite = (value, name) => assert.ok(typeof value === 'number' && Number.isFinite(value), `${name} is ${value}`);

export function checkMatrix(matrix) {
  assert.ok(Array.isArray(matrix));
  assert.equal(matrix.length, 6);
  for (const entry of matrix) finite(entry, 'a matrix entry');
}

/** The JSON of a pair: as its schema says, and without contradictions. */
export function checkPair(result, width, height) {
  assert.ok(isResult(result), JSON.stringify(isResult.errors));
  const { motions, count, unlabelled, junctions } = result;
  assert.deepEqual([result.width, result.height, count], [width, height, motions.length]);
  motions.forEach(({ label, pixels, share, residual, bbox: [x, y, w, h], group }, index) => {
    assert.equal(label, index);
    assert.ok(Math.abs(share - pixels / (width * height)) < 1e-12);
    assert.ok(residual <= 255 && x + w <= width && y + h <= height);
    assert.ok(group <= index, 'groups are numbered in the order of labels');
    assert.ok(index === 0 || pixels <= motions[index - 1].pixels, 'labels by decreasing size');
  });
  assert.equal(motions.reduce((sum, { pixels }) => sum + pixels, unlabelled), width * height);
  const order = junctions.map(({ labels: [one, other], border }) => {
    assert.ok(one < other && other < count && border > 0 && border < 2 * width * height);
    return one * count + other;
  });
  assert.deepEqual(order, [...new Set(order)].sort((a, b) => a - b), 'junctions by labels');
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
export function checkPoints({ version, count, motions, labels, evidence, stages, milliseconds }, measured) {
  assert.deepEqual([version, count, labels.length], [1, motions.length, measured]);
  motions.forEach(({ label, matrix, measurements }, index) => {
    assert.deepEqual([label, measurements], [index, labels.filter((one) => one === index).length]);
    checkMatrix(matrix);
  });
  for (const value of [...evidence.singularValues, ...evidence.candidates.map(({ score }) => score), ...Object.values(milliseconds)]) finite(value, 'a number');
  for (const matrix of [...(stages?.factorisation ?? []), ...(stages?.refined ?? [])]) checkMatrix(matrix);
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
