// The outcome that every host of the package must have: the same bits as a direct call in Node.

import assert from 'node:assert/strict';
import { fitMotions, segmentPair } from 'veronese';
import { pair } from '../support/moving.mjs';
import { measurements } from './app/measurements.js';
import { report } from './app/report.js';

/** The report of a direct call. */
export const expected = report(await segmentPair(...pair()));
const fit = await fitMotions(measurements);
assert.equal(fit.count, 2);
const expectedFit = report(fit);

export function checkOutcome({ outcome, complaints }, kinds = ['direct', 'inWorker']) {
  assert.equal(outcome.error, undefined);
  assert.deepEqual(complaints, []);
  for (const kind of kinds) assert.equal(outcome[kind], expected, kind);
  for (const one of outcome.pooled ?? []) assert.equal(one, expected);
  for (const one of outcome.fits ?? []) assert.equal(one, expectedFit);
}

/** That nothing of what app/main.js does is missing. */
export function isWhole({ outcome }) {
  assert.deepEqual(Object.keys(outcome), ['direct', 'inWorker', 'pooled', 'fits']);
}
