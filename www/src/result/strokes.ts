//! Brush strokes: paths, and the pixels under them.

/** A path over the first frame. */
export interface Path {
  /** x, y of each point in turn, pixels of the frame. */
  readonly points: readonly number[];
  /** Pixels. */
  readonly radius: number;
  /** Of a polygon: what the path encloses is meant, and the radius is not. */
  readonly filled?: boolean;
}

export type StrokeTool = 'brush' | 'eraser';

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
