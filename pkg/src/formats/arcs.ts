// Borders with fewer vertices. The borders of all masks of an image are one graph: an arc is what lies between two nodes, where three
// borders or more meet or where something hangs. Each arc is thinned by itself and its ends stay, so that masks on both of its sides have
// the same vertices: no gap, no overlap.
//
// The vertices of a thinned arc are corners of the border and middles of its straight pieces: few, and such that every corner left out is
// nearer to the line than its reach. They are a shortest path as in Selinger's "Potrace: a polygon-based tracing algorithm" (2003); the
// lines to choose from are found by Imai and Iri's cone, in time linear in the corners. Pixels know their border to ½: with that reach
// every pixel stays, because pixel centres are ½ away from the border. The tolerance, in x and in y, is added to it, but less in masks
// that are narrow as a whole, of which it would change too much, and where the next border is near, so that lines stay apart.

import type { Mask } from './masks.js';

/** The masks of one image. */
export interface Masks {
  masks: readonly Mask[];
  width: number;
  height: number;
}

/** A line passes at most so many corners and middles, so that time is linear also where all are near it. */
const LONGEST = 256;

/** The mean width, pixels, from which on masks are wide. It kept the IoU of all large masks of DAVIS above .98 at half a pixel. */
const WIDE = 30;

/** How much reach each pixel adds that lies before the next border: lines on both sides of the pixels stay apart. */
const STEEP = 1 / 5;

/** A corner left out at its reach costs so many vertices, others by the square of their distance: of similar lines the nearer one. */
const FIDELITY = 0.3;

/** Rectangles stay, also those of one pixel, of which a triangle is near enough. */
const RECTANGLE = 4 * 2;

/** Which mask is where, and the nodes among the vertices of the grid between the pixels. */
export class Borders {
  /** Numbers of masks from 1, row by row with a margin that is a region of its own: arcs end at the edge of the image. */
  readonly #regions: Uint16Array;
  readonly #stride: number;
  readonly #nodes: Uint8Array;
  /** The length that the tolerance adds to the reach, by region. */
  readonly #added: Float64Array;

