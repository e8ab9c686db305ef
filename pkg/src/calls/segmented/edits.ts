// Edits of whole objects: merged, made background, named, locked.

import { isListOf, isObject, isWhole, UNLABELLED, unknownOf } from '../../common/checks.js';
import type { VeroneseError } from '../../common/errors.js';

export interface Edits {
  /** Each object that gets another number, 0 for the background, and that number. */
  numbers: Map<number, number>;
  names: Map<number, string>;
  /** With what is merged into them, which these numbers are of as well. Undefined if not given. */
  named: Uint8Array | undefined;
  locked: Uint8Array | undefined;
}

/** Checks edits; `wrong` makes the error. Which objects there are is known later. `more` may be there as well. */
export function editsOf(value: unknown, wrong: (reason: string) => VeroneseError, more: readonly string[] = []): Edits {
  if (!isObject(value)) throw wrong('must be an object');
  const unknown = unknownOf(value, ['merge', 'delete', 'background', 'names', 'locked', ...more]);
  if (unknown !== undefined) throw wrong(`there is no edit ${unknown}`);
  // Inherited members, such as the methods of a map, were not given.
  const given: Record<string, unknown> = { ...value };
  const { merge = [], names = {}, locked } = given;
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
    const { [name]: objects = [] } = given;
    if (!isListOf(objects, isObjectNumber)) throw wrong(`'${name}' must be a list of objects, ${RANGE}`);
    for (const object of objects) give(object, 0);
  }
  if (!isObject(names)) throw wrong("'names' must be an object of names by number");
  const named = Object.entries(names).filter(([, name]) => name !== undefined);
  for (const [number, name] of named) {
    if (!/^[1-9]\d*$/.test(number) || !isObjectNumber(Number(number)))
      throw wrong(`'names' has a name for '${number}', and objects are ${RANGE}`);
    if (typeof name !== 'string' || name === '') throw wrong(`'names' must have a text for object ${number}`);
  }
  if (locked !== undefined && !isListOf(locked, isObjectNumber)) throw wrong(`'locked' must be a list of objects, ${RANGE}`);
  return {
    numbers,
    names: new Map(named.map(([number, name]) => [Number(number), name as string])),
    named:
      given['names'] === undefined
        ? undefined
        : withMerged(
            named.map(([number]) => Number(number)),
            numbers,
          ),
    locked: locked && withMerged(locked, numbers),
  };
}

/** Some objects, and those that are merged into one of them. */
export function withMerged(objects: readonly number[], numbers: ReadonlyMap<number, number>): Uint8Array {
  const all = new Set(objects);
  for (const [object, number] of numbers) if (all.has(number)) all.add(object);
  return Uint8Array.from(all);
}

export const RANGE = `numbers from 1 to ${UNLABELLED - 1}`;

export function isObjectNumber(value: unknown): value is number {
  return isWhole(value, 1, UNLABELLED - 1);
}

function called(number: number | undefined): string {
  return number === 0 ? 'background' : `object ${number}`;
}
