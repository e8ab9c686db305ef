// Outlines of masks along the cracks between pixels: vertices are corners of pixels, (0, 0) the top-left corner of the image's
// first pixel. Filled by the even-odd rule they give the same pixels back. Pixels that touch at a corner only are apart.

import type { Mask } from './input.js';

/** x, y of one vertex after another; the last is joined to the first. Integers unless simplified. */
export type Ring = number[];

/** Rings of unit steps in one list: the vertices of ring r are `from[r]` to `from[r + 1]`, exclusive. */
interface Cracks {
  x: number[];
  y: number[];
  from: number[];
}

/** A hole, and its vertex at the end of the bridge. */
interface Hanging {
  ring: number;
  start: number;
}

/** Heading right, down, left, up: the step, and the pixels in front of a vertex to the left and to the right. */
const HEADINGS = [
  { step: [1, 0], left: [0, -1], right: [0, 0] },
  { step: [0, 1], left: [0, 0], right: [-1, 0] },
  { step: [-1, 0], left: [-1, 0], right: [-1, -1] },
  { step: [0, -1], left: [-1, -1], right: [0, -1] },
] as const;

/** Every border of the mask as a ring of its own, to be filled by the even-odd rule: outer ones clockwise, holes the other way. */
export function rings(mask: Mask, tolerance = 0): Ring[] {
  const cracks = traced(mask);
  return cracks.from.slice(0, -1).map((_, ring) => {
    return points(mask, cracks, shortened(cracks, walk(cracks, ring, new Map()), new Set(), tolerance));
  });
}

/**
 * One ring per connected part. A hole is reached over a bridge without width: a horizontal line that the ring takes there and back.
 */
export function bridgedRings(mask: Mask, tolerance = 0): Ring[] {
  const cracks = traced(mask);
  const { roots, children } = bridges(mask, cracks);
  const fixed = new Set([...children].flatMap(([anchor, holes]) => [anchor, ...holes.map(({ start }) => start)]));
  return roots.map((root) => points(mask, cracks, shortened(cracks, walk(cracks, root, children), fixed, tolerance)));
}

/** All parts in a single ring: bridges between the parts, too, all from the first part's first vertex. */
export function singleRing(mask: Mask, tolerance = 0): Ring {
  const [first = [], ...others] = bridgedRings(mask, tolerance);
  const start = first.slice(0, 2);
  const ring = [...first];
  for (const other of others) {
    for (const value of [...start, ...other, ...other.slice(0, 2)]) ring.push(value);
  }
  return ring;
}

/** Every border, the pixels of the mask on its right. */
function traced({ width, height, pixels }: Mask): Cracks {
  const inside = (x: number, y: number) => x >= 0 && y >= 0 && x < width && y < height && pixels[y * width + x] === 1;
  const cracks: Cracks = { x: [], y: [], from: [0] };
  // Every ring has a crack above a pixel: those are looked for, and crossed off when a ring passes.
  const passed = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (!inside(x, y) || inside(x, y - 1) || passed[y * width + x]) continue;
      let [atX, atY, heading] = [x, y, 0];
      do {
        cracks.x.push(atX);
        cracks.y.push(atY);
        if (heading === 0) passed[atY * width + atX] = 1;
        const [stepX, stepY] = (HEADINGS[heading] as (typeof HEADINGS)[number]).step;
        atX += stepX;
        atY += stepY;
        const { left, right } = HEADINGS[heading] as (typeof HEADINGS)[number];
        if (!inside(atX + right[0], atY + right[1])) heading = (heading + 1) % 4;
        else if (inside(atX + left[0], atY + left[1])) heading = (heading + 3) % 4;
      } while (atX !== x || atY !== y || heading !== 0);
      cracks.from.push(cracks.x.length);
    }
  }
  return cracks;
}

/**
 * Where each hole hangs: at the first vertex to the left of its top-left one that lies on a ring. That ring has a vertex above or
 * left of the hole's first, so there is no circle. Roots are the rings that are no holes.
 */
function bridges({ width, height }: Mask, { x, y, from }: Cracks) {
  const vertexAt = new Int32Array((width + 1) * (height + 1)).fill(-1);
  x.forEach((atX, vertex) => {
    vertexAt[(y[vertex] as number) * (width + 1) + atX] = vertex;
  });
  const roots: number[] = [];
  const children = new Map<number, Hanging[]>();
  for (let ring = 0; ring + 1 < from.length; ring++) {
    const start = from[ring] as number;
    const end = from[ring + 1] as number;
    if (signedArea(x, y, start, end) > 0) {
      roots.push(ring);
      continue;
    }
    const top = topLeft(x, y, start, end);
    let at = (y[top] as number) * (width + 1) + (x[top] as number) - 1;
    while (vertexAt[at] === -1) at--;
    const anchor = vertexAt[at] as number;
    const others = children.get(anchor);
    if (others) others.push({ ring, start: top });
    else children.set(anchor, [{ ring, start: top }]);
  }
  return { roots, children };
}

