//! Parts of a clip that were segmented on their own. The package numbers their objects anew in each run; here an object keeps its
//! number, in other parts and when its frames are segmented again.

import type { ClipOptions } from 'veronese';
import { type Runs, overlapsOf, resized, unpacked } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import { exactly } from './exact.js';
import { type Said, isPrompt, namesObjects, saidAtSize } from './statement.js';
import type { Range, Span, TrackedFrame, Version } from './tracked.js';

/** The largest number of an object. */
export const MOST_OBJECTS = 254;

export function contains({ first, last }: Range, index: number): boolean {
  return first <= index && index <= last;
}

/** The span of which a frame's masks are. */
export function spanAt(spans: readonly Span[], index: number): Span | null {
  return spans.findLast(({ range }) => contains(range, index)) ?? null;
}

/** The number that the package has for an object, or will have: one that none has makes a new object. */
export function theirNumber(numbers: ReadonlyMap<number, number>, id: number): number {
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
  const number = theirNumber(numbers, id);
  if (number !== 0) numbers.set(number, id);
  return number;
}

/** What the package is told of what was said in frames of a span; `numbers` learns new ones. Where an object is not that it does not know is nothing. */
export function toldOf(said: readonly Said[], { first }: Range, numbers: Map<number, number>): Required<Pick<ClipOptions, 'corrections' | 'prompts'>> {
  const corrections: NonNullable<ClipOptions['corrections']>[number][] = [];
  const prompts: NonNullable<ClipOptions['prompts']>[number][] = [];
  for (const one of said) {
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
export function theirNumbers(numbers: ReadonlyMap<number, number>, became: Version['became'], is: (id: number) => boolean): number[] {
  return [...numbers].filter(([, here]) => is(became.get(here) ?? here)).map(([there]) => there);
}

/** The masks with the numbers here. What is not known yet gets a number above `largest`, or is background if there is none. */
export function fromSpan({ runs, objects, background }: TrackedFrame, numbers: Map<number, number>, largest: number): TrackedFrame {
  const table = Uint8Array.from({ length: 256 }, (_, label) => (label === UNLABELLED ? label : 0));
  for (const { id } of objects) {
    if (!numbers.has(id)) {
      const next = Math.max(largest, ...numbers.values()) + 1;
      numbers.set(id, next <= MOST_OBJECTS ? next : 0);
    }
    table[id] = numbers.get(id)!;
  }
  const named = objects.map((object) => ({ ...object, id: table[object.id]! })).filter(({ id }) => id !== 0);
  named.sort((one, other) => one.id - other.id);
  return { runs: { ...runs, labels: runs.labels.map((label) => table[label]!) }, objects: named, background };
}

/**
 * Which object of a new run is which one here, by the pixels that both cover, the largest share first: objects as they were found, then
 * those that a person made. A frame that had no masks is compared with its neighbour outside.
 */
export function numbersOf(run: readonly TrackedFrame[], { first }: Range, { frames, found }: Version): Map<number, number> {
  const [numbers, used] = [new Map<number, number>(), new Set<number>()];
  const match = (before: readonly (Runs | null | undefined)[]): void => {
    const images = run.flatMap(({ runs }, k): (readonly [Runs, Runs])[] => {
      const index = first + k;
      const own = before[index] ?? (k === 0 ? before[index - 1] : null) ?? (k === run.length - 1 ? before[index + 1] : null) ?? null;
      return own === null ? [] : [[own, runs]];
    });
    for (const { was, is } of overlapsOf(images)) {
      if (was === 0 || is === 0 || numbers.has(is) || used.has(was)) continue;
      numbers.set(is, was);
      used.add(was);
    }
  };
  match(found);
  match(frames.map((frame) => frame?.runs));
  return numbers;
}

/** What the package is told of objects that were merged or deleted; `numbers` learns under which number here an object goes on. */
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

/** What became of objects after an edit as well. */
export function becameAfter(
  became: ReadonlyMap<number, number>,
  { merge = [], delete: gone = [] }: NonNullable<ClipOptions['edits']>,
): Map<number, number> {
  const now = new Map(became);
  const become = (id: number, into: number): void => {
    for (const [other, then] of now) if (then === id) now.set(other, into);
    now.set(id, into);
  };
  for (const [into, ...others] of merge) for (const other of others) become(other, into!);
  for (const id of gone) become(id, 0);
  return now;
}

/** What was drawn in frames, at the size of their masks. */
export function atSize(exact: Version['exact'], frames: Version['frames']): Version['exact'] {
  return new Map([...exact].map(([index, runs]) => [index, resized(runs, frames[index]?.runs ?? runs)]));
}

/** The version with the frames of a new run, by whose numbers they are, and without what is no longer seen of spans before. */
export function withRun(version: Version, run: readonly TrackedFrame[], span: Span, longestSide: number): Version {
  const { first, last } = span.range;
  const numbers = new Map(span.numbers);
  const named = run.map((frame) => fromSpan(frame, numbers, version.largest));
  const frames = version.frames.map((frame, index) => named[index - first] ?? frame);
  const found = version.found.map((runs, index) => named[index - first]?.runs ?? runs);
  const said = version.said.map((one) => {
    const [before, now] = [version.frames, frames].map((all) => all[one.frame]?.runs);
    return before && now && before.width !== now.width ? saidAtSize(one, before, now) : one;
  });
  const spans = [...version.spans.filter(({ range }) => range.first < first || range.last > last), { ...span, numbers }];
  return exactly({ ...version, frames, found, said, exact: atSize(version.exact, frames), spans, longestSide, largest: Math.max(version.largest, ...numbers.values()) });
}

