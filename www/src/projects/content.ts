//! The content of a project's file besides its header, and the checks of it: a file may come from anywhere.

import type { Edits } from '../correction/edits.js';
import type { Runs } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import type { Kept } from '../state/kept.js';
import { type Click, type Annotation, isPrompt, points } from '../state/annotation.js';
import type { SolvedPairs, Span } from '../state/tracked.js';
import type { Project, ProjectClip } from './project.js';
import { type Check, either, isFlag, isFrom, isNumber, isOne, isText, listOf, mapOf, objectOf, optional, orNull } from './schema.js';

type Entries<K, V> = readonly (readonly [K, V])[];

/** A project with lists of entries in place of maps. */
export interface Content extends Pick<Project, 'settings' | 'classList'> {
  readonly clip:
    | (Omit<ProjectClip, 'exact' | 'became' | 'locked' | 'accepted' | 'spans' | 'solved'> & {
        readonly exact: Entries<number, Runs>;
        readonly became: Entries<number, number>;
        readonly locked: readonly number[];
        readonly accepted: readonly number[];
        readonly spans: readonly (Omit<Span, 'numbers'> & { readonly numbers: Entries<number, number> })[];
        readonly solved: { readonly settings: SolvedPairs['settings']; readonly pairs: Entries<number, Blob> } | null;
      })
    | null;
  readonly pairs: Entries<string, Omit<Kept, 'subject' | 'edits'> & { readonly edits: Omit<Edits, 'saved'> }>;
}

/** Whether the value is the content of a project of that many frames. */
export function isContent(value: unknown, frames: number): value is Content {
  if (!isProject(value)) return false;
  const { clip, pairs } = value as Content;
  if (pairs.some(([, { edits, found }]) => edits.done > edits.actions.length || !(found === null || fits(found.packed)))) return false;
  if (clip === null) return true;
  const masks = [...clip.frames.map((frame) => frame?.runs ?? null), ...clip.found, ...clip.annotations.map((one) => ('labels' in one ? one.labels : null)), ...clip.exact.map(([, runs]) => runs)];
  const images = masks.filter((image) => image !== null);
  const inside = [clip.range, ...clip.spans.map(({ range }) => range)].every(({ first, last }) => first <= last && last < frames) && clip.annotations.every((one) => isInside(one, clip.frames[one.frame]?.runs));
  return clip.frames.length === frames && clip.found.length === frames && clip.at < frames && inside && images.every((image) => sameSize(image, images[0]!));
}

/** Whether clicks and box of a prompt are within the masks of its frame. */
function isInside(one: Annotation, masks: Runs | undefined): boolean {
  if (masks === undefined || !isPrompt(one)) return masks !== undefined;
  const { clicks, box } = one;
  const isIn = (x: number, y: number): boolean => x < masks.width && y < masks.height;
  const [left, top, width, height] = box ?? [0, 0, 1, 1];
  return points(one) && clicks.every(([x, y]) => isIn(x, y)) && width > 0 && height > 0 && isIn(left + width - 1, top + height - 1);
}

/** Whether labels and report are of one result. */
function fits({ report, runs }: NonNullable<Kept['found']>['packed']): boolean {
  return sameSize(report, runs) && runs.labels.every((label) => label === UNLABELLED || label < report.motions.length);
}

function sameSize(one: Pick<Runs, 'width' | 'height'>, other: Pick<Runs, 'width' | 'height'>): boolean {
  return one.width === other.width && one.height === other.height;
}

export const isRuns: Check<Runs> = (value): value is Runs => value instanceof Object && 'ends' in value && value.ends instanceof Uint32Array;
const isBlob: Check<Blob> = (value) => value instanceof Blob;

function entryOf(isKey: Check<unknown>, isValue: Check<unknown>): Check<unknown> {
  return (value): value is unknown => Array.isArray(value) && value.length === 2 && isKey(value[0]) && isValue(value[1]);
}

const isSide = isFrom(1);
const isIndex = isFrom(0);
const isMotions = either(isOne('auto'), isFrom(1, 10));
const isSettings = objectOf({ motions: isMotions, quality: isOne('fast', 'best'), markUnknown: isFlag, longestSide: isSide });
const isMatrix = listOf(isNumber, 6);
const isBox = listOf(isNumber, 4);
const isColour = listOf(isFrom(0, 255), 3);

