// Masks with smoothed edges: values that lie between those of two sides belong to the nearer one. The sides are where a value has pixels with
// nothing else around them, and what hangs together with these.

/** Passes in which sides grow into what lies between them: as many pixels as half of a soft edge has. */
const PASSES = 256;
/** Sides that a pixel is compared with. */
const MOST = 3;
/** How far from the line between two sides a value may be, in levels of all channels. */
const SLACK = 12;
const NONE = -1;

export interface Edges {
  /** Values that have a side. */
  sides: Set<number>;
  /** Pixels that are on no side. */
  undecided: Int32Array;
  /** Share of these whose value lies between two sides that are near. */
  between: number;
  /** Share of these that touch another value than their own, the ground aside. */
  crowded: number;
  /** The values, those between as the nearer side. */
  resolved: () => Int32Array;
}

/** `values`: grey levels, or colours as 24 bits. */
export function edgesOf(values: Int32Array, width: number, height: number, ground: number): Edges {
  const grid = new Grid(width, height);
  const isSide = sidesOf(values, grid);
  const sides = new Set<number>();
  let count = 0;
  for (let at = 0; at < values.length; at++) {
    if (!isSide[at]) count++;
    else if (at === 0 || !isSide[at - 1] || values[at] !== values[at - 1]) sides.add(values[at] as number);
  }
  const undecided = new Int32Array(count);
  for (let at = 0, k = 0; at < values.length; at++) if (!isSide[at]) undecided[k++] = at;
  const near = nearSides(values, isSide, undecided, grid);
  const candidates = (k: number) => near.subarray(MOST * k, MOST * k + MOST).filter((value) => value !== NONE);
  let [between, crowded] = [0, 0];
  for (let k = 0; k < count; k++) {
    const at = undecided[k] as number;
    if (isBetween(values[at] as number, candidates(k))) between++;
    const around = grid.around(at);
    if (around.some((other) => values[other] !== values[at] && values[other] !== ground)) crowded++;
  }
  const resolved = () => {
    const all = values.slice();
    for (let k = 0; k < count; k++) {
      const own = values[undecided[k] as number] as number;
      const [first, ...others] = candidates(k);
      if (first === undefined) continue;
      all[undecided[k] as number] = others.reduce((best, side) => (distance(side, own) < distance(best, own) ? side : best), first);
    }
    return all;
  };
  return { sides, undecided, between: between / Math.max(count, 1), crowded: crowded / Math.max(count, 1), resolved };
}

/** The pixels around others. */
class Grid {
  readonly #width: number;
  readonly #height: number;
  readonly #found = new Int32Array(8);

  constructor(width: number, height: number) {
    this.#width = width;
    this.#height = height;
  }

  /** Those inside the picture; valid until the next call. */
  around(at: number): Int32Array {
    const [x, y] = [at % this.#width, Math.floor(at / this.#width)];
    let count = 0;
    for (let row = Math.max(0, y - 1); row <= Math.min(this.#height - 1, y + 1); row++) {
      for (let column = Math.max(0, x - 1); column <= Math.min(this.#width - 1, x + 1); column++) {
        const other = row * this.#width + column;
        if (other !== at) this.#found[count++] = other;
      }
    }
    return this.#found.subarray(0, count);
  }

  /** Whether a pixel and all around it have one value. Most do, in most masks. */
  isEven(values: Int32Array, at: number): boolean {
    const width = this.#width;
    const x = at % width;
    if (x === 0 || x === width - 1 || at < width || at >= values.length - width) return this.around(at).every((other) => values[other] === values[at]);
    for (let row = at - width; row <= at + width; row += width) {
      if (values[row - 1] !== values[at] || values[row] !== values[at] || values[row + 1] !== values[at]) return false;
    }
    return true;
  }
}

/** Pixels with nothing else around them, and what hangs together with these. */
function sidesOf(values: Int32Array, grid: Grid): Uint8Array {
  const isSide = new Uint8Array(values.length);
  const others: number[] = [];
  for (let at = 0; at < values.length; at++) {
    if (grid.isEven(values, at)) isSide[at] = 1;
    else others.push(at);
  }
  const hangs = (at: number) => grid.around(at).some((other) => isSide[other] === 1 && values[other] === values[at]);
  const stack: number[] = [];
  for (const start of others) {
    if (isSide[start] || !hangs(start)) continue;
    isSide[start] = 1;
    stack.push(start);
    for (let at = stack.pop(); at !== undefined; at = stack.pop()) {
      for (const other of grid.around(at)) {
        if (isSide[other] || values[other] !== values[at]) continue;
        isSide[other] = 1;
        stack.push(other);
      }
    }
  }
  return isSide;
}

/** Of each undecided pixel the values of the sides that reach it first. */
function nearSides(values: Int32Array, isSide: Uint8Array, undecided: Int32Array, grid: Grid): Int32Array {
  const near = new Int32Array(MOST * undecided.length).fill(NONE);
  const place = new Int32Array(values.length).fill(NONE);
  for (let k = 0; k < undecided.length; k++) place[undecided[k] as number] = k;
  const add = (k: number, value: number): boolean => {
    for (let slot = MOST * k; slot < MOST * k + MOST; slot++) {
      if (near[slot] === value) return false;
      if (near[slot] !== NONE) continue;
      near[slot] = value;
      return true;
    }
    return false;
  };
  let changed: number[] = [];
  for (let k = 0; k < undecided.length; k++) {
    let grew = false;
    for (const other of grid.around(undecided[k] as number)) if (isSide[other]) grew = add(k, values[other] as number) || grew;
    if (grew) changed.push(k);
  }
  for (let pass = 1; pass < PASSES && changed.length > 0; pass++) {
    const values = changed.map((k) => near.slice(MOST * k, MOST * k + MOST));
    const next = new Set<number>();
    for (const [at, k] of changed.entries()) {
      for (const other of grid.around(undecided[k] as number)) {
        if (isSide[other]) continue;
        const theirs = place[other] as number;
        for (const value of values[at] as Int32Array) if (value !== NONE && add(theirs, value)) next.add(theirs);
      }
    }
    changed = [...next];
  }
  return near;
}

function isBetween(value: number, sides: Int32Array): boolean {
  return sides.some((one) => sides.some((other) => other !== one && distance(one, value) + distance(value, other) <= distance(one, other) + SLACK));
}

function distance(one: number, other: number): number {
  const channel = (shift: number) => Math.abs(((one >> shift) & 255) - ((other >> shift) & 255));
  return channel(16) + channel(8) + channel(0);
}
