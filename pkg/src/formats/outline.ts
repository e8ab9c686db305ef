// Outlines of masks along the cracks between pixels: vertices are corners of pixels, (0, 0) the top-left corner of the image's
// first pixel. Filled by the even-odd rule they give the same pixels back. Pixels that touch at a corner only are apart.
//
// Time and memory are linear in the border and the box: a mask of noise has as many vertices as pixels, so they are numbers in typed
// arrays.

import { VeroneseError } from '../common/errors.js';
import type { Mask } from './input.js';

/** x, y of one vertex after another, whole numbers; the last is joined to the first. */
export type Ring = number[];

/** Rings of unit steps in one list: the vertices of ring r are `from[r]` to `from[r + 1]`, exclusive. */
interface Cracks {
  x: Uint16Array;
  y: Uint16Array;
  from: number[];
}

/** The holes that hang at a vertex, as a list: the first, and from each to the next; `start` is a hole's own end of its bridge. */
interface Hanging {
  first: ReadonlyMap<number, number>;
  next: Int32Array;
  start: Int32Array;
}

/** Most vertices in the outlines of one document, of one image and of many. Only masks of noise have more, and files that no tool opens. */
const MOST_VERTICES = { image: 4_000_000, clip: 20_000_000 };

/** Recursion of Douglas and Peucker that is deeper than this splits rings so unevenly that its time is quadratic. */
const DEEPEST = 64;

const NONE = -1;

/** The outlines of the masks of one document. Throws `invalid-input` where they have too many vertices together. */
export class Outlines {
  readonly #tolerance: number;
  readonly #most: number;
  #left: number;

  /** Outlines may leave the border by `tolerance` pixels to have fewer vertices; 0 is exact. */
  constructor(tolerance = 0, kind: keyof typeof MOST_VERTICES = 'image') {
    this.#tolerance = tolerance;
    this.#most = MOST_VERTICES[kind];
    this.#left = this.#most;
  }

  /** Every border of the mask as a ring of its own, to be filled by the even-odd rule: outer ones clockwise, holes the other way. */
  rings(mask: Mask): Ring[] {
    const cracks = traced(mask);
    return cracks.from.slice(0, -1).map((begin, ring) => {
      const vertices = new Int32Array((cracks.from[ring + 1] as number) - begin);
      for (let at = 0; at < vertices.length; at++) vertices[at] = begin + at;
      return this.#ring(mask, cracks, shortened(cracks, vertices, undefined, this.#tolerance));
    });
  }

  /**
   * One ring per connected part. A hole is reached over a bridge without width: a horizontal line that the ring takes there and back.
   */
  bridged(mask: Mask): Ring[] {
    const cracks = traced(mask);
    const { roots, hanging, fixed } = bridges(mask, cracks);
    const walk = walker(cracks, hanging);
    return roots.map((root) => this.#ring(mask, cracks, shortened(cracks, walk(root), fixed, this.#tolerance)));
  }

  /** All parts in a single ring: bridges between the parts, too, all from the first part's first vertex. */
  single(mask: Mask): Ring {
    const [ring = [], ...others] = this.bridged(mask);
    const [x, y] = ring as [number, number];
    this.#take(2 * others.length);
    for (const other of others) {
      ring.push(x, y);
      for (const value of other) ring.push(value);
      ring.push(other[0] as number, other[1] as number);
    }
    return ring;
  }

  #ring({ left, top }: Mask, { x, y }: Cracks, vertices: Int32Array): Ring {
    this.#take(vertices.length);
    const ring: Ring = [];
    for (const vertex of vertices) ring.push(left + (x[vertex] as number), top + (y[vertex] as number));
    return ring;
  }

  #take(vertices: number): void {
    this.#left -= vertices;
    if (this.#left >= 0) return;
    const sentence = `the outlines have more than ${this.#most} vertices: take a larger tolerance or a format that holds masks`;
    throw new VeroneseError('invalid-input', sentence);
  }
}

/** The points of a ring. */
export function points(ring: Ring): [number, number][] {
  const pairs: [number, number][] = [];
  for (let at = 0; at < ring.length; at += 2) pairs.push([ring[at] as number, ring[at + 1] as number]);
  return pairs;
}

