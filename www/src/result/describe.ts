//! An affine motion as displacement, rotation, growth and stretch, to be put into words.

import type { Segmentation } from 'veronese';

/** Six entries `[a11, a12, a13, a21, a22, a23]`, as everywhere in the package. */
export type Matrix = Segmentation['motions'][number]['matrix'];

export interface MotionParts {
  /** Displacement of the centre, pixels; x right, y down. */
  readonly right: number;
  readonly down: number;
  /** Degrees, clockwise on the screen. */
  readonly turn: number;
  /** Relative growth of lengths; 0.01 is one per cent. */
  readonly growth: number;
  /** Ratio of the singular values of the linear part, minus 1: 0 if it keeps angles. */
  readonly stretch: number;
}

/** Parts that move no pixel of the mask this far are left out, pixels: about the accuracy of the estimate. */
const VISIBLE = 0.1;

/** Splits `x ↦ x + A x` into the displacement of `centre`, rotation, growth and stretch (polar decomposition of the linear part). */
export function partsOf(matrix: Matrix, centre: readonly [number, number]): MotionParts {
  const [a11, a12, a13, a21, a22, a23] = matrix;
  const [x, y] = centre;
  const [f11, f12, f21, f22] = [1 + a11, a12, a21, 1 + a22];
  const turning = Math.hypot((f11 + f22) / 2, (f21 - f12) / 2);
  const shearing = Math.hypot((f11 - f22) / 2, (f21 + f12) / 2);
  const shortest = Math.abs(turning - shearing);
  return {
    right: a11 * x + a12 * y + a13,
    down: a21 * x + a22 * y + a23,
    turn: (Math.atan2(f21 - f12, f11 + f22) * 180) / Math.PI,
    growth: Math.sqrt(Math.abs(f11 * f22 - f12 * f21)) - 1,
    stretch: shortest > 0 ? (turning + shearing) / shortest - 1 : 0,
  };
}

/** The parts that are visible in a mask of this size; the others are 0. `reach`: distance from its centre to a corner, pixels. */
export function visibleParts(parts: MotionParts, reach: number): MotionParts {
  const keep = (value: number, pixels: number): number => (Math.abs(pixels) >= VISIBLE ? value : 0);
  return {
    right: keep(parts.right, parts.right),
    down: keep(parts.down, parts.down),
    turn: keep(parts.turn, (parts.turn * Math.PI * reach) / 180),
    growth: keep(parts.growth, parts.growth * reach),
    stretch: keep(parts.stretch, (parts.stretch * reach) / 2),
  };
}

/** Mean position of a label's pixels; the centre of the frame if it has none. Reads only its bounding box. */
export function centreOf({ labels, width, height, motions }: Segmentation, label: number): readonly [number, number] {
  const [left, top, across, down] = motions[label]?.bbox ?? [0, 0, 0, 0];
  let [count, sumX, sumY] = [0, 0, 0];
  for (let y = top; y < top + down; y++) {
    for (let x = left; x < left + across; x++) {
      if (labels[y * width + x] !== label) continue;
      count += 1;
      sumX += x;
      sumY += y;
    }
  }
  return count > 0 ? [sumX / count, sumY / count] : [(width - 1) / 2, (height - 1) / 2];
}
