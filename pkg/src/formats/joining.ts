// The parts of a mask in one ring: from the largest part, each of the others hangs on a bridge without width, which is taken there and back,
// where it is nearest to those that are joined already.

/** x, y of one vertex after another, multiples of ½; the last is joined to the first. */
export type Ring = number[];

/** With more corners in all, some of each part are compared: every pair of corners of two parts is, else. */
const MOST_CORNERS = 8_000;
/** With more parts each hangs on the one before it in the list. */
const MOST_PARTS = 4_000;

/** A place on a ring: behind the corner `at`, at the point (x, y) of its edge. */
interface Place {
  at: number;
  x: number;
  y: number;
}

/** The shortest way found so far from a part to those that are joined. */
interface Bridge {
  length: number;
  /** Number of the joined part. */
  to: number;
  there: Place;
  here: Place;
}

/** A part that hangs on another. */
interface Hanging {
  bridge: Bridge;
  part: number;
}

export function joined(parts: readonly Ring[]): Ring {
  if (parts.length < 2) return [...(parts[0] ?? [])];
  const areas = parts.map(areaOf);
  const root = areas.indexOf(Math.max(...areas));
  const bridges = parts.length > MOST_PARTS ? inARow(parts, root) : nearest(parts, root);
  const hanging: Hanging[][] = parts.map(() => []);
  for (const [part, bridge] of bridges) (hanging[bridge.to] as Hanging[]).push({ bridge, part });
  return walked(parts, hanging, root);
}

function areaOf(ring: Ring): number {
  let area = 0;
  for (let at = 0; at < ring.length; at += 2) {
    const next = (at + 2) % ring.length;
    area += (ring[at] as number) * (ring[next + 1] as number) - (ring[next] as number) * (ring[at + 1] as number);
  }
  return Math.abs(area);
}

function corner(ring: Ring, at: number): Place {
  return { at, x: ring[2 * at] as number, y: ring[2 * at + 1] as number };
}

function inARow(parts: readonly Ring[], root: number): Map<number, Bridge> {
  const bridges = new Map<number, Bridge>();
  let before = root;
  for (const [part, ring] of parts.entries()) {
    if (part === root) continue;
    bridges.set(part, { length: 0, to: before, there: corner(parts[before] as Ring, 0), here: corner(ring, 0) });
    before = part;
  }
  return bridges;
}

/** A tree of shortest bridges, as Prim grows it. */
function nearest(parts: readonly Ring[], root: number): Map<number, Bridge> {
  const step = Math.ceil(parts.reduce((sum, { length }) => sum + length / 2, 0) / MOST_CORNERS);
  const best = new Map<number, Bridge>(
    parts.map((_, part) => [
      part,
      { length: Infinity, to: root, there: corner(parts[root] as Ring, 0), here: corner(parts[part] as Ring, 0) },
    ]),
  );
  const bridges = new Map<number, Bridge>();
  const extents = parts.map(extentOf);
  let last = root;
  for (;;) {
    best.delete(last);
    let next: number | undefined;
    for (const [part, bridge] of best) {
      if (gap(extents[last] as Extent, extents[part] as Extent) < bridge.length)
        shorten(bridge, last, parts[last] as Ring, parts[part] as Ring, step);
      if (next === undefined || bridge.length < (best.get(next) as Bridge).length) next = part;
    }
    if (next === undefined) return bridges;
    bridges.set(next, best.get(next) as Bridge);
    last = next;
  }
}

/** Makes a bridge the shortest from a joined part to another one, if that is shorter. */
function shorten(bridge: Bridge, to: number, there: Ring, here: Ring, step: number): void {
  for (let k = 0; k < there.length / 2; k += step) {
    for (let j = 0; j < here.length / 2; j += step) {
      const [onThere, onHere] = [way(there, k, here, j), way(here, j, there, k)];
      if (Math.min(onThere, onHere) >= bridge.length) continue;
      const [far, near] =
        onThere <= onHere ? [nearestPlace(there, k, here, j), corner(here, j)] : [corner(there, k), nearestPlace(here, j, there, k)];
      Object.assign(bridge, { length: Math.min(onThere, onHere), to, there: far, here: near });
    }
  }
}