/** Twice the area inside: positive for an outer ring. */
function signedArea(x: readonly number[], y: readonly number[], start: number, end: number): number {
  let area = 0;
  for (let vertex = start, before = end - 1; vertex < end; before = vertex++) {
    area += (x[before] as number) * (y[vertex] as number) - (x[vertex] as number) * (y[before] as number);
  }
  return area;
}

function topLeft(x: readonly number[], y: readonly number[], start: number, end: number): number {
  let best = start;
  for (let vertex = start; vertex < end; vertex++) {
    const below = (y[vertex] as number) - (y[best] as number);
    if (below < 0 || (below === 0 && (x[vertex] as number) < (x[best] as number))) best = vertex;
  }
  return best;
}

/** A ring under way: it begins and ends at `start`. */
interface Tour {
  start: number;
  begin: number;
  size: number;
  done: number;
  /** The vertex it stands at, and the rings that hang there and are still to come. */
  at: number;
  pending: Hanging[];
}

/** The vertices of a ring with all that hangs on it. A stack and not recursion: holes may hang on holes by the thousand. */
function walk({ from }: Cracks, root: number, children: ReadonlyMap<number, readonly Hanging[]>): number[] {
  const tour = (ring: number, start: number): Tour => {
    const begin = from[ring] as number;
    return { start, begin, size: (from[ring + 1] as number) - begin, done: 0, at: start, pending: [] };
  };
  const vertices: number[] = [];
  const stack: Tour[] = [tour(root, from[root] as number)];
  for (let current = stack.at(-1); current !== undefined; current = stack.at(-1)) {
    const next = current.pending.pop();
    if (next !== undefined) {
      stack.push(tour(next.ring, next.start));
    } else if (current.done < current.size) {
      current.at = current.begin + ((current.start - current.begin + current.done++) % current.size);
      current.pending = [...(children.get(current.at) ?? [])];
      vertices.push(current.at);
    } else {
      stack.pop();
      // The hole is closed; then back over the bridge.
      const parent = stack.at(-1);
      if (parent) vertices.push(current.start, parent.at);
    }
  }
  return vertices;
}

/** Only the vertices that matter: corners, and with a tolerance those that Douglas and Peucker keep, and all of `fixed`. */
function shortened({ x, y }: Cracks, ring: readonly number[], fixed: ReadonlySet<number>, tolerance: number): number[] {
  const direction = (from: number, to: number) => {
    const across = Math.sign((x[to] as number) - (x[from] as number));
    return 3 * across + Math.sign((y[to] as number) - (y[from] as number));
  };
  const corners = ring.filter((vertex, at) => {
    const before = ring.at(at - 1) as number;
    const after = ring[(at + 1) % ring.length] as number;
    return direction(before, vertex) !== direction(vertex, after);
  });
  if (!(tolerance > 0) || corners.length <= 4) return corners;
  const distance = (vertex: number, from: number, to: number) => {
    const [alongX, alongY] = [(x[to] as number) - (x[from] as number), (y[to] as number) - (y[from] as number)];
    const [offX, offY] = [(x[vertex] as number) - (x[from] as number), (y[vertex] as number) - (y[from] as number)];
    const length = alongX * alongX + alongY * alongY;
    const share = length === 0 ? 0 : Math.min(1, Math.max(0, (offX * alongX + offY * alongY) / length));
    const [awayX, awayY] = [offX - share * alongX, offY - share * alongY];
    return awayX * awayX + awayY * awayY;
  };
  const farthest = (from: number, to: number) => {
    let best = { at: from, distance: -1 };
    for (let at = from + 1; at < to; at++) {
      const away = distance(corners[at] as number, corners[from] as number, corners[to % corners.length] as number);
      if (away > best.distance) best = { at, distance: away };
    }
    return best;
  };
  // The first corner, the one farthest from it and those in between that are farthest to either side always stay: a ring
  // never becomes a line.
  const keep = corners.map((vertex, at) => at === 0 || fixed.has(vertex));
  const opposite = farthest(0, corners.length).at;
  keep[opposite] = true;
  keep[farthest(0, opposite).at] = true;
  keep[farthest(opposite, corners.length).at] = true;
  const stops = [...corners.keys()].filter((at) => keep[at]);
  const spans = stops.map((from, index): [number, number] => [from, stops[index + 1] ?? corners.length]);
  for (let span = spans.pop(); span !== undefined; span = spans.pop()) {
    const [from, to] = span;
    const { at, distance } = farthest(from, to);
    if (distance <= tolerance * tolerance) continue;
    keep[at] = true;
    spans.push([from, at], [at, to]);
  }
  return corners.filter((_, at) => keep[at]);
}

function points({ left, top }: Mask, { x, y }: Cracks, vertices: readonly number[]): Ring {
  return vertices.flatMap((vertex) => [left + (x[vertex] as number), top + (y[vertex] as number)]);
}
