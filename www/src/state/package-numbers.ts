//! A person's annotations as the package takes them, by its own numbers of objects.

import type { ClipOptions } from '../segmented.js';
import { type Runs, resized, unpacked } from '../correction/runs.js';
import { UNLABELLED, keyOf } from '../result/masks.js';
import { MOST_OBJECTS } from './spans.js';
import { type Click, type Annotation, isPrompt, namesObjects } from './annotation.js';
import type { Range, Version } from './tracked.js';

/** The number that the package has for an object, or will have: one that none has makes a new object. */
export function packageNumber(numbers: ReadonlyMap<number, number>, id: number): number {
  const [known] = [...numbers].find(([, here]) => here === id) ?? [];
  const any = Array.from({ length: MOST_OBJECTS }, (_, k) => k + 1);
  // Above all that are seen there is none that is hidden.
  return known ?? [id, Math.max(...numbers.keys()) + 1, ...any].find((number) => number <= MOST_OBJECTS && !numbers.has(number)) ?? 0;
}

/** The labels with the package's numbers; `numbers` learns new ones. */
export function toSpan(runs: Runs, numbers: Map<number, number>): Uint8Array<ArrayBuffer> {
  const table = new Map<number, number>([0, UNLABELLED].map((label) => [label, label]));
  const labels = runs.labels.map((label) => {
    if (!table.has(label)) table.set(label, learned(numbers, label));
    return table.get(label)!;
  });
  return unpacked({ ...runs, labels });
}

function learned(numbers: Map<number, number>, id: number): number {
  const number = packageNumber(numbers, id);
  if (number !== 0) numbers.set(number, id);
  return number;
}

/** Annotations of frames of a span for the package; `numbers` learns new ones. Where an object is not that it does not know is nothing. */
export function forPackage(annotations: readonly Annotation[], { first }: Range, numbers: Map<number, number>): Required<Pick<ClipOptions, 'corrections' | 'prompts'>> {
  const corrections: NonNullable<ClipOptions['corrections']>[number][] = [];
  const prompts: NonNullable<ClipOptions['prompts']>[number][] = [];
  for (const one of annotations) {
    const isKnown = one.object === 0 || [...numbers.values()].includes(one.object);
    const object = isKnown || isPrompt(one) || namesObjects(one) ? learnedUnlessMap(numbers, one.object) : null;
    if (object === null) continue;
    const common = { frame: one.frame - first, propagate: one.propagate };
    if (isPrompt(one)) prompts.push({ ...common, object, clicks: one.clicks, ...(one.box && { box: one.box }) });
    else corrections.push({ ...common, labels: toSpan(one.labels, numbers), ...(object !== 0 && { object }) });
  }
  return { corrections, prompts };
}

/** The package's number of an object; 0 for a label map, and `null` if there is no number left. */
function learnedUnlessMap(numbers: Map<number, number>, object: number): number | null {
  return object === 0 ? 0 : learned(numbers, object) || null;
}

/** The package's numbers of objects here, which may have been merged. */
export function packageNumbers(numbers: ReadonlyMap<number, number>, became: Version['became'], is: (id: number) => boolean): number[] {
  return [...numbers].filter(([, here]) => is(became.get(here) ?? here)).map(([there]) => there);
}

/** Merged and deleted objects for the package; `numbers` learns under which number here an object goes on. */
export function editsIn(numbers: Map<number, number>, became: ReadonlyMap<number, number>): NonNullable<ClipOptions['edits']> {
  const groups = new Map<number, number[]>();
  for (const [there, here] of [...numbers].sort(([, one], [, other]) => one - other)) {
    const id = became.get(here) ?? here;
    // The one whose number stays is the first.
    const others = groups.get(id) ?? [];
    groups.set(id, here === id ? [there, ...others] : [...others, there]);
  }
  const { 0: gone = [], ...kept } = Object.fromEntries(groups) as Record<number, number[]>;
  for (const [id, [there]] of Object.entries(kept)) numbers.set(there!, Number(id));
  return { merge: Object.values(kept).filter((group) => group.length > 1), delete: gone };
}

/** The names that a person gave to objects, by the package's numbers: other corrections leave them as they are. */
export function namesIn({ names, became }: Pick<Version, 'names' | 'became'>, numbers: ReadonlyMap<number, number>): Record<number, string> {
  return Object.fromEntries([...numbers].flatMap(([there, here]) => {
    const name = names[keyOf('objects', became.get(here) ?? here)];
    return name === undefined ? [] : [[there, name]];
  }));
}

interface Size {
  readonly width: number;
  readonly height: number;
}

/** An annotation of masks of one size, for masks of another. */
export function annotationAtSize(one: Annotation, before: Size, now: Size): Annotation {
  if (!isPrompt(one)) return { ...one, labels: resized(one.labels, now) };
  const [sx, sy] = [now.width / before.width, now.height / before.height];
  const at = (value: number, by: number, side: number): number => Math.min(Math.floor((value + 0.5) * by), side - 1);
  const clicks = one.clicks.map(([x, y, sign]): Click => [at(x, sx, now.width), at(y, sy, now.height), sign]);
  if (one.box === null) return { ...one, clicks };
  const [x, y, width, height] = one.box;
  const [left, top] = [Math.floor(x * sx), Math.floor(y * sy)];
  const [right, bottom] = [Math.min(Math.ceil((x + width) * sx), now.width), Math.min(Math.ceil((y + height) * sy), now.height)];
  return { ...one, clicks, box: [left, top, right - left, bottom - top] };
}
