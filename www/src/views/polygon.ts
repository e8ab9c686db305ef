//! The corners of a polygon while it is drawn, x and y of each in turn. The last one is under the pointer, and not set yet.

/** The coordinates of the least corners of a polygon. */
const TRIANGLE = 6;

/** The corners that are set. */
export function cornersOf(points: readonly number[]): number[] {
  return points.slice(0, -2);
}

/**
 * Sets the corner under the pointer. At the first corner, or again at the one before, it closes the polygon instead: returns whether it does.
 * `reach`: how near the first corner is enough; for the one before it is a third, so that corners can be close to each other.
 */
export function setCorner(points: number[], reach: number): boolean {
  const last = points.length - 2;
  const [x, y] = [points[last]!, points[last + 1]!];
  const isAt = (corner: number, near: number): boolean => corner >= 0 && corner < last && Math.hypot(points[corner]! - x, points[corner + 1]! - y) <= near;
  if (isAt(0, reach) || isAt(last - 2, reach / 3)) return isPolygon(cornersOf(points));
  points.push(x, y);
  return false;
}

/** Takes the corner back that was set last. Returns whether one is left. */
export function takeBack(points: number[]): boolean {
  points.splice(-4, 2);
  return points.length > 2;
}

export function isPolygon(corners: readonly number[]): boolean {
  return corners.length >= TRIANGLE;
}

/** A dot at each corner. */
export function dotsOf(corners: readonly number[]): string {
  return corners.map((x, k) => (k % 2 === 0 ? `M${x.toFixed(1)} ${corners[k + 1]!.toFixed(1)}h0.01` : '')).join('');
}
