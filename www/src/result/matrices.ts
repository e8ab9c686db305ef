//! A motion in the notation of other programs. Veronese's is a displacement measured from pixel centres, `x' = x + A x`.

import type { Matrix } from './describe.js';

export interface Notation {
  readonly title: string;
  readonly write: (matrix: Matrix) => string;
}

/** Enough digits for 4096 pixels to a thousandth. */
const short = (value: number): number => Number(value.toFixed(8));

/** The six numbers unchanged. */
function json(matrix: Matrix): string {
  return JSON.stringify(matrix);
}

/**
 * `matrix(a, b, c, d, e, f)` of SVG and CSS: x' = a x + c y + e, y' = b x + d y + f. The origin is the corner of the first pixel, half
 * a pixel from its centre.
 */
function svg([a11, a12, a13, a21, a22, a23]: Matrix): string {
  const numbers = [1 + a11, a21, a12, 1 + a22, a13 - (a11 + a12) / 2, a23 - (a21 + a22) / 2];
  return `matrix(${numbers.map(short).join(', ')})`;
}

/** The 2×3 matrix of `cv2.warpAffine(first, M, size)`, which measures from pixel centres. */
function openCv([a11, a12, a13, a21, a22, a23]: Matrix): string {
  return JSON.stringify([[1 + a11, a12, a13], [a21, 1 + a22, a23]].map((row) => row.map(short)));
}

export const NOTATIONS: readonly Notation[] = [
  { title: 'JSON', write: json },
  { title: 'SVG / CSS', write: svg },
  { title: 'OpenCV 2×3', write: openCv },
];
