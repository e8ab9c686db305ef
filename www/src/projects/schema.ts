//! Checks of values that come from outside, such as the JSON of a file. A check is whether a value is of its kind.

export type Check<T> = (value: unknown) => value is T;

export const isText: Check<string> = (value) => typeof value === 'string';
export const isFlag: Check<boolean> = (value) => typeof value === 'boolean';

/** A whole number from `min` to `max`. */
export function isFrom(min: number, max = Number.MAX_SAFE_INTEGER): Check<number> {
  return (value): value is number => Number.isInteger(value) && Number(value) >= min && Number(value) <= max;
}

export function isOne<const T extends string | number | null>(...values: readonly T[]): Check<T> {
  return (value): value is T => (values as readonly unknown[]).includes(value);
}

export function either<A, B>(one: Check<A>, other: Check<B>): Check<A | B> {
  return (value): value is A | B => one(value) || other(value);
}

/** A value that may be missing. */
export function optional<T>(check: Check<T>): Check<T | undefined> {
  return (value): value is T | undefined => value === undefined || check(value);
}

/** A list; with a length, of this length. */
export function listOf<T>(check: Check<T>, length?: number): Check<readonly T[]> {
  return (value): value is readonly T[] => Array.isArray(value) && (length === undefined || value.length === length) && value.every(check);
}

/** An object with these entries, and perhaps others. */
export function objectOf<T extends object>(checks: { readonly [K in keyof T]: Check<T[K]> }): Check<T> {
  const all = Object.entries(checks) as [string, Check<unknown>][];
  return (value): value is T => isRecord(value) && all.every(([name, check]) => check(value[name]));
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
