//! Zooming and panning as numbers, without a browser.

import { expect, test } from '@playwright/test';

import { WHOLE, inPicture, panned, within, zoomedAt } from '../src/drawing/viewport.js';

test('what is under the pointer stays there', () => {
  const at = [0.3, 0.7] as const;
  let viewport = WHOLE;
  const before = inPicture(viewport, at);
  for (const factor of [1.5, 2, 1.2, 0.8]) viewport = zoomedAt(viewport, factor, at, 1);
  const after = inPicture(viewport, at);
  expect(after[0]).toBeCloseTo(before[0], 12);
  expect(after[1]).toBeCloseTo(before[1], 12);
});

test('the picture never leaves the view', () => {
  let viewport = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  viewport = panned(viewport, 100, -100, 1);
  expect(inPicture(viewport, [0, 1])).toEqual([0, 1]);
  expect(within({ zoom: 0.1, x: 0, y: 3 }, 1)).toEqual(WHOLE);
});

test('a pixel becomes no larger than 64 of the screen', () => {
  expect(zoomedAt(WHOLE, 1e6, [0.5, 0.5], 0.5).zoom).toBe(128);
});

test('panning by a view moves by what a view shows', () => {
  const viewport = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  expect(panned(viewport, 0.5, 0, 1).x).toBeCloseTo(0.5 - 0.125, 12);
});
