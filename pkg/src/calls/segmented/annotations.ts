// Annotations of frames, checked.

import { checkAttached, invalidOption, isArrayOf, isListOf, isObject, isWhole, LONGEST_SIDE, UNLABELLED } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Annotations, Painted, Pointed } from '../messages.js';
import { taken } from '../taking.js';
import { isObjectNumber, RANGE } from './edits.js';
import type { ClipPropagation } from './types.js';

/** Labels painted in a frame. */
export type LabelledFrame = Painted;

/** Clicks and a box that point to an object in a frame. */
export interface Prompt extends Pointed {
  /** The option that it came with. */
  option: 'corrections' | 'prompts';
}

export const PROPAGATIONS = ['both', 'forward', 'backward', 'none'] as const;

/** Makes an error about an entry of a list. */
export type Wrong = (reason: string) => VeroneseError;

export interface FrameAnnotations {
  corrections: LabelledFrame[];
  prompts: Prompt[];
  /** Undefined if not given. */
  accepted: Annotations['accepted'];
}

/** Checks annotations of frames, whose size is not known yet. */
export function checkedAnnotations(
  { corrections: painting = [], prompts: pointing = [], accepted }: { [option in keyof FrameAnnotations]: unknown },
  length: number,
): FrameAnnotations {
  const form = '{ frame, object, clicks, box }';
  const prompts: Prompt[] = [];
  const read = (option: Prompt['option']) => (entry: Record<string, unknown>, wrong: Wrong) => {
    const isPrompt = entry['labels'] === undefined && ['box', 'clicks'].some((name) => entry[name] !== undefined);
    if (option === 'corrections' && !isPrompt) return painted(entry, wrong);
    const { frame, object, ...prompt } = promptOf(entry, wrong);
    if (prompts.some((other) => frame === other.frame && object === other.object))
      throw wrong(`points to object ${object} in frame ${frame}, as one before does`);
    prompts.push({ frame, object, ...prompt, option });
    return undefined;
  };
  const corrections = checkedList('corrections', `{ frame, labels } or ${form}`, painting, length, read('corrections'));
  checkedList('prompts', form, pointing, length, read('prompts'));
  return { corrections, prompts, accepted: accepted === undefined ? undefined : checkedAccepted(accepted, length) };
}

function painted({ labels, object }: Record<string, unknown>, wrong: Wrong): Omit<LabelledFrame, 'frame'> {
  const own = bytesOf(labels, 'labels', wrong);
  if (object === undefined) return { labels: own };
  if (!isObjectNumber(object)) throw wrong(`must have an object, ${RANGE}, or none`);
  if (own.some((label) => label !== 0 && label !== object && label !== UNLABELLED))
    throw wrong(`must have the labels 0, ${object} and ${UNLABELLED}: it is about object ${object} alone`);
  return { labels: own, object };
}

/** Of an entry whose frame and propagation are checked. Without clicks and box it takes back. */
export function promptOf(entry: Record<string, unknown>, wrong: Wrong): Pointed {
  const { frame, propagate, object, clicks = [], box } = entry;
  if (!isObjectNumber(object)) throw wrong(`must have an object, ${RANGE}`);
  if (!isListOf(clicks, isClick))
    throw wrong('must have clicks, a list of [x, y, 1] for what belongs to the object and [x, y, -1] for what does not, in whole numbers');
  if (box !== undefined && !isBox(box)) throw wrong('must have a box, the whole numbers [x, y, width, height]');
  const inside = clicks.filter(([, , sign]) => sign === 1);
  if (!box && clicks.length > 0 && inside.length === 0) throw wrong(`must have a box or a click that belongs to object ${object}`);
  const [left = 0, top = 0, columns = 0, rows = 0] = box ?? [];
  const stray = box && inside.find(([x, y]) => x < left || x >= left + columns || y < top || y >= top + rows);
  if (stray) throw wrong(`has a click at ${stray[0]}, ${stray[1]} that belongs to object ${object} and is not in its box`);
  return {
    frame: frame as number,
    object,
    clicks: clicks.flatMap(([x, y, sign]) => [x, y, sign === 1 ? 1 : 0]),
    box: [...(box ?? [])],
    propagate: propagate as ClipPropagation | undefined,
  };
}

