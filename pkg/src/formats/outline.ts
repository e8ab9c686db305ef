// Outlines of masks along the cracks between pixels: vertices are corners of pixels, (0, 0) the top-left corner of the image's
// first pixel. Filled by the even-odd rule they give the same pixels back. Pixels that touch at a corner only are apart. With a tolerance,
// arcs.ts thins them.
//
// Time and memory are linear in the border and the box: a mask of noise has as many vertices as pixels, so they are numbers in typed
// arrays.

import { VeroneseError } from '../common/errors.js';
import { Borders, type Masks, thinned } from './arcs.js';
import type { Mask } from './masks.js';
import { hang, joined, nothingHangs, type Ring, walker } from './joining.js';

export type { Ring };

/** Rings of unit steps in one list: the vertices of ring r are `from[r]` to `from[r + 1]`, exclusive. */
interface Cracks {
  x: Uint16Array;
  y: Uint16Array;
  from: number[];
}

/** Most vertices in the outlines of one document, of one image and of many. Only masks of noise have more, and files that no tool opens. */
const MOST_VERTICES = { image: 4_000_000, clip: 20_000_000 };

const NONE = -1;

/** The outlines of the masks of one document. Throws `invalid-input` where they have too many vertices together. */
export class Outlines {
  readonly #tolerance: number;
  readonly #most: number;
  #left: number;

  /** Outlines may leave the border by `tolerance` pixels in x and in y to have fewer vertices; 0 is exact. */
  constructor(tolerance = 0, kind: keyof typeof MOST_VERTICES = 'image') {
    this.#tolerance = tolerance;
    this.#most = MOST_VERTICES[kind];
    this.#left = this.#most;
  }

  /**
   * Of each mask one ring per connected part. A hole is reached over a bridge without width: a horizontal line that the ring takes there
   * and back.
   */
  bridged(image: Masks): Ring[][] {
    const borders = this.#bordersOf(image);
    const traces = image.masks.map((mask) => {
      const cracks = traced(mask);
      const { roots, hanging, ends } = bridges(mask, cracks);
      // Before any mask is thinned: the masks on the other side have the ends of bridges as vertices, too.
      for (const end of ends) borders?.addNode(mask.left + (cracks.x[end] as number), mask.top + (cracks.y[end] as number));
      return { mask, cracks, roots, hanging };
    });
    return traces.map(({ mask, cracks, roots, hanging }) => {
      const walk = walker(cracks.from, hanging);
      return roots.map((root) => this.#ring(mask, cracks, walk(root), borders));
    });
  }

  /** Of each mask all parts in a single ring: with bridges between the parts, too, from where they are nearest to each other. */
  singles(image: Masks): Ring[] {
    return this.bridged(image).map((parts) => {
      this.#take(3 * (parts.length - 1));
      return joined(parts);
    });
  }

  #bordersOf(image: Masks): Borders | undefined {
    return this.#tolerance > 0 ? new Borders(image, this.#tolerance) : undefined;
  }

  #ring({ left, top }: Mask, { x, y }: Cracks, way: Int32Array, borders: Borders | undefined): Ring {
    const isNode = borders && ((vertex: number) => borders.isNode(left + (x[vertex] as number), top + (y[vertex] as number)));
    const corners: Ring = [];
    for (const vertex of cornersOf(x, y, way, isNode)) corners.push(left + (x[vertex] as number), top + (y[vertex] as number));
    const ring = borders ? thinned(corners, borders) : corners;
    this.#take(ring.length / 2);
    return ring;
  }

  #take(vertices: number): void {
    this.#left -= vertices;
    if (this.#left >= 0) return;
    const sentence = `the outlines have more than ${this.#most} vertices: take a format that holds masks`;
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
  const [stepX, stepY] = [
    [1, 0, -1, 0],
    [0, 1, 0, -1],
  ];
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
 * left of the hole's first, so there is no circle. Roots are the rings that are no holes; `ends` are the vertices at the ends of bridges.
 */
function bridges({ width, height }: Mask, { x, y, from }: Cracks) {
  const vertexAt = new Int32Array((width + 1) * (height + 1)).fill(NONE);
  for (let vertex = 0; vertex < x.length; vertex++) vertexAt[(y[vertex] as number) * (width + 1) + (x[vertex] as number)] = vertex;
  const roots: number[] = [];
  const hanging = nothingHangs(from.length);
  const ends: number[] = [];
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
    hang(hanging, ring, top, anchor);
    ends.push(anchor, top);
  }
  return { roots, hanging, ends };
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

/** The vertices at which a ring turns, and its nodes. */
function cornersOf(x: Uint16Array, y: Uint16Array, ring: Int32Array, isNode?: (vertex: number) => boolean): Int32Array {
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
    if (before !== after || isNode?.(vertex)) corners[count++] = vertex;
    before = after;
  }
  return corners.slice(0, count);
}
