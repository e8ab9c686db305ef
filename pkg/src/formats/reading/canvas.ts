// The labels of one frame, on which shapes are drawn. A pixel is in a polygon if its centre is, by the even-odd rule; of shapes that overlap
// the later one is on top. Files may come from anywhere, so the work is bounded: it is counted in borders crossed and pixels filled.

import { invalidInput, UNLABELLED } from '../../common/checks.js';

/** Shapes may cover the whole frame so many times over, and small frames more often. Real ones overlap a few times in some places. */
const LAYERS = 16;
const LEAST = 1_000_000;
/** Farther away than this, pixels, no vertex is meant. */
const FARTHEST = 1e6;

/** A rectangle of whole pixels inside the frame. */
export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export class Canvas {
  readonly width: number;
  readonly height: number;
  /** Row by row; what is not drawn is ground. */
  readonly labels: Uint8Array;
  #left: number;

  constructor(width: number, height: number) {
    this.width = width;
    this.height = height;
    this.labels = new Uint8Array(width * height);
    this.#left = Math.max(LEAST, LAYERS * (width + 1) * (height + 1));
  }

  /** x, y of one vertex after another; (0, 0) is the corner of the first pixel. Throws `invalid-input`, as all methods do. */
  polygon(ring: readonly unknown[], label: number): void {
    if (ring.length < 6 || ring.length % 2 !== 0) throw invalidInput('a polygon must have three vertices or more, x and y each');
    if (!ring.every(isCoordinate)) throw invalidInput(`a polygon has a vertex that is no pair of numbers up to ±${FARTHEST}`);
    // The first pixels behind where the ring crosses the rows of pixel centres: of each row an even number, sorted row by row.
    const stride = this.width + 1;
    let count = 0;
    eachEdge(ring, this.height, (first, last) => {
      this.#spend(last - first + 1);
      count += last - first + 1;
    });
    const crossings = new Uint32Array(count);
    eachEdge(ring, this.height, (first, last, x, y, slope) => {
      for (let row = first; row <= last; row++) {
        const crossing = Math.ceil(x + (row + 0.5 - y) * slope - 0.5);
        crossings[--count] = row * stride + Math.min(Math.max(crossing, 0), this.width);
      }
    });
    crossings.sort();
    for (let k = 0; k < crossings.length; k += 2) {
      const [from, until] = [crossings[k] as number, crossings[k + 1] as number];
      const row = Math.floor(from / stride);
      this.#spend(until - from);
      this.labels.fill(label, from - row, until - row);
    }
  }

  /** The pixels whose centres are in an ellipse, turned by an angle in degrees about its middle. */
  ellipse([x, y, across, down]: readonly [number, number, number, number], label: number, angle = 0): void {
    if (![x, y, angle].every(isCoordinate) || ![across, down].every((radius) => isCoordinate(radius) && radius >= 0)) {
      throw invalidInput(`an ellipse must have a middle and radii, numbers up to ${FARTHEST}`);
    }
    const [cosine, sine] = [Math.cos((angle * Math.PI) / 180), Math.sin((angle * Math.PI) / 180)];
    const reach = Math.max(across, down);
    const [left, right] = [Math.max(0, Math.floor(x - reach)), Math.min(this.width, Math.ceil(x + reach))];
    for (let row = Math.max(0, Math.floor(y - reach)); row < Math.min(this.height, Math.ceil(y + reach)); row++) {
      this.#spend(Math.max(0, right - left));
      for (let column = left; column < right; column++) {
        const [u, v] = [column + 0.5 - x, row + 0.5 - y];
        if (((u * cosine + v * sine) / across) ** 2 + ((v * cosine - u * sine) / down) ** 2 <= 1)
          this.labels[row * this.width + column] = label;
      }
    }
  }

  /** Runs column by column over the whole frame, alternating 0s and 1s. */
  columns(counts: readonly unknown[], label: number): void {
    const { width, height } = this;
    this.#runs(counts, label, width * height, (at) => (at % height) * width + Math.floor(at / height));
  }

  /** Runs row by row over a box. */
  rows(counts: readonly unknown[], { left, top, width, height }: Box, label: number): void {
    this.#runs(counts, label, width * height, (at) => (top + Math.floor(at / width)) * this.width + left + (at % width));
  }

  /** The pixels of the whole frame that are not 0. */
  stamp(pixels: Uint8Array, label: number): void {
    this.#spend(pixels.length);
    for (let at = 0; at < pixels.length; at++) if (pixels[at]) this.labels[at] = label;
  }

  /** The ground inside a box: whether it is of an object there is not known. */
  open([left, top, width, height]: readonly [number, number, number, number]): void {
    this.#spend(width * height);
    for (let y = top; y < top + height; y++) {
      for (let at = y * this.width + left, end = at + width; at < end; at++) if (this.labels[at] === 0) this.labels[at] = UNLABELLED;
    }
  }

  #runs(counts: readonly unknown[], label: number, size: number, pixelOf: (at: number) => number): void {
    if (!counts.every(isCount)) throw invalidInput('run lengths must be whole numbers from 0');
    const sum = counts.reduce((sum, count) => sum + count, 0);
    if (sum !== size) throw invalidInput(`run lengths must be of ${size} pixels, not ${sum}`);
    for (let k = 0, at = 0; k < counts.length; k++) {
      const end = at + (counts[k] as number);
      if (k % 2 === 1) {
        this.#spend(end - at);
        for (; at < end; at++) this.labels[pixelOf(at)] = label;
      }
      at = end;
    }
  }

  #spend(count: number): void {
    this.#left -= count;
    if (this.#left < 0) throw invalidInput('its shapes overlap too often to be masks of objects');
  }
}

function isCount(value: unknown): value is number {
  return Number.isSafeInteger(value) && (value as number) >= 0;
}

function isCoordinate(value: unknown): value is number {
  return typeof value === 'number' && Math.abs(value) <= FARTHEST;
}

/** The first and the last row whose centres an edge passes, and the edge from its upper end: the same line whichever way it is taken. */
type TakeEdge = (first: number, last: number, x: number, y: number, slope: number) => void;

function eachEdge(ring: readonly number[], height: number, take: TakeEdge): void {
  for (let at = 0; at < ring.length; at += 2) {
    const next = (at + 2) % ring.length;
    const [upper, lower] = (ring[at + 1] as number) <= (ring[next + 1] as number) ? [at, next] : [next, at];
    const [x, y, endX, endY] = [ring[upper], ring[upper + 1], ring[lower], ring[lower + 1]] as [number, number, number, number];
    const [first, last] = [Math.max(0, Math.ceil(y - 0.5)), Math.min(height - 1, Math.ceil(endY - 0.5) - 1)];
    if (first <= last) take(first, last, x, y, (endX - x) / (endY - y));
  }
}