  constructor({ masks, width, height }: Masks, tolerance: number) {
    const outside = masks.length + 1;
    this.#stride = width + 2;
    this.#regions = new Uint16Array(this.#stride * (height + 2)).fill(outside);
    for (let y = 1; y <= height; y++) this.#regions.fill(0, y * this.#stride + 1, y * this.#stride + 1 + width);
    for (const [index, mask] of masks.entries()) {
      for (let y = 0, at = 0; y < mask.height; y++) {
        const start = (mask.top + y + 1) * this.#stride + mask.left + 1;
        for (let x = 0; x < mask.width; x++) if (mask.pixels[at++]) this.#regions[start + x] = index + 1;
      }
    }
    this.#nodes = new Uint8Array(this.#regions.length);
    const perimeters = new Float64Array(outside + 1);
    const crack = (one: number, other: number) => {
      if (one === other) return 0;
      (perimeters[one] as number)++;
      (perimeters[other] as number)++;
      return 1;
    };
    for (let y = 0; y <= height; y++) {
      for (let x = 0; x <= width; x++) {
        const [a, b, c, d] = this.#around(x, y);
        if (crack(a, b) + crack(a, c) + Number(b !== d) + Number(c !== d) > 2) this.addNode(x, y);
      }
    }
    for (const x of [0, width]) for (const y of [0, height]) this.addNode(x, y);
    this.#added = new Float64Array(outside + 1).fill(Math.SQRT2 * tolerance);
    for (const [index, { area }] of masks.entries()) {
      const meanWidth = (2 * area) / (perimeters[index + 1] as number);
      (this.#added[index + 1] as number) *= Math.min(1, meanWidth / WIDE);
    }
  }

  addNode(x: number, y: number): void {
    this.#nodes[y * this.#stride + x] = 1;
  }

  isNode(x: number, y: number): boolean {
    return this.#nodes[y * this.#stride + x] === 1;
  }

  /** How far a line may be from a corner that it leaves out. */
  reach(x: number, y: number): number {
    const [a, b, c, d] = this.#around(x, y);
    // Of the four pixels one is alone on its side. It and the one across, and how far it is from there to the next borders.
    const [down, above, below] = a === d ? [-1, c, b] : [1, a, d];
    const most = Math.min(this.#added[above] as number, this.#added[below] as number);
    const enough = most / STEEP;
    return 0.5 + Math.min(most, STEEP * this.#clear(x, y, 1, down, enough), STEEP * this.#clear(x, y, -1, -down, enough));
  }

  /** The regions of the pixels around a vertex: row by row. */
  #around(x: number, y: number): [number, number, number, number] {
    const at = y * this.#stride + x;
    const below = at + this.#stride;
    return [this.#regions[at], this.#regions[at + 1], this.#regions[below], this.#regions[below + 1]] as [number, number, number, number];
  }

  /** Pixels to the next border in row or column, after the one that is in this direction from a vertex; not much more than `most`. */
  #clear(x: number, y: number, right: number, down: number, most: number): number {
    const pixel = (down > 0 ? y + 1 : y) * this.#stride + (right > 0 ? x + 1 : x);
    const isSame = (step: number) => this.#regions[pixel + step] === this.#regions[pixel];
    let beyond = 0;
    while (beyond < most && isSame((beyond + 1) * right) && isSame((beyond + 1) * down * this.#stride)) beyond++;
    return beyond;
  }
}

/** A ring of corners and nodes with fewer vertices. */
export function thinned(ring: readonly number[], borders: Borders): number[] {
  const isNode = (at: number) => borders.isNode(ring[at] as number, ring[at + 1] as number);
  let start = 0;
  while (start < ring.length && !isNode(start)) start += 2;
  if (start >= ring.length) return thinnedLoop(ring, borders);
  const vertices: number[] = [];
  let arc: number[] = [];
  for (let step = 0; step <= ring.length; step += 2) {
    const at = (start + step) % ring.length;
    arc.push(ring[at] as number, ring[at + 1] as number);
    if (step === 0 || !isNode(at)) continue;
    for (const value of thinnedArc(arc, borders).slice(0, -2)) vertices.push(value);
    arc = arc.slice(-2);
  }
  return vertices;
}

/** A ring without nodes: from its top left corner round to that. */
function thinnedLoop(ring: readonly number[], borders: Borders): number[] {
  if (ring.length <= RECTANGLE) return [...ring];
  let first = 0;
  for (let at = 2; at < ring.length; at += 2) if (compared(ring, at, first) < 0) first = at;
  return thinnedArc([...ring.slice(first), ...ring.slice(0, first + 2)], borders).slice(0, -2);
}

/** The vertices that an arc keeps of its corners and ends: the same ones in the other direction. */
function thinnedArc(arc: readonly number[], borders: Borders): number[] {
  if (arc.length <= RECTANGLE) return [...arc];
  const last = arc.length - 2;
  const isTurned = (compared(arc, 0, last) || compared(arc, 2, last - 2)) > 0;
  const vertices = shortest(isTurned ? turned(arc) : arc, borders);
  return isTurned ? turned(vertices) : vertices;
}

/** Below 0 where the vertex at `a` comes before that at `b`, from the top left. */
function compared(vertices: readonly number[], a: number, b: number): number {
  return (vertices[a + 1] as number) - (vertices[b + 1] as number) || (vertices[a] as number) - (vertices[b] as number);
}

function turned(vertices: readonly number[]): number[] {
  const others: number[] = [];
  for (let at = vertices.length - 2; at >= 0; at -= 2) others.push(vertices[at] as number, vertices[at + 1] as number);
  return others;
}

/** The way of least cost from the first corner to the last. */
function shortest(corners: readonly number[], borders: Borders): number[] {
  const last = corners.length - 2;
  // Candidates are corners and, between them, middles. From the first corner, in half pixels: whole numbers.
  const [originX, originY] = [corners[0] as number, corners[1] as number];
  const [x, y, reach] = [new Float64Array(last + 1), new Float64Array(last + 1), new Float64Array(last + 1)];
  for (let at = 0; at <= last; at += 2) {
    const [cornerX, cornerY] = [corners[at] as number, corners[at + 1] as number];
    x[at] = 2 * (cornerX - originX);
    y[at] = 2 * (cornerY - originY);
    // A corner exactly at its reach is too far.
    if (at > 0 && at < last) reach[at] = 2 * borders.reach(cornerX, cornerY) * (1 - 1e-9);
  }
  for (let at = 1; at < last; at += 2) {
    x[at] = ((x[at - 1] as number) + (x[at + 1] as number)) / 2;
    y[at] = ((y[at - 1] as number) + (y[at + 1] as number)) / 2;
  }
  const cost = new Float64Array(last + 1).fill(Infinity);
  const before = new Int32Array(last + 1);
  cost[0] = 0;
  for (let from = 0; from < last; from++) {
    const [fromX, fromY] = [x[from] as number, y[from] as number];
    // The directions that are near enough to all corners passed: from the right to the left one, clockwise. None is excluded at first.
    let [leftX, leftY, rightX, rightY, isBounded] = [0, 0, 0, 0, false];
    // The farthest of them, squared, and their weighted sums of squares: all as seen from here.
    let [farthest, xx, xy, yy] = [0, 0, 0, 0];
    for (let to = from + 1; to <= Math.min(last, from + LONGEST); to++) {
      const [alongX, alongY] = [(x[to] as number) - fromX, (y[to] as number) - fromY];
      const squared = alongX * alongX + alongY * alongY;
      const ahead = (leftX + rightX) * alongX + (leftY + rightY) * alongY;
      const isNear = !isBounded || (rightX * alongY - rightY * alongX >= 0 && alongX * leftY - alongY * leftX >= 0 && ahead > 0);
      if (isNear && squared > 0 && squared >= farthest) {
        const missed = (xx * alongY * alongY - 2 * xy * alongX * alongY + yy * alongX * alongX) / squared;
        const whole = (cost[from] as number) + 1 + FIDELITY * missed;
        if (whole < (cost[to] as number)) [cost[to], before[to]] = [whole, from];
      }
      if (to % 2 === 1) continue;
      const radius = reach[to] as number;
      const weight = 1 / (radius * radius);
      xx += weight * alongX * alongX;
      xy += weight * alongX * alongY;
      yy += weight * alongY * alongY;
      farthest = Math.max(farthest, squared);
      if (squared <= radius * radius) continue;
      // A way that turns back ends here.
      if (isBounded && ahead <= 0) break;
      const tangent = Math.sqrt(squared - radius * radius);
      const [toLeftX, toLeftY] = [alongX * tangent - alongY * radius, alongY * tangent + alongX * radius];
      const [toRightX, toRightY] = [alongX * tangent + alongY * radius, alongY * tangent - alongX * radius];
      if (!isBounded || leftX * toLeftY - leftY * toLeftX < 0) [leftX, leftY] = [toLeftX, toLeftY];
      if (!isBounded || rightX * toRightY - rightY * toRightX > 0) [rightX, rightY] = [toRightX, toRightY];
      isBounded = true;
      if (rightX * leftY - rightY * leftX < 0) break;
    }
  }
  const vertices: number[] = [];
  for (let at = last; at > 0; at = before[at] as number) vertices.push(originX + (x[at] as number) / 2, originY + (y[at] as number) / 2);
  return turned([...vertices, originX, originY]);
}
