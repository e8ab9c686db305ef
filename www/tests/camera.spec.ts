//! Zooming and panning as numbers, without a browser.

import { expect, test } from '@playwright/test';

import { WHOLE, inPicture, panned, within, zoomedAt } from '../src/camera.js';

test('what is under the pointer stays there', () => {
  const at = [0.3, 0.7] as const;
  let camera = WHOLE;
  const before = inPicture(camera, at);
  for (const factor of [1.5, 2, 1.2, 0.8]) camera = zoomedAt(camera, factor, at, 1);
  const after = inPicture(camera, at);
  expect(after[0]).toBeCloseTo(before[0], 12);
  expect(after[1]).toBeCloseTo(before[1], 12);
});

test('the picture never leaves the view', () => {
  let camera = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  camera = panned(camera, 100, -100, 1);
  expect(inPicture(camera, [0, 1])).toEqual([0, 1]);
  expect(within({ zoom: 0.1, x: 0, y: 3 }, 1)).toEqual(WHOLE);
});

test('a pixel becomes no larger than 64 of the screen', () => {
  expect(zoomedAt(WHOLE, 1e6, [0.5, 0.5], 0.5).zoom).toBe(128);
});

test('panning by a view moves by what a view shows', () => {
  const camera = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  expect(panned(camera, 0.5, 0, 1).x).toBeCloseTo(0.5 - 0.125, 12);
});
