// What edits.json has of objects: merges, deletions, names and locks, clicks and boxes. Checked before it goes to the clip.

import type { ClipAnnotation, ClipClick } from '../../types/index.js';
import { isListOf, isObject, isWhole, LONGEST_SIDE, UNLABELLED, unknownOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';

export type Propagation = Exclude<ClipAnnotation['propagate'], 'exact' | undefined>;

/** Makes an error of a reason. */
export type Wrong = (reason: string) => VeroneseError;

/** The edits of edits.json that are about objects, checked. */
export interface Edits {
  merge?: number[][];
  delete?: number[];
  background?: number[];
  names?: Record<number, string>;
  locked?: number[];
}

export interface ObjectEdits {
  /** Each object that gets another number, 0 for the background, and that number. */
  numbers: Map<number, number>;
  names: Map<number, string>;
  /** With what is merged into them. */
  locked: number[];
}

const PROPAGATIONS = ['both', 'forward', 'backward', 'none'];
export const SPREADS = "'both', 'forward', 'backward' or 'none'";
export const RANGE = `numbers from 1 to ${UNLABELLED - 1}`;

/** `more` may be there as well. */
export function editsOf(value: unknown, wrong: Wrong, more: readonly string[] = []): ObjectEdits {
  if (!isObject(value)) throw wrong('must be an object');
  const unknown = unknownOf(value, ['merge', 'delete', 'background', 'names', 'locked', ...more]);
  if (unknown !== undefined) throw wrong(`there is no edit ${unknown}`);
  const { merge = [], names = {}, locked = [] } = value;
  const isMerged = (list: unknown): list is number[] => isListOf(list, isObjectNumber) && list.length >= 2;
  if (!isListOf(merge, isMerged)) throw wrong(`'merge' must be lists of two or more objects, ${RANGE}`);
  const numbers = new Map<number, number>();
  const give = (object: number, number: number) => {
    if (object === number) return;
    if ((numbers.get(object) ?? number) !== number)
      throw wrong(`object ${object} cannot become ${called(numbers.get(object))} and ${called(number)}`);
    numbers.set(object, number);
  };
  for (const [first = 0, ...others] of merge) for (const other of others) give(other, first);
  for (const name of ['delete', 'background']) {
    const { [name]: objects = [] } = value;
    if (!isListOf(objects, isObjectNumber)) throw wrong(`'${name}' must be a list of objects, ${RANGE}`);
    for (const object of objects) give(object, 0);
  }
  if (!isObject(names)) throw wrong("'names' must be an object of names by number");
  for (const [number, name] of Object.entries(names)) {
    if (!/^[1-9]\d*$/.test(number) || !isObjectNumber(Number(number)))
      throw wrong(`'names' has a name for '${number}', and objects are ${RANGE}`);
    if (typeof name !== 'string' || name === '') throw wrong(`'names' must have a text for object ${number}`);
  }
  if (!isListOf(locked, isObjectNumber)) throw wrong(`'locked' must be a list of objects, ${RANGE}`);
  return {
    numbers,
    names: new Map(Object.entries(names).map(([number, name]) => [Number(number), name as string])),
    locked: withMerged(locked, numbers),
  };
}

/** Throws where a locked object is deleted. */
export function checkUnlocked({ locked, numbers }: ObjectEdits): void {
  const object = locked.find((object) => numbers.get(object) === 0);
  if (object !== undefined) throw new VeroneseError('object-locked', `object ${object} is locked: unlock it to change it`);
}

/** Some objects, and those that are merged into one of them. */
export function withMerged(objects: Iterable<number>, numbers: ReadonlyMap<number, number>): number[] {
  const all = new Set(objects);
  for (const [object, number] of numbers) if (all.has(number)) all.add(object);
  return [...all];
}

/** The object of an entry with clicks and a box. Throws where it is not one, or not within the frame. */
export function promptOf(
  { object, clicks = [], box }: Record<string, unknown>,
  { width, height }: { width: number; height: number },
  wrong: Wrong,
): number {
  if (!isObjectNumber(object)) throw wrong(`must have an object, ${RANGE}`);
  if (!isListOf(clicks, isClick))
    throw wrong('must have clicks, a list of [x, y, 1] for what belongs to the object and [x, y, -1] for what does not, in whole numbers');
  if (box !== undefined && !isBox(box)) throw wrong('must have a box, the whole numbers [x, y, width, height]');
  const inside = clicks.filter(([, , sign]) => sign === 1);
  if (!box && inside.length === 0) throw wrong(`must have a box or a click that belongs to object ${object}`);
  const [left, top, columns, rows] = box ?? [0, 0, width, height];
  const stray = inside.find(([x, y]) => x < left || x >= left + columns || y < top || y >= top + rows);
  if (box && stray) throw wrong(`has a click at ${stray[0]}, ${stray[1]} that belongs to object ${object} and is not in its box`);
  const isWithin = left + columns <= width && top + rows <= height && clicks.every(([x, y]) => x < width && y < height);
  if (!isWithin) throw wrong('is not within the frame');
  return object;
}

function isPlaces(value: unknown): value is number[] {
  return isListOf(value, (side): side is number => isWhole(side, 0, LONGEST_SIDE));
}

function isBox(value: unknown): value is [x: number, y: number, width: number, height: number] {
  return isPlaces(value) && value.length === 4 && value.slice(2).every((side) => side > 0);
}

function isClick(value: unknown): value is ClipClick {
  return Array.isArray(value) && value.length === 3 && isPlaces(value.slice(0, 2)) && (value[2] === 1 || value[2] === -1);
}

export function isPropagation(value: unknown): value is Propagation {
  return typeof value === 'string' && PROPAGATIONS.includes(value);
}

export function isObjectNumber(value: unknown): value is number {
  return isWhole(value, 1, UNLABELLED - 1);
}

function called(number: number | undefined): string {
  return number === 0 ? 'background' : `object ${number}`;
}
