// Whether values look as if edges were smoothed, or compressed with loss. Such masks are refused: what the values between mean, nobody knows.

import { invalidInput, UNLABELLED } from '../../common/checks.js';
import type { Levels } from '../../../types/formats.js';

/** Share of the pixels without an inside that touch something else than the background. Objects that are small or thin mostly touch nothing. */
const CROWDED = 0.75;
/** So many values without an inside are more than there are small objects, even where most borders are without them. */
const MANY = 9;
/** With more of them it is no mask but a picture. */
const MOST = 4096;

interface Grid {
  width: number;
  height: number;
}

/** What values are: grey levels or colours; the background among them, and the largest one. */
interface Kind {
  what: 'level' | 'colour';
  ground: number;
  white: number;
}

/** Throws `invalid-input` where values look so. The sentence follows what it is about. */
export function checkCrisp(values: Int32Array, grid: Grid, kind: Kind): void {
  const count = smoothedValues(values, grid, kind);
  if (count === 0) return;
  const found = `${count === MOST ? 'more than ' : ''}${count} ${kind.what}${count === 1 ? '' : 's'} only between others`;
  throw invalidInput(
    `has ${found}, as smoothed edges or lossy compression give: save it without, or say with --levels 128 that those from 128 on are the object, with --levels exact that each is one`,
  );
}

/** Grey levels as labels: those from a level on are object 1 where that is given, else each is a number. Throws as {@link checkCrisp} does. */
export function crispLevels(levels: Uint8Array, grid: Grid, meaning: Levels | undefined): Uint8Array {
  if (meaning === undefined) checkCrisp(Int32Array.from(levels), grid, { what: 'level', ground: 0, white: UNLABELLED });
  return typeof meaning === 'number' ? levels.map((level) => Number(level >= meaning)) : levels;
}

/**
 * The number of values without an inside, nowhere a block of nine pixels, where these look like edges: most of their pixels touch
 * something, and they are many, or beside white, or along most borders. Else 0.
 */
function smoothedValues(values: Int32Array, grid: Grid, { ground, white }: Kind): number {
  const inside = new Set([ground]);
  for (let at = 0; at < values.length; at++)
    if (!inside.has(values[at] as number) && isInside(values, grid, at)) inside.add(values[at] as number);
  const loose = new Set<number>();
  let [count, crowded, crisp] = [0, 0, 0];
  for (let at = 0; at < values.length; at++) {
    const value = values[at] as number;
    const isLoose = !inside.has(value);
    if (!isLoose && value === values[at - 1] && value === values[at + grid.width]) continue;
    const others = around(grid, at)
      .map((other) => values[other] as number)
      .filter((other) => other !== value);
    if (!isLoose) {
      if (others.some((other) => inside.has(other))) crisp++;
      continue;
    }
    loose.add(value);
    if (loose.size > MOST) return MOST;
    count++;
    if (others.some((other) => other !== ground)) crowded++;
  }
  const isEdge = count > 0 && crowded >= CROWDED * count && (loose.size >= MANY || inside.has(white) || count >= crisp);
  return isEdge ? loose.size : 0;
}

/** Whether a pixel is in a block of nine with its value; the picture ends where it ends. */
function isInside(values: Int32Array, { width, height }: Grid, at: number): boolean {
  const [x, y] = [at % width, Math.floor(at / width)];
  const [left, top] = [Math.max(0, Math.min(x, width - 3)), Math.max(0, Math.min(y, height - 3))];
  for (let row = top; row < Math.min(height, top + 3); row++) {
    for (let column = left; column < Math.min(width, left + 3); column++) if (values[row * width + column] !== values[at]) return false;
  }
  return true;
}

function around({ width, height }: Grid, at: number): number[] {
  const [x, y] = [at % width, Math.floor(at / width)];
  const all: number[] = [];
  for (let row = Math.max(0, y - 1); row <= Math.min(height - 1, y + 1); row++) {
    for (let column = Math.max(0, x - 1); column <= Math.min(width - 1, x + 1); column++)
      if (row * width + column !== at) all.push(row * width + column);
  }
  return all;
}
