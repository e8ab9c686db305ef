// The frames of the long soak: a square that moves before a ground, 320 × 240, drawn from a number.

import { frame } from '../../../pkg/test/support/moving.mjs';

export const SIZE = { width: 320, height: 240 };
export const OPTIONS = { quality: 'fast' };
/** The pair that is asked for after each batch. */
export const REFERENCE = 1;

/** The pair of a number. Speeds repeat after 13 × 11 × 7 pairs. */
export function pairOf(number) {
  const motion = { ...SIZE, background: [((number % 7) - 3) / 4, 0.25], square: [(number % 13) - 6, ((number % 11) - 5) / 2] };
  return { first: frame(0, motion), second: frame(1, motion), number };
}

/** A frame of an endless clip: the square goes to and fro. */
export function frameAt(index) {
  const period = 40;
  const phase = index % (2 * period);
  const t = phase < period ? phase : 2 * period - phase;
  return frame(t, { ...SIZE, square: [2.5, 1] });
}