function isPlaces(value: unknown): value is number[] {
  return isListOf(value, (side): side is number => isWhole(side, 0, LONGEST_SIDE));
}

function isBox(value: unknown): value is number[] {
  return isPlaces(value) && value.length === 4 && value.slice(2).every((side) => side > 0);
}

function isClick(value: unknown): value is [x: number, y: number, sign: 1 | -1] {
  return Array.isArray(value) && value.length === 3 && isPlaces(value.slice(0, 2)) && (value[2] === 1 || value[2] === -1);
}

export function isWithin({ clicks, box }: Pointed, { width, height }: { width: number; height: number }): boolean {
  const [x = 0, y = 0, columns = 0, rows = 0] = box;
  return x + columns <= width && y + rows <= height && clicks.every((place, at) => at % 3 === 2 || place < (at % 3 === 0 ? width : height));
}

function checkedAccepted(list: unknown, length: number): NonNullable<FrameAnnotations['accepted']> {
  const isFrame = (entry: unknown): entry is number => typeof entry === 'number';
  const isEntry = (entry: unknown): entry is number | Record<string, unknown> => isFrame(entry) || isObject(entry);
  if (!isListOf(list, isEntry)) throw invalidOption('accepted', 'a list of frames or { frame, labels }', list);
  const entries = list.map((entry) => (isFrame(entry) ? { frame: entry } : entry));
  const frames = new Set<unknown>();
  return entries.map(({ frame, labels }: Record<string, unknown>, at) => {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option 'accepted': number ${at} ${reason}`);
    if (!isWhole(frame, 0, length - 1)) throw wrong(`must have a frame from 0 to ${length - 1}`);
    if (frames.has(frame)) throw wrong(`is frame ${frame}, as one before is`);
    frames.add(frame);
    return { frame, labels: labels === undefined ? undefined : bytesOf(labels, 'labels', wrong) };
  });
}

/** Throws where a locked object is deleted. */
export function checkUnlocked(locked: Uint8Array | undefined, numbers: ReadonlyMap<number, number>): void {
  const object = locked?.find((object) => numbers.get(object) === 0);
  // In the core's words.
  if (object !== undefined) throw new VeroneseError('object-locked', `object ${object} is locked: unlock it to change it`);
}

/** `read` reads the labels of an entry, unless they are kept elsewhere. */
export function checkedList(
  option: string,
  form: string,
  list: unknown,
  length: number,
  read: (entry: Record<string, unknown>, wrong: Wrong) => Omit<LabelledFrame, 'frame'> | undefined,
): LabelledFrame[] {
  if (!isListOf(list, isObject)) throw invalidOption(option, `a list of ${form}`, list);
  const all = new Map<string, LabelledFrame>();
  for (const [at, entry] of list.entries()) {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option '${option}': number ${at} ${reason}`);
    const { frame, object, propagate } = entry;
    if (!isWhole(frame, 0, length - 1)) throw wrong(`must have a frame from 0 to ${length - 1}`);
    const key = option === 'corrections' && typeof object === 'number' ? `${frame} ${object}` : `${frame}`;
    const before = all.get(key);
    if (propagate !== undefined && !isPropagation(propagate)) throw wrong(`must propagate ${SPREADS}`);
    const own = read(entry, wrong);
    if (own === undefined) continue;
    if (before) throw wrong(`is of ${own.object === undefined ? '' : `object ${own.object} in `}frame ${frame}, as one before is`);
    all.set(key, { frame, ...own, propagate });
  }
  return [...all.values()];
}

export const SPREADS = PROPAGATIONS.map((name) => `'${name}'`)
  .join(', ')
  .replace(/, (?=[^,]*$)/, ' or ');

export function isPropagation(value: unknown): value is ClipPropagation {
  return (PROPAGATIONS as readonly unknown[]).includes(value);
}

export function bytesOf(bytes: unknown, name: string, wrong: Wrong): Uint8Array {
  if (!isArrayOf(bytes, 'Uint8Array', 'Uint8ClampedArray')) throw wrong(`must have ${name}, a Uint8Array`);
  checkAttached(`the ${name}`, bytes);
  return taken([bytes], false)[0] as Uint8Array;
}