/** Every border, the pixels of the mask on its right. */
function traced({ width, height, pixels }: Mask): Cracks {
  // With a margin, so that no step asks where it is.
  const stride = width + 2;
  const inside = new Uint8Array(stride * (height + 2));
  for (let y = 0; y < height; y++) inside.set(pixels.subarray(y * width, (y + 1) * width), (y + 1) * stride + 1);
  const set = (at: number) => inside[at] as number;
  let steps = 0;
  for (let at = stride; at < inside.length - stride; at++) {
    if (set(at)) steps += 4 - set(at - 1) - set(at + 1) - set(at - stride) - set(at + stride);
  }
  const cracks: Cracks = { x: new Uint16Array(steps), y: new Uint16Array(steps), from: [0] };
  // Heading right, down, left, up: the step, and the pixels in front of a vertex to the left and to the right, both as ways from the
  // pixel whose top-left corner the vertex is.
  const [stepX, stepY] = [[1, 0, -1, 0], [0, 1, 0, -1]];
  const left = [-stride, 0, -1, -stride - 1];
  const right = [0, -1, -stride - 1, -stride];
  const ahead = [1, stride, -1, -stride];
  // Every ring has a crack above a pixel: those are looked for, and crossed off when a ring passes.
  const passed = new Uint8Array(inside.length);
  let count = 0;
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const start = (y + 1) * stride + x + 1;
      if (!set(start) || set(start - stride) || passed[start]) continue;
      let [at, atX, atY, heading] = [start, x, y, 0];
      do {
        cracks.x[count] = atX;
        cracks.y[count++] = atY;
        if (heading === 0) passed[at] = 1;
        at += ahead[heading] as number;
        atX += stepX[heading] as number;
        atY += stepY[heading] as number;
        if (!set(at + (right[heading] as number))) heading = (heading + 1) % 4;
        else if (set(at + (left[heading] as number))) heading = (heading + 3) % 4;
      } while (at !== start || heading !== 0);
      cracks.from.push(count);
    }
  }
  return cracks;
}

/**
 * Where each hole hangs: at the first vertex to the left of its top-left one that lies on a ring. That ring has a vertex above or
 * left of the hole's first, so there is no circle. Roots are the rings that are no holes; vertices at the ends of bridges are fixed.
 */
function bridges({ width, height }: Mask, { x, y, from }: Cracks) {
  const vertexAt = new Int32Array((width + 1) * (height + 1)).fill(NONE);
  for (let vertex = 0; vertex < x.length; vertex++) vertexAt[(y[vertex] as number) * (width + 1) + (x[vertex] as number)] = vertex;
  const roots: number[] = [];
  const first = new Map<number, number>();
  const hanging = { first, next: new Int32Array(from.length).fill(NONE), start: new Int32Array(from.length) } satisfies Hanging;
  const fixed = new Uint8Array(x.length);
  for (let ring = 0; ring + 1 < from.length; ring++) {
    const begin = from[ring] as number;
    const end = from[ring + 1] as number;
    if (signedArea(x, y, begin, end) > 0) {
      roots.push(ring);
      continue;
    }
    const top = topLeft(x, y, begin, end);
    let at = (y[top] as number) * (width + 1) + (x[top] as number) - 1;
    while (vertexAt[at] === NONE) at--;
    const anchor = vertexAt[at] as number;
    hanging.start[ring] = top;
    hanging.next[ring] = first.get(anchor) ?? NONE;
    first.set(anchor, ring);
    fixed[anchor] = 1;
    fixed[top] = 1;
  }
  return { roots, hanging, fixed };
}

/** Twice the area inside: positive for an outer ring. */
function signedArea(x: Uint16Array, y: Uint16Array, begin: number, end: number): number {
  let area = 0;
  for (let vertex = begin, before = end - 1; vertex < end; before = vertex++) {
    area += (x[before] as number) * (y[vertex] as number) - (x[vertex] as number) * (y[before] as number);
  }
  return area;
}

