// What a person says of frames, checked.

import { checkAttached, invalidOption, isArrayOf, isListOf, isObject, isWhole, LONGEST_SIDE, UNLABELLED } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import { taken } from '../taking.js';
import { isObjectNumber, RANGE } from './edits.js';

/** What is said of a frame. */
export interface Said {
  frame: number;
  labels: Uint8Array;
  /** Of masks that say how wide they are. */
  width?: number | undefined;
  /** `both` if nobody says. */
  propagate?: Propagation | undefined;
}

/** A box, x, y, width and height, or a click, x and y, that points to an object in a frame. */
export interface Prompt extends Omit<Said, 'labels' | 'width'> {
  prompt: readonly number[];
  label: number;
}

export const PROPAGATIONS = ['both', 'forward', 'backward', 'none'] as const;
export type Propagation = (typeof PROPAGATIONS)[number];

/** Makes an error about an entry of a list. */
export type Wrong = (reason: string) => VeroneseError;

export interface Corrections {
  corrections: Said[];
  /** By frame, then by object: in which order they come makes no difference. */
  prompts: Prompt[];
}

export function checkedCorrections(given: unknown, length: number): Corrections {
  const form = '{ frame, labels }, { frame, label, box } or { frame, label, click }';
  const prompts: Prompt[] = [];
  const corrections = checkedList('corrections', form, given, length, ({ labels, ...entry }, wrong) => {
    if (labels === undefined && (entry['box'] !== undefined || entry['click'] !== undefined)) {
      const prompt = promptOf(entry, wrong);
      if (prompts.some(({ frame, label }) => frame === prompt.frame && label === prompt.label)) {
        throw wrong(`points to object ${prompt.label} in frame ${prompt.frame}, as one before does`);
      }
      prompts.push(prompt);
      return undefined;
    }
    return { labels: bytesOf(labels, 'labels', wrong) };
  });
  prompts.sort((one, other) => one.frame - other.frame || one.label - other.label);
  return { corrections, prompts };
}

/** Of an entry whose frame and propagation are checked. */
export function promptOf({ frame, label, box, click, propagate }: Record<string, unknown>, wrong: Wrong): Prompt {
  if (!isObjectNumber(label)) throw wrong(`must have a label, ${RANGE}`);
  if (box !== undefined && click !== undefined) throw wrong('must have a box or a click, not both');
  const [prompt, sides] = box === undefined ? [click, 2] : [box, 4];
  const isPrompt = isListOf(prompt, (side): side is number => isWhole(side, 0, LONGEST_SIDE)) && prompt.length === sides && prompt.slice(2).every((side) => side > 0);
  if (!isPrompt) throw wrong(box === undefined ? 'must have a click, the whole numbers [x, y]' : 'must have a box, the whole numbers [x, y, width, height]');
  return { frame: frame as number, label, prompt: [...prompt], propagate: propagate as Propagation | undefined };
}

export function isWithin({ prompt: [x = 0, y = 0, columns = 1, rows = 1] }: Prompt, { width, height }: { width: number; height: number }): boolean {
  return x + columns <= width && y + rows <= height;
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

/** `read` reads what an entry says, unless it is kept elsewhere; `before` is what an earlier one says of the same frame. */
export function checkedList(
  option: string,
  form: string,
  list: unknown,
  length: number,
  read: (entry: Record<string, unknown>, wrong: Wrong, before: Said | undefined) => Omit<Said, 'frame'> | undefined,
): Said[] {
  if (!isListOf(list, isObject)) throw invalidOption(option, `a list of ${form}`, list);
  const said = new Map<number, Said>();
  for (const [at, entry] of list.entries()) {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option '${option}': number ${at} ${reason}`);
    const { frame, propagate } = entry;
    if (!isWhole(frame, 0, length - 1)) throw wrong(`must have a frame from 0 to ${length - 1}`);
    const before = said.get(frame);
    if (propagate !== undefined && !isPropagation(propagate)) throw wrong(`must propagate ${SPREADS}`);
    const own = read(entry, wrong, before);
    if (own === undefined) continue;
    if (before && !(option === 'masks' && entry['rle'] !== undefined)) throw wrong(`is of frame ${frame}, as one before is`);
    said.set(frame, { frame, ...own, propagate: propagate ?? before?.propagate });
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