const isObject = objectOf({ id: isFrom(1, 254), pixels: isIndex, bbox: isBox, confidence: isNumber, matrix: orNull(isMatrix) });
const isFrame = objectOf({ runs: isRuns, objects: listOf(isObject), background: orNull(isMatrix) });
const isRange = objectOf({ first: isIndex, last: isIndex });
const isPropagation = isOne('both', 'forward', 'backward', 'none');
const isPainted = objectOf({ frame: isIndex, object: isFrom(0, 254), propagate: isPropagation, labels: isRuns });
const isClick: Check<Click> = (value): value is Click => listOf(isNumber, 3)(value) && isIndex(value[0]) && isIndex(value[1]) && Math.abs(value[2]!) === 1;
const isPrompted = objectOf({ frame: isIndex, object: isFrom(1, 254), propagate: isPropagation, clicks: listOf(isClick), box: orNull(listOf(isIndex, 4)) });
const isClip = objectOf({
  range: isRange,
  longestSide: isSide,
  largest: isFrom(0, 254),
  names: mapOf(isText),
  classes: mapOf(isText),
  colours: mapOf(isColour),
  frames: listOf(orNull(isFrame)),
  found: listOf(orNull(isRuns)),
  annotations: listOf(either(isPainted, isPrompted)),
  exact: listOf(entryOf(isIndex, isRuns)),
  became: listOf(entryOf(isFrom(1, 254), isFrom(0, 254))),
  locked: listOf(isFrom(1, 254)),
  accepted: listOf(isIndex),
  spans: listOf(objectOf({ range: isRange, state: isBlob, numbers: listOf(entryOf(isFrom(1, 254), isFrom(0, 254))) })),
  at: isIndex,
  hidden: listOf(isFrom(1, 254)),
  solved: orNull(objectOf({ settings: isText, pairs: listOf(entryOf(isIndex, isBlob)) })),
});

const isPart = objectOf({ of: isRuns, labels: isFrom(0, 0xffff) });
const isStroke = objectOf({ points: listOf(isNumber), radius: isNumber, filled: optional(isFlag), tool: isOne('brush', 'eraser'), mask: isPart });
const isExact = objectOf({ of: isRuns, labels: isRuns });
const isGrouping = objectOf({ of: isRuns, groups: listOf(isFrom(0, 255)) });
const isAppearance = objectOf({ kind: isOne('groups', 'motions'), id: isFrom(0, 255), mask: isPart });
const isNamed = either(objectOf({ name: isText }), objectOf({ colour: isColour }));
const isEdits = objectOf({
  actions: listOf(either(either(objectOf({ stroke: isStroke }), objectOf({ exact: isExact })), objectOf({ grouping: isGrouping }))),
  done: isIndex,
  appearances: listOf((value): value is unknown => isAppearance(value) && isNamed(value)),
});
const isJunction = objectOf({ labels: listOf(isFrom(0, 15), 2), likelihood: isNumber, border: isIndex });
const isReport = objectOf({
  width: isSide,
  height: isSide,
  motions: listOf(objectOf({ label: isFrom(0, 15), matrix: isMatrix, pixels: isIndex, share: isNumber, residual: isNumber, bbox: isBox, group: isFrom(0, 255) })),
  junctions: listOf(isJunction),
  evidence: objectOf({ candidates: listOf(objectOf({ motions: isSide, score: isNumber })) }),
  unlabelled: isIndex,
  milliseconds: mapOf(isNumber),
  settings: mapOf(either(either(isText, isFlag), isNumber)),
});
const isFound = objectOf({ packed: objectOf({ report: isReport, runs: isRuns }), waited: isNumber });
const isPair = objectOf({ edits: isEdits, found: orNull(isFound), ownMotions: orNull(isMotions), width: isSide, height: isSide });

const isProject = objectOf({ settings: isSettings, classList: listOf(isText), clip: orNull(isClip), pairs: listOf(entryOf(isText, isPair)) });
