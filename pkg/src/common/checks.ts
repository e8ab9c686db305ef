// Checks of arguments before anything is done with them: the same for direct calls, workers and encoders.

import { VeroneseError } from './errors.js';

/** Longest side of a frame, pixels: what the core segments. */
export const LONGEST_SIDE = 4096;

/** Longest side, and most pixels, of a label image: it may be of a frame that is scaled down. */
export const LONGEST_LABEL_SIDE = 16_384;
export const MOST_LABELS = 2 ** 27;

/** Slowest and fastest rate of a clip's frames, per second. */
export const FRAME_RATES = { least: 1e-6, most: 1e6 } as const;

/** The label of pixels that have none. No group has this number either. */
export const UNLABELLED = 255;

export function invalidInput(sentence: string): VeroneseError {
  return new VeroneseError('invalid-input', sentence);
}

/** In the core's words. */
export function invalidOption(name: string, wanted: string, found: unknown): VeroneseError {
  return new VeroneseError('invalid-option', `option '${name}': must be ${wanted}, not ${written(found)}`);
}

function written(value: unknown): string {
  if (typeof value === 'string') return `'${value}'`;
  return value === null || typeof value === 'number' || typeof value === 'boolean' ? String(value) : `a value of type ${typeof value}`;
}

/** Runs what reads the caller's objects: what a getter or a proxy of theirs throws is an error of ours too. */
export function reading<T>(read: () => T): T {
  try {
    return read();
  } catch (cause) {
    throw unreadable(cause);
  }
}

/** An error that was thrown while an argument was read, as an error of ours. */
export function unreadable(cause: unknown): VeroneseError {
  if (cause instanceof VeroneseError) return cause;
  const reason = cause instanceof Error ? cause.message : 'something was thrown';
  return new VeroneseError('invalid-input', `what was given cannot be read: ${reason}`, { cause });
}

export function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

export function isWhole(value: unknown, from: number, to: number): value is number {
  return Number.isInteger(value) && (value as number) >= from && (value as number) <= to;
}

/** Entry by entry: `every` leaves out what a sparse list does not have. */
export function isListOf<T>(value: unknown, fits: (entry: unknown) => entry is T): value is T[] {
  return Array.isArray(value) && Array.from<unknown>(value).every(fits);
}

export function isFrameRate(value: unknown): value is number {
  return typeof value === 'number' && value >= FRAME_RATES.least && value <= FRAME_RATES.most;
}

/** Numbers of which none is below the one before it. */
export function isRising(value: unknown): value is number[] {
  const isFinite = (entry: unknown): entry is number => Number.isFinite(entry);
  return isListOf(value, isFinite) && value.every((entry, k) => k === 0 || entry >= (value[k - 1] as number));
}

/** Names with the same key are one file on some systems. */
export function keyOf(name: string): string {
  return name.normalize('NFC').toLowerCase();
}

export function isNumber(value: unknown): value is number {
  return typeof value === 'number';
}

/** An object of options; `undefined` is one without any. */
export function optionsObject(options: unknown): Record<string, unknown> {
  if (options === undefined) return {};
  if (isObject(options)) return options;
  throw new VeroneseError('invalid-option', 'options must be an object');
}

/** The options that were given, all of them known: a misspelt one is not silently left out. What is `undefined` was not given. */
export function entriesOf(options: unknown, known: readonly string[]): Record<string, unknown> {
  const given = optionsObject(options);
  const unknown = unknownOf(given, known);
  if (unknown !== undefined) throw new VeroneseError('invalid-option', `there is no option ${unknown}`);
  return Object.fromEntries(known.map((name) => [name, given[name]]).filter(([, value]) => value !== undefined));
}

/** The first name that is not known, and those that are. */
export function unknownOf(given: Record<string, unknown>, known: readonly string[]): string | undefined {
  const unknown = Object.keys(given).find((name) => !known.includes(name) && given[name] !== undefined);
  return unknown === undefined ? undefined : `'${unknown}'; there are ${known.join(', ')}`;
}

/** The one property of a typed array that nobody can put another in place of, and that is the same in every realm. */
// oxlint-disable-next-line typescript/unbound-method -- it is called on whatever is to be named
const nameOf = Object.getOwnPropertyDescriptor(Object.getPrototypeOf(Uint8Array.prototype), Symbol.toStringTag)?.get as () =>
  | string
  | undefined;

/** Whether it is a typed array of one of these names; one of another realm (a frame, a test environment) is as good. */
export function isArrayOf(value: unknown, ...names: string[]): value is TypedArray {
  const name = nameOf.call(value);
  return name !== undefined && names.includes(name);
}

export type TypedArray = Uint8Array | Uint8ClampedArray | Float64Array;

/** Throws where the array shows nothing because its buffer was given away, or shrank away under it. */
export function checkAttached(which: string, array: TypedArray): void {
  try {
    Uint8Array.prototype.at.call(array, 0);
  } catch {
    throw invalidInput(`${which}: its buffer was given away or has shrunk`);
  }
}

/** Bytes that can be read now. */
export function checkedBytes(which: string, bytes: unknown): Uint8Array {
  if (!isArrayOf(bytes, 'Uint8Array', 'Uint8ClampedArray')) throw invalidInput(`${which} must be a Uint8Array`);
  checkAttached(which, bytes);
  return bytes as Uint8Array;
}
