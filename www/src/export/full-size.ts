//! Masks and motions at the full size of frames that were scaled down.

import type { ClipFrame } from 'veronese';
import { resized, unpacked } from '../result/runs.js';
import type { TrackedFrame } from '../state/tracked.js';

interface Size {
  readonly width: number;
  readonly height: number;
}

type Matrix = NonNullable<ClipFrame['background']>;

/** The labels of a frame at this size, by nearest neighbour, and its motions in pixels of this size. */
export function atSize({ runs, objects, background }: TrackedFrame, { width, height }: Size): Pick<ClipFrame, 'labels' | 'width' | 'height' | 'background'> & { readonly objects: { id: number; matrix: Matrix | null }[] } {
  const of = (matrix: Matrix | null): Matrix | null => matrix && scaled(matrix, width / runs.width, height / runs.height);
  return { labels: unpacked(resized(runs, { width, height })), width, height, background: of(background), objects: objects.map(({ id, matrix }) => ({ id, matrix: of(matrix) })) };
}

/** Pixel centres have integer coordinates at both sizes: x = (X + ½) / s − ½. */
function scaled([a11, a12, a13, a21, a22, a23]: Matrix, sx: number, sy: number): Matrix {
  const [kx, ky] = [0.5 / sx - 0.5, 0.5 / sy - 0.5];
  return [a11, (a12 * sx) / sy, sx * (a13 + a11 * kx + a12 * ky), (a21 * sy) / sx, a22, sy * (a23 + a21 * kx + a22 * ky)];
}
