// Whether values look as if edges were smoothed, or compressed with loss. Such masks are refused: what the values between mean, nobody knows.

import type { Levels } from '../../../types/formats.js';
import { invalidInput } from '../../common/checks.js';
import type { Size } from '../png-reader.js';

/** With more values that nowhere fill a block it is no mask but a picture. */
const MOST = 4096;
/** Pixels of such values that lie between others count if there is one to so many at clear borders: a tiny object or two are no edge. */
const CLEAR = 4;

/**
 * Throws `invalid-input` where levels or colours lie between others: where most pixels of those that nowhere fill a block of nine touch two other
 * values. Thin objects touch one, the ground.
 */
export function checkCrisp(values: Int32Array, grid: Size, what: 'level' | 'colour', ground = 0): void {
  const filling = new Set([ground]);
  for (let at = 0; at < values.length; at++)
    if (!filling.has(values[at] as number) && around(grid, at, true).every((other) => values[other] === values[at]))
      filling.add(values[at] as number);
  const loose = new Set<number>();
  let [count, between, clear] = [0, 0, 0];
  for (let at = 0; at < values.length && loose.size <= MOST; at++) {
    const value = values[at] as number;
    const fills = filling.has(value);
    // Most pixels are like the ones beside them.
    if (fills && value === values[at - 1] && value === values[at + grid.width]) continue;
    const others = new Set(around(grid, at).map((other) => values[other] as number));
    others.delete(value);
    if (fills) {
      if ([...others].some((other) => filling.has(other))) clear++;
      continue;
    }
    loose.add(value);
    count++;
    if (others.size > 1) between++;
  }
  if (loose.size <= MOST && (2 * between <= count || CLEAR * between <= clear)) return;
  const found = `${loose.size > MOST ? `more than ${MOST}` : loose.size} ${what}${loose.size === 1 ? '' : 's'} only between others`;
  throw invalidInput(
    `it has ${found}, as smoothed edges or lossy compression give: save it without, or say with --levels 128 that those from 128 on are the object, with --levels exact that each is one`,
  );
}

/** Grey levels as labels: those from a level on are object 1 where that is given, else each is a number. Throws as {@link checkCrisp} does. */
export function crispLevels(levels: Uint8Array, grid: Size, meaning: Levels | undefined): Uint8Array {
  if (meaning === undefined) checkCrisp(Int32Array.from(levels), grid, 'level');
  return typeof meaning === 'number' ? levels.map((level) => Number(level >= meaning)) : levels;
}

/** The block of nine pixels around one, without those outside the picture; `whole`: moved into it. */
function around({ width, height }: Size, at: number, whole = false): number[] {
  const start = (place: number, side: number) => Math.max(0, whole ? Math.min(place - 1, side - 3) : place - 1);
  const [x, y] = [at % width, Math.floor(at / width)];
  const [left, top] = [start(x, width), start(y, height)];
  const all: number[] = [];
  for (let row = top; row < Math.min(height, whole ? top + 3 : y + 2); row++)
    for (let column = left; column < Math.min(width, whole ? left + 3 : x + 2); column++) all.push(row * width + column);
  return all;
}
