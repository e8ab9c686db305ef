// One stroke that paints a region as far as a brush fits into it.

import { depths, largest } from './regions.mjs';

/** The points of the stroke, [x, y] in pixels; its brush leaves the region nowhere. Empty if the brush fits nowhere. */
export function strokeIn(region, width, radius) {
  const inside = largest(
    depths(region, width).map((depth) => Number(depth > radius)),
    width,
  ).mask;
  const step = Math.max(1, Math.floor(radius));
  const nodes = new Set();
  inside.forEach((is, p) => {
    if (is && (p % width) % step === 0 && Math.floor(p / width) % step === 0) nodes.add(p);
  });
  const clear = (p, by) => Array.from({ length: step }, (_, k) => inside[p + (k + 1) * by]).every(Boolean);
  const next = (p) => [1, width, -1, -width].filter((by) => nodes.has(p + step * by) && clear(p, by)).map((by) => p + step * by);
  let longest = [];
  while (nodes.size > 0) {
    const walk = walked(nodes, next);
    if (walk.length > longest.length) longest = walk;
  }
  const only = inside.indexOf(1);
  const places = longest.length > 0 || only < 0 ? longest : [only];
  return places.map((p) => [p % width, Math.floor(p / width)]);
}

/** Takes connected nodes out of a set: a way through all of them, which goes back where it came from to reach the next branch. */
function walked(nodes, next) {
  const [start] = nodes;
  nodes.delete(start);
  const [trail, walk] = [[start], [start]];
  let visited = 1;
  while (trail.length > 0) {
    const [to] = next(trail.at(-1));
    if (to !== undefined) {
      nodes.delete(to);
      trail.push(to);
      walk.push(to);
      visited = walk.length;
    } else {
      trail.pop();
      if (trail.length > 0) walk.push(trail.at(-1));
    }
  }
  return walk.slice(0, visited);
}
