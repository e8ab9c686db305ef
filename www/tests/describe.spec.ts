//! Motions in words, without a browser.

import { expect, test } from '@playwright/test';

import { strings } from '../src/common/strings.js';
import { type Matrix, partsOf, visibleParts } from '../src/result/describe.js';

const CENTRE = [120, 80] as const;

/** The motion whose linear part is F and that moves the centre by (u, v). */
function about([f11, f12, f21, f22]: [number, number, number, number], u: number, v: number): Matrix {
  const [a11, a12, a21, a22] = [f11 - 1, f12, f21, f22 - 1];
  return [a11, a12, u - a11 * CENTRE[0] - a12 * CENTRE[1], a21, a22, v - a21 * CENTRE[0] - a22 * CENTRE[1]];
}

function words(matrix: Matrix, reach = 100): string {
  return strings.motion(visibleParts(partsOf(matrix, CENTRE), reach)).replaceAll('\u00a0', ' ');
}

test('the zero motion stands still', () => {
  expect(words([0, 0, 0, 0, 0, 0])).toBe('stands still');
});

test('x is right and y is down', () => {
  expect(words(about([1, 0, 0, 1], 4.13, -0.21))).toBe('moves 4.1 px right, 0.21 px up');
  expect(words(about([1, 0, 0, 1], -4.13, 12))).toBe('moves 4.1 px left, 12 px down');
});

test('a displacement is a length in one of eight directions, or what else the motion does', () => {
  const short = (matrix: Matrix): string => strings.displacement(visibleParts(partsOf(matrix, CENTRE), 100)).replaceAll('\u00a0', ' ');
  expect(short(about([1, 0, 0, 1], 1.2, 14.3))).toBe('14 px down');
  expect(short(about([1, 0, 0, 1], -4.13, -0.21))).toBe('4.1 px left');
  expect(short(about([1, 0, 0, 1], 3, 4))).toBe('5 px to the lower right');
  expect(short(about([1, 0, 0, 1], 3, -4))).toBe('5 px to the upper right');
  expect(short(about([0.97, 0, 0, 0.97], 0, 0))).toBe('shrinks 3 %');
});

test('x towards y is clockwise', () => {
  const angle = (1.2 * Math.PI) / 180;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  expect(words(about([c, -s, s, c], 0, 0))).toBe('turns 1.2° clockwise');
  expect(words(about([c, s, -s, c], 0, 0))).toBe('turns 1.2° anticlockwise');
});

test('lengths grow and shrink', () => {
  expect(words(about([1.005, 0, 0, 1.005], 0, 0))).toBe('grows 0.5 %');
  expect(words(about([0.97, 0, 0, 0.97], 0, 0))).toBe('shrinks 3 %');
});

test('a stretch keeps the area', () => {
  expect(words(about([1.02, 0, 0, 1 / 1.02], 0, 0))).toBe('stretches 4 %');
});

test('parts that move no pixel of the mask are left out', () => {
  const turn = about([1, -0.002, 0.002, 1], 0.03, 0);
  expect(words(turn, 10)).toBe('stands still');
  expect(words(turn, 400)).toBe('turns 0.11° clockwise');
});