function topLeft(x: Uint16Array, y: Uint16Array, begin: number, end: number): number {
  let best = begin;
  for (let vertex = begin; vertex < end; vertex++) {
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
  /** The vertex it stands at, and the first of the rings that hang there and are still to come. */
  at: number;
  pending: number;
}

/** Gives the vertices of a ring with all that hangs on it. A stack and not recursion: holes may hang on holes by the thousand. */
function walker({ x, from }: Cracks, { first, next, start }: Hanging): (root: number) => Int32Array {
  // Each ring is walked once, and each bridge has two ends to come back over.
  const room = new Int32Array(x.length + 2 * from.length);
  const tour = (ring: number, start: number): Tour => {
    const begin = from[ring] as number;
    return { start, begin, size: (from[ring + 1] as number) - begin, done: 0, at: start, pending: NONE };
  };
  return (root) => {
    let count = 0;
    let current = tour(root, from[root] as number);
    const stack: Tour[] = [];
    for (;;) {
      if (current.pending !== NONE) {
        const hole = current.pending;
        current.pending = next[hole] as number;
        stack.push(current);
        current = tour(hole, start[hole] as number);
      } else if (current.done < current.size) {
        current.at = current.begin + ((current.start - current.begin + current.done++) % current.size);
        current.pending = first.get(current.at) ?? NONE;
        room[count++] = current.at;
      } else {
        const parent = stack.pop();
        if (!parent) return room.slice(0, count);
        // The hole is closed; then back over the bridge.
        room[count++] = current.start;
        room[count++] = parent.at;
        current = parent;
      }
    }
  };
}

/** Only the vertices that matter: corners, and with a tolerance those that Douglas and Peucker keep, and all that are `fixed`. */
function shortened({ x, y }: Cracks, ring: Int32Array, fixed: Uint8Array | undefined, tolerance: number): Int32Array {
  const corners = cornersOf(x, y, ring);
  const { length } = corners;
  if (!(tolerance > 0) || length <= 4) return corners;
  /** The corner between two others that is farthest from the line between them; none where all are nearer than `least`. */
  const farthest = (from: number, to: number, least = -1): number => {
    const [start, end] = [corners[from] as number, corners[to < length ? to : 0] as number];
    const [startX, startY] = [x[start] as number, y[start] as number];
    const [alongX, alongY] = [(x[end] as number) - startX, (y[end] as number) - startY];
    const squared = alongX * alongX + alongY * alongY;
    let [best, distance] = [NONE, least];
    for (let at = from + 1; at < to; at++) {
      const vertex = corners[at] as number;
      const [offX, offY] = [(x[vertex] as number) - startX, (y[vertex] as number) - startY];
      const share = squared === 0 ? 0 : Math.min(1, Math.max(0, (offX * alongX + offY * alongY) / squared));
      const [awayX, awayY] = [offX - share * alongX, offY - share * alongY];
      const away = awayX * awayX + awayY * awayY;
      if (away > distance) [best, distance] = [at, away];
    }
    return best;
  };
  // The first corner, the one farthest from it and those in between that are farthest to either side always stay: a ring
  // never becomes a line.
  const keep = new Uint8Array(length);
  if (fixed) for (let at = 0; at < length; at++) keep[at] = fixed[corners[at] as number] as number;
  const opposite = farthest(0, length);
  for (const at of [0, opposite, farthest(0, opposite), farthest(opposite, length)]) if (at !== NONE) keep[at] = 1;
  let last = 0;
  for (let at = 1; at <= length; at++) {
    if (at < length && !keep[at]) continue;
    thin(last, at);
    last = at;
  }
  return corners.filter((_, at) => keep[at]);

  function thin(first: number, end: number): void {
    const spans: [from: number, to: number, depth: number][] = [[first, end, 0]];
    for (let span = spans.pop(); span !== undefined; span = spans.pop()) {
      const [from, to, depth] = span;
      const at = farthest(from, to, tolerance * tolerance);
      if (at === NONE) continue;
      const split = depth < DEEPEST ? at : (from + to) >> 1;
      keep[split] = 1;
      spans.push([from, split, depth + 1], [split, to, depth + 1]);
    }
  }
}

/** The vertices at which a ring turns. */
function cornersOf(x: Uint16Array, y: Uint16Array, ring: Int32Array): Int32Array {
  const direction = (from: number, to: number) => {
    const across = Math.sign((x[to] as number) - (x[from] as number));
    return 3 * across + Math.sign((y[to] as number) - (y[from] as number));
  };
  const corners = new Int32Array(ring.length);
  let count = 0;
  let before = direction(ring.at(-1) as number, ring[0] as number);
  for (let at = 0; at < ring.length; at++) {
    const vertex = ring[at] as number;
    const after = direction(vertex, ring[at + 1 < ring.length ? at + 1 : 0] as number);
    if (before !== after) corners[count++] = vertex;
    before = after;
  }
  return corners.slice(0, count);
}
