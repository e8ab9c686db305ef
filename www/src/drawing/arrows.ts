//! Flow arrows, from positions in the first frame to positions in the second.

import type { Segmentation } from 'veronese';

export interface Arrow {
  readonly label: number;
  readonly from: readonly [number, number];
  readonly to: readonly [number, number];
}

/** Number of arrows along the longer side. */
const ACROSS = 24;
/** Arrows are magnified until the longest is about this long, in cells of the grid, so that slow motions are visible. */
const LONGEST = 1.2;

/** One arrow per grid cell, for the label at its centre, and the factor by which all are magnified. */
export function arrowsOf({ labels, width, height, motions }: Segmentation): { arrows: Arrow[]; magnified: number } {
  const cell = Math.max(width, height) / ACROSS;
  const matrices = new Map(motions.map(({ label, matrix }) => [label, matrix]));
  const starts: { label: number; x: number; y: number; u: number; v: number }[] = [];
  for (let y = cell / 2; y < height; y += cell) {
    for (let x = cell / 2; x < width; x += cell) {
      const [px, py] = [Math.floor(x), Math.floor(y)];
      const label = labels[py * width + px] ?? 255;
      const matrix = matrices.get(label);
      if (matrix === undefined) continue;
      const [a11, a12, a13, a21, a22, a23] = matrix;
      starts.push({ label, x: px, y: py, u: a11 * px + a12 * py + a13, v: a21 * px + a22 * py + a23 });
    }
  }
  const longest = starts.reduce((most, { u, v }) => Math.max(most, Math.hypot(u, v)), 0);
  const magnified = longest > 0.05 ? Math.max(1, Math.floor((LONGEST * cell) / longest)) : 1;
  const arrows = starts.map(({ label, x, y, u, v }): Arrow => ({ label, from: [x, y], to: [x + magnified * u, y + magnified * v] }));
  return { arrows, magnified };
}
