// Whether values look as if edges were smoothed, or compressed with loss: there are some that have no inside, only pixels between others.

import { invalidInput, UNLABELLED } from '../../common/checks.js';
import type { Levels } from './frame.js';

/** Share of the pixels without an inside that lie between two others where edges are smoothed. */
const SMOOTH = 0.9;
/** Smoothing gives as many values between, unless one of the sides is white or it goes along most edges. */
const FEW = 3;
/** As many values without an inside may be numbers of objects, where most of their pixels have nothing but ground around them. */
const TOO_MANY = 9;
const CROWDED = 0.5;
/** With more of them it is no mask but a picture. */
const MOST = 4096;

interface Grid {
  width: number;
  height: number;
}

/** What values are: grey levels, or with three channels colours of 24 bits; the background among them, and the largest one. */
interface Kind {
  channels: 1 | 3;
  ground: number;
  white: number;
}

/** Throws `invalid-input` where values look so. The sentence follows what it is about. */
export function checkCrisp(values: Int32Array, grid: Grid, kind: Kind): void {
  const count = smoothedValues(values, grid, kind);
  if (count === 0) return;
  const what = `${count === MOST ? 'more than ' : ''}${count} ${kind.channels === 1 ? 'level' : 'colour'}${count === 1 ? '' : 's'} only between others`;
  throw invalidInput(`has ${what}, as smoothed edges or lossy compression give: save it without, or say with --levels 128 that those from 128 on are the object, with --levels exact that each is one`);
}

/** Grey levels as labels: those from a level on are object 1 where that is said, else each is a number. Throws as {@link checkCrisp} does. */
export function crispLevels(levels: Uint8Array, grid: Grid, said: Levels | undefined): Uint8Array {
  if (said === undefined) checkCrisp(Int32Array.from(levels), grid, { channels: 1, ground: 0, white: UNLABELLED });
  return typeof said === 'number' ? levels.map((level) => Number(level >= said)) : levels;
}

/** The number of values that look so, 0 where nothing does. */
function smoothedValues(values: Int32Array, grid: Grid, { channels, ground, white }: Kind): number {
  const inside = new Set([ground]);
  for (let at = 0; at < values.length; at++) if (!inside.has(values[at] as number) && isInside(values, grid, at)) inside.add(values[at] as number);
  const loose = new Set<number>();
  let [count, between, crowded, crisp] = [0, 0, 0, 0];
  for (let at = 0; at < values.length; at++) {
    const value = values[at] as number;
    const isLoose = !inside.has(value);
    if (!isLoose && value === values[at - 1] && value === values[at + grid.width]) continue;
    if (!isLoose) {
      if (around(grid, at).some((other) => values[other] !== value && inside.has(values[other] as number))) crisp++;
      continue;
    }
    loose.add(value);
    if (loose.size > MOST) return MOST;
    count++;
    const others = around(grid, at).map((other) => values[other] as number).filter((other) => other !== value);
    if (others.some((other) => other !== ground)) crowded++;
    if (isBetween(value, others, channels)) between++;
  }
  const isLined = loose.size >= FEW || inside.has(white) || count >= crisp;
  const isSmooth = count > 0 && between >= SMOOTH * count && isLined;
  return isSmooth || (loose.size >= TOO_MANY && crowded >= CROWDED * count) ? loose.size : 0;
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
    for (let column = Math.max(0, x - 1); column <= Math.min(width - 1, x + 1); column++) if (row * width + column !== at) all.push(row * width + column);
  }
  return all;
}

/** Whether two of the others have the value between them, in each channel. */
function isBetween(value: number, others: readonly number[], channels: 1 | 3): boolean {
  if (channels === 1) return others.some((other) => other < value) && others.some((other) => other > value);
  const channel = (colour: number, shift: number) => (colour >> shift) & 255;
  const lies = (one: number, other: number) => [0, 8, 16].every((shift) => {
    const [own, from, until] = [channel(value, shift), channel(one, shift), channel(other, shift)];
    return own >= Math.min(from, until) && own <= Math.max(from, until);
  });
  return others.some((one, k) => others.slice(k + 1).some((other) => lies(one, other)));
}
