// Masks with smoothed edges: values that lie between those of two sides belong to the nearer one. The sides are where a value has pixels with
// nothing else around them, and what hangs together with these.

/** Passes in which sides grow into what lies between them: as many pixels as half of a soft edge has. */
const PASSES = 64;
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
  const isSide = sidesOf(values, width, height);
  const sides = new Set<number>();
  let count = 0;
  for (let at = 0; at < values.length; at++) {
    if (isSide[at]) sides.add(values[at] as number);
    else count++;
  }
  const undecided = new Int32Array(count);
  for (let at = 0, k = 0; at < values.length; at++) if (!isSide[at]) undecided[k++] = at;
  const near = nearSides(values, isSide, undecided, width, height);
  const candidates = (k: number) => near.subarray(MOST * k, MOST * k + MOST).filter((value) => value !== NONE);
  let [between, crowded] = [0, 0];
  for (let k = 0; k < count; k++) {
    const at = undecided[k] as number;
    if (isBetween(values[at] as number, candidates(k))) between++;
    if (!around(at, width, height, (other) => values[other] === values[at] || values[other] === ground)) crowded++;
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

function sidesOf(values: Int32Array, width: number, height: number): Uint8Array {
  const isSide = new Uint8Array(values.length);
  const stack: number[] = [];
  for (let at = 0; at < values.length; at++) {
    if (!around(at, width, height, (other) => values[other] === values[at])) continue;
    isSide[at] = 1;
    stack.push(at);
  }
  for (let at = stack.pop(); at !== undefined; at = stack.pop()) {
    const [from, value] = [at, values[at]];
    around(from, width, height, (other) => {
      if (!isSide[other] && values[other] === value) {
        isSide[other] = 1;
        stack.push(other);
      }
      return true;
    });
  }
  return isSide;
}

/** Whether all pixels around one, inside the picture, are as wanted. */
function around(at: number, width: number, height: number, isWanted: (other: number) => boolean): boolean {
  const [x, y] = [at % width, Math.floor(at / width)];
  for (let row = Math.max(0, y - 1); row <= Math.min(height - 1, y + 1); row++) {
    for (let column = Math.max(0, x - 1); column <= Math.min(width - 1, x + 1); column++) {
      const other = row * width + column;
      if (other !== at && !isWanted(other)) return false;
    }
  }
  return true;
}

/** Of each undecided pixel the values of the sides that reach it first. */
function nearSides(values: Int32Array, isSide: Uint8Array, undecided: Int32Array, width: number, height: number): Int32Array {
  const near = new Int32Array(MOST * undecided.length).fill(NONE);
  const place = new Int32Array(values.length).fill(NONE);
  undecided.forEach((at, k) => (place[at] = k));
  for (let pass = 0; pass < PASSES; pass++) {
    const before = near.slice();
    let grew = false;
    const add = (k: number, value: number) => {
      for (let slot = MOST * k; slot < MOST * k + MOST; slot++) {
        if (near[slot] === value) return;
        if (near[slot] !== NONE) continue;
        near[slot] = value;
        grew = true;
        return;
      }
    };
    undecided.forEach((at, k) => {
      if (near[MOST * k + MOST - 1] !== NONE) return;
      around(at, width, height, (other) => {
        const theirs = MOST * (place[other] as number);
        if (isSide[other]) add(k, values[other] as number);
        else for (let slot = theirs; slot < theirs + MOST && before[slot] !== NONE; slot++) add(k, before[slot] as number);
        return true;
      });
    });
    if (!grew) break;
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