/** The square of the way from a corner of `other` to the edge behind a corner of `ring`. */
function way(ring: Ring, at: number, other: Ring, end: number): number {
  return (
    (onEdge(ring, at, 0, other, end) - (other[2 * end] as number)) ** 2 +
    (onEdge(ring, at, 1, other, end) - (other[2 * end + 1] as number)) ** 2
  );
}

function nearestPlace(ring: Ring, at: number, other: Ring, end: number): Place {
  return { at, x: onEdge(ring, at, 0, other, end), y: onEdge(ring, at, 1, other, end) };
}

/** A coordinate of the place on the edge behind a corner that is nearest to a corner of `other`: the corner unless the edge is level or upright. */
function onEdge(ring: Ring, at: number, axis: 0 | 1, other: Ring, end: number): number {
  const next = (2 * at + 2) % ring.length;
  const own = ring[2 * at + axis] as number;
  if (ring[2 * at + 1 - axis] !== ring[next + 1 - axis]) return own;
  const far = ring[next + axis] as number;
  const wanted = other[2 * end + axis] as number;
  return own < far ? Math.min(Math.max(wanted, own), far) : Math.min(Math.max(wanted, far), own);
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

/** One ring over all parts. A stack and not recursion: parts may hang on each other by the thousand. */
function walked(parts: readonly Ring[], hanging: readonly Hanging[][], root: number): Ring {
  const ring: Ring = [];
  const stack: { steps: Iterator<Step>; back?: Place }[] = [{ steps: stepsOf(parts, hanging, root) }];
  for (let tour = stack.at(-1); tour !== undefined; tour = stack.at(-1)) {
    const { value, done } = tour.steps.next();
    if (done) {
      stack.pop();
      if (tour.back) ring.push(tour.back.x, tour.back.y);
    } else if ('part' in value) {
      ring.push(value.there.x, value.there.y);
      stack.push({ steps: stepsOf(parts, hanging, value.part, value.here), back: value.there });
    } else {
      ring.push(value.x, value.y);
    }
  }
  return ring;
}

type Step = { x: number; y: number } | { part: number; there: Place; here: Place };

/** The corners of a part from a place on it round to the same place, and between them the parts that hang there. */
function* stepsOf(parts: readonly Ring[], hanging: readonly Hanging[][], part: number, from?: Place): Generator<Step, void, undefined> {
  const ring = parts[part] as Ring;
  const count = ring.length / 2;
  const start = from?.at ?? 0;
  const along = ({ at, x, y }: Place) => Math.abs(x - (ring[2 * at] as number)) + Math.abs(y - (ring[2 * at + 1] as number));
  const own = [...(hanging[part] as Hanging[])].sort((a, b) => along(a.bridge.there) - along(b.bridge.there));
  const byCorner = new Map<number, Hanging[]>();
  for (const one of own) byCorner.set(one.bridge.there.at, [...(byCorner.get(one.bridge.there.at) ?? []), one]);
  const childrenAt = function* (at: number, wanted: (way: number) => boolean): Generator<Step> {
    for (const { bridge, part } of byCorner.get(at) ?? [])
      if (wanted(along(bridge.there))) yield { part, there: bridge.there, here: bridge.here };
  };
  const begin = from ? along(from) : 0;
  if (from) yield from;
  // The edge on which the tour begins is taken in two pieces.
  yield* childrenAt(start, (way) => from !== undefined && way >= begin);
  for (let k = from ? 1 : 0; k < count; k++) {
    const at = (start + k) % count;
    yield corner(ring, at);
    yield* childrenAt(at, () => true);
  }
  if (!from) return;
  yield corner(ring, start);
  yield* childrenAt(start, (way) => way < begin);
  yield from;
}
