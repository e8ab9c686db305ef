//! An affine motion as a person would say it: where its pixels go, how far they turn, grow and stretch.

import type { Segmentation } from 'veronese';

/** Six entries `[a11, a12, a13, a21, a22, a23]`, as everywhere in the package. */
export type Matrix = Segmentation['motions'][number]['matrix'];

export interface MotionParts {
  /** Displacement of the centre, pixels; x right, y down. */
  readonly right: number;
  readonly down: number;
  /** Degrees, clockwise as seen. */
  readonly turn: number;
  /** Relative growth of lengths; 0.01 is one per cent. */
  readonly growth: number;
  /** Longest over shortest side of what a square becomes, minus 1: 0 for a motion without shear. */
  readonly stretch: number;
}

/** A tenth of a pixel is about what the estimate is good for: parts that move no pixel of the mask that far go unsaid. */
const VISIBLE = 0.1;

/** Splits `x ↦ x + A x` into displacement of `centre`, rotation, growth and stretch (the polar decomposition of its linear part). */
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

/** The parts that matter for a mask of this size; the others are set to 0. `reach` is the distance from centre to corner, pixels. */
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

/** Mean position of a label's pixels; the frame's centre for one without pixels. Looks at its bounding box alone. */
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
