//! Zoom and pan as numbers, without a browser.

import { expect, test } from '@playwright/test';

import { WHOLE, inPicture, panned, within, zoomedAt } from '../src/drawing/viewport.js';

test('zooming keeps the point under the pointer', () => {
  const at = [0.3, 0.7] as const;
  let viewport = WHOLE;
  const before = inPicture(viewport, at);
  for (const factor of [1.5, 2, 1.2, 0.8]) viewport = zoomedAt(viewport, factor, at, 1);
  const after = inPicture(viewport, at);
  expect(after[0]).toBeCloseTo(before[0], 12);
  expect(after[1]).toBeCloseTo(before[1], 12);
});

test('the picture always fills the view', () => {
  let viewport = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  viewport = panned(viewport, 100, -100, 1);
  expect(inPicture(viewport, [0, 1])).toEqual([0, 1]);
  expect(within({ zoom: 0.1, x: 0, y: 3 }, 1)).toEqual(WHOLE);
});

test('a pixel is at most 64 screen pixels large', () => {
  expect(zoomedAt(WHOLE, 1e6, [0.5, 0.5], 0.5).zoom).toBe(128);
});

test('panning is relative to the visible part', () => {
  const viewport = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  expect(panned(viewport, 0.5, 0, 1).x).toBeCloseTo(0.5 - 0.125, 12);
});
