// Rings that hang on each other over bridges without width, walked as one ring; and the parts of a mask, joined like that: from the largest
// part, each of the others hangs where its corners are nearest to those of parts that are joined already.

/** x, y of one vertex after another, multiples of ½; the last is joined to the first. */
export type Ring = number[];

/** The rings that hang at a vertex, as a list: the first, and from each to the next; `start` is a ring's own end of its bridge. */
export interface Hanging {
  first: Map<number, number>;
  next: Int32Array;
  start: Int32Array;
}

/** With more corners in all, some of each part are compared: every pair of corners of two parts is, else. */
const MOST_CORNERS = 8_000;
/** With more parts each hangs on the one before it in the list. */
const MOST_PARTS = 4_000;

const NONE = -1;

/** Of so many rings none hangs yet. */
export function nothingHangs(rings: number): Hanging {
  return { first: new Map(), next: new Int32Array(rings).fill(NONE), start: new Int32Array(rings) };
}

/** Hangs a ring with its vertex `start` at a vertex of another one. */
export function hang({ first, next, start }: Hanging, ring: number, vertex: number, there: number): void {
  start[ring] = vertex;
  next[ring] = first.get(there) ?? NONE;
  first.set(there, ring);
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

/** Gives the vertices of a ring with all that hangs on it. Those of ring r alone are `from[r]` to `from[r + 1]`, exclusive. */
export function walker(from: readonly number[], { first, next, start }: Hanging): (root: number) => Int32Array {
  // Each ring is walked once, and each bridge has two ends to come back over.
  const room = new Int32Array((from.at(-1) as number) + 2 * from.length);
  const tour = (ring: number, start: number): Tour => {
    const begin = from[ring] as number;
    return { start, begin, size: (from[ring + 1] as number) - begin, done: 0, at: start, pending: NONE };
  };
  return (root) => {
    let count = 0;
    let current = tour(root, from[root] as number);
    // A stack and not recursion: rings may hang on rings by the thousand.
    const stack: Tour[] = [];
    for (;;) {
      if (current.pending !== NONE) {
        const ring = current.pending;
        current.pending = next[ring] as number;
        stack.push(current);
        current = tour(ring, start[ring] as number);
      } else if (current.done < current.size) {
        current.at = current.begin + ((current.start - current.begin + current.done++) % current.size);
        current.pending = first.get(current.at) ?? NONE;
        room[count++] = current.at;
      } else {
        const parent = stack.pop();
        if (!parent) return room.slice(0, count);
        // The ring is closed; then back over the bridge.
        room[count++] = current.start;
        room[count++] = parent.at;
        current = parent;
      }
    }
  };
}

/** One ring over all parts. */
export function joined(parts: readonly Ring[]): Ring {
  if (parts.length < 2) return [...(parts[0] ?? [])];
  const from = [0];
  for (const ring of parts) from.push((from.at(-1) as number) + ring.length / 2);
  const corners = parts.flat();
  const areas = parts.map(areaOf);
  const root = areas.indexOf(Math.max(...areas));
  const hanging = nothingHangs(parts.length);
  if (parts.length > MOST_PARTS) {
    const others = [root, ...parts.keys()].filter((part, at) => at === 0 || part !== root);
    others.slice(1).forEach((part, at) => hang(hanging, part, from[part] as number, from[others[at] as number] as number));
  } else hangNearest(hanging, parts, from, corners, root);
  return [...walker(from, hanging)(root)].flatMap((vertex) => corners.slice(2 * vertex, 2 * vertex + 2));
}

function areaOf(ring: Ring): number {
  let area = 0;
  for (let at = 0; at < ring.length; at += 2) {
    const next = (at + 2) % ring.length;
    area += (ring[at] as number) * (ring[next + 1] as number) - (ring[next] as number) * (ring[at + 1] as number);
  }
  return Math.abs(area);
}

/** The shortest way found so far from a part to those that are joined, and its vertices. */
interface Bridge {
  length: number;
  there: number;
  here: number;
}

/** A tree of shortest bridges, as Prim grows it. */
function hangNearest(hanging: Hanging, parts: readonly Ring[], from: readonly number[], corners: Ring, root: number): void {
  const step = Math.ceil(corners.length / 2 / MOST_CORNERS);
  const best = new Map<number, Bridge>(parts.map((_, part) => [part, { length: Infinity, there: 0, here: 0 }]));
  const extents = parts.map(extentOf);
  let last = root;
  for (;;) {
    best.delete(last);
    let next: number | undefined;
    for (const [part, bridge] of best) {
      if (gap(extents[last] as Extent, extents[part] as Extent) < bridge.length) shorten(bridge, last, part);
      if (next === undefined || bridge.length < (best.get(next) as Bridge).length) next = part;
    }
    if (next === undefined) return;
    const { there, here } = best.get(next) as Bridge;
    hang(hanging, next, here, there);
    last = next;
  }

  /** Makes a bridge the shortest from a joined part to another one, if that is shorter. */
  function shorten(bridge: Bridge, joined: number, part: number): void {
    for (let there = from[joined] as number; there < (from[joined + 1] as number); there += step) {
      const [x, y] = [corners[2 * there] as number, corners[2 * there + 1] as number];
      for (let here = from[part] as number; here < (from[part + 1] as number); here += step) {
        const length = (x - (corners[2 * here] as number)) ** 2 + (y - (corners[2 * here + 1] as number)) ** 2;
        if (length < bridge.length) Object.assign(bridge, { length, there, here });
      }
    }
  }
}

/** First and last column and row of a ring. */
type Extent = [left: number, top: number, right: number, bottom: number];

function extentOf(ring: Ring): Extent {
  const extent: Extent = [Infinity, Infinity, -Infinity, -Infinity];
  for (let at = 0; at < ring.length; at += 2) {
    const [x, y] = [ring[at] as number, ring[at + 1] as number];
    extent[0] = Math.min(extent[0], x);
    extent[1] = Math.min(extent[1], y);
    extent[2] = Math.max(extent[2], x);
    extent[3] = Math.max(extent[3], y);
  }
  return extent;
}

/** The square of the way between two extents: no way between what is in them is shorter. */
function gap(one: Extent, other: Extent): number {
  const across = Math.max(0, one[0] - other[2], other[0] - one[2]);
  const down = Math.max(0, one[1] - other[3], other[1] - one[3]);
  return across ** 2 + down ** 2;
}
