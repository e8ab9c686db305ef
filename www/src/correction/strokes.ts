//! Brush strokes: paths that restrict which labels are allowed along them.

import type { Segmentation } from 'veronese';
import { type Part, labellingOf, labelsIn } from './parts.js';

/** A path over the first frame. */
export interface Path {
  /** x, y of each point in turn, pixels of the frame. */
  readonly points: readonly number[];
  /** Pixels. */
  readonly radius: number;
  /** Of a polygon: what the path encloses is meant, and the radius is not. */
  readonly filled?: boolean;
}

/** A stroke as drawn: "this mask" (`brush`) or "not this mask" (`eraser`). Never changed: strokes are compared by identity. */
export interface Stroke extends Path {
  readonly tool: 'brush' | 'eraser';
  readonly mask: Part;
}

/** A stroke as a restriction of the labels of one result. */
export interface Constraint extends Path {
  /** The allowed labels, one bit each. */
  readonly labels: number;
}

/** The labels that a stroke allows in this result, one bit each; 0 if it has no effect, because its mask or any other is missing. */
export function allowedLabels({ tool, mask }: Pick<Stroke, 'tool' | 'mask'>, found: Segmentation): number {
  const own = labelsIn(mask, labellingOf(found));
  if (tool === 'brush') return own;
  // A mask without labels is the unlabelled one: erasing it allows any motion.
  return own === 0 && mask.labels !== 0 ? 0 : ((1 << found.motions.length) - 1) & ~own;
}

/** The constraints of the strokes on this result, without those that have no effect. */
export function constraintsFrom(strokes: readonly Stroke[], found: Segmentation): Constraint[] {
  return strokes.map((stroke) => ({ ...stroke, labels: allowedLabels(stroke, found) })).filter(({ labels }) => labels !== 0);
}

/** All constraints as `relabel` expects them: the allowed labels of each pixel, one bit each, 0 for no constraint. */
export function evidenceOf(strokes: readonly Constraint[], width: number, height: number): Uint16Array<ArrayBuffer> {
  const evidence = new Uint16Array(width * height);
  for (const stroke of strokes) {
    eachPixel(stroke, width, height, (p) => {
      // If two strokes contradict each other, the later one counts.
      evidence[p] = evidence[p] === 0 ? stroke.labels : evidence[p]! & stroke.labels || stroke.labels;
    });
  }
  return evidence;
}

/** Calls `visit` for each pixel whose centre lies under the stroke, for some more than once. */
export function eachPixel({ points, radius, filled }: Path, width: number, height: number, visit: (pixel: number) => void): void {
  if (filled) return eachInside(points, width, height, visit);
  for (let i = 0; i < points.length; i += 2) {
    const [x0, y0] = [points[Math.max(0, i - 2)]!, points[Math.max(1, i - 1)]!];
    const [x1, y1] = [points[i]!, points[i + 1]!];
    const steps = Math.max(1, Math.ceil(Math.hypot(x1 - x0, y1 - y0) / Math.max(1, radius / 2)));
    for (let s = i === 0 ? steps : 1; s <= steps; s++) {
      disc(x0 + ((x1 - x0) * s) / steps, y0 + ((y1 - y0) * s) / steps, radius, width, height, visit);
    }
  }
}

/** Pixels inside a polygon by the even-odd rule. Of two polygons with a common side one has a centre that lies on it. */
function eachInside(points: readonly number[], width: number, height: number, visit: (pixel: number) => void): void {
  for (let y = 0; y < height; y++) {
    const crossed: number[] = [];
    for (let i = 0; i < points.length; i += 2) {
      const [x0, y0, x1, y1] = [points[i]!, points[i + 1]!, points[(i + 2) % points.length]!, points[(i + 3) % points.length]!];
      if (y0 <= y !== y1 <= y) crossed.push(x0 + ((y - y0) * (x1 - x0)) / (y1 - y0));
    }
    crossed.sort((one, other) => one - other);
    for (let k = 0; k < crossed.length; k += 2) {
      for (let x = Math.max(0, Math.ceil(crossed[k]!)); x < Math.min(width, crossed[k + 1]!); x++) visit(y * width + x);
    }
  }
}

function disc(x: number, y: number, radius: number, width: number, height: number, visit: (pixel: number) => void): void {
  const [top, bottom] = [Math.max(0, Math.ceil(y - radius)), Math.min(height - 1, Math.floor(y + radius))];
  for (let v = top; v <= bottom; v++) {
    const reach = Math.sqrt(Math.max(0, radius * radius - (v - y) ** 2));
    const [left, right] = [Math.max(0, Math.ceil(x - reach)), Math.min(width - 1, Math.floor(x + reach))];
    for (let u = left; u <= right; u++) visit(v * width + u);
  }
}
