// What a person says of frames, checked.

import { checkAttached, invalidOption, isArrayOf, isListOf, isObject, isWhole, UNLABELLED } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import { taken } from '../taking.js';

/** What is said of a frame. */
export interface Said {
  frame: number;
  labels: Uint8Array;
  /** Of masks that say how wide they are. */
  width?: number | undefined;
  /** `both` if nobody says. */
  propagate?: Propagation | undefined;
}

export const PROPAGATIONS = ['both', 'forward', 'backward', 'none'] as const;
export type Propagation = (typeof PROPAGATIONS)[number];

/** Makes an error about an entry of a list. */
export type Wrong = (reason: string) => VeroneseError;

export function checkedCorrections(corrections: unknown, length: number): Said[] {
  return checkedList('corrections', '{ frame, labels }', corrections, length, ({ labels }, wrong) => ({ labels: bytesOf(labels, 'labels', wrong) }));
}

/** What is said of each frame: a correction goes before the mask of its frame where it says anything. */
export function together(masks: readonly Said[], corrections: readonly Said[]): Said[] {
  const said = new Map(masks.map((mask) => [mask.frame, mask]));
  for (const { frame, labels, propagate } of corrections) {
    const mask = said.get(frame);
    const both = mask ? labels.map((label, p) => (label === UNLABELLED ? (mask.labels[p] as number) : label)) : labels;
    said.set(frame, { frame, labels: both, propagate: propagate ?? mask?.propagate });
  }
  return [...said.values()];
}

/** `read` reads what an entry says; `before` is what an earlier one says of the same frame. */
export function checkedList(
  option: string,
  form: string,
  list: unknown,
  length: number,
  read: (entry: Record<string, unknown>, wrong: Wrong, before: Said | undefined) => Omit<Said, 'frame'>,
): Said[] {
  if (!isListOf(list, isObject)) throw invalidOption(option, `a list of ${form}`, list);
  const said = new Map<number, Said>();
  for (const [at, entry] of list.entries()) {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option '${option}': number ${at} ${reason}`);
    const { frame, rle, propagate } = entry;
    if (!isWhole(frame, 0, length - 1)) throw wrong(`must have a frame from 0 to ${length - 1}`);
    const before = said.get(frame);
    if (before && !(option === 'masks' && rle !== undefined)) throw wrong(`is of frame ${frame}, as one before is`);
    if (propagate !== undefined && !isPropagation(propagate)) throw wrong(`must propagate ${SPREADS}`);
    said.set(frame, { frame, ...read(entry, wrong, before), propagate: propagate ?? before?.propagate });
  }
  return [...said.values()];
}

export const SPREADS = PROPAGATIONS.map((name) => `'${name}'`).join(', ').replace(/, (?=[^,]*$)/, ' or ');

export function isPropagation(value: unknown): value is Propagation {
  return (PROPAGATIONS as readonly unknown[]).includes(value);
}

export function bytesOf(bytes: unknown, name: string, wrong: Wrong): Uint8Array {
  if (!isArrayOf(bytes, 'Uint8Array', 'Uint8ClampedArray')) throw wrong(`must have ${name}, a Uint8Array`);
  checkAttached(`the ${name}`, bytes);
  return taken([bytes], false)[0] as Uint8Array;
}
