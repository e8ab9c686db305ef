//! What a project's file says, besides its header, and the checks of it: a file may come from anywhere.

import type { ClipPropagation } from 'veronese';
import type { Edits } from '../correction/edits.js';
import type { Runs } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import type { Kept } from '../state/kept.js';
import { type SolvedPairs, type Span, type TrackedFrame, rangeOf } from '../state/tracked.js';
import type { Project, ProjectClip } from './project.js';
import { type Check, either, isFlag, isFrom, isNumber, isOne, isText, listOf, mapOf, objectOf, optional, orNull } from './schema.js';

type Entries<K, V> = readonly (readonly [K, V])[];

/** A project with lists of entries in place of maps. */
export interface Content extends Pick<Project, 'settings'>, Partial<Pick<Project, 'classList'>> {
  readonly clip:
    | (Omit<ProjectClip, 'painted' | 'spread' | 'exact' | 'became' | 'locks' | 'accepted' | 'classes' | 'spans' | 'solved'> & {
        readonly painted: Entries<number, Runs>;
        readonly spread?: Entries<number, ClipPropagation>;
        readonly exact?: Entries<number, Runs>;
        readonly became: Entries<number, number>;
        readonly locks?: Entries<number, boolean>;
        readonly accepted?: readonly number[];
        readonly classes?: ProjectClip['classes'];
        readonly spans: readonly (Omit<Span, 'numbers'> & { readonly numbers: Entries<number, number> })[];
        readonly solved: { readonly settings: SolvedPairs['settings']; readonly pairs: Entries<number, Blob> } | null;
      })
    | null;
  readonly pairs: Entries<string, Omit<Kept, 'subject' | 'edits'> & { readonly edits: Omit<Edits, 'saved'> }>;
}

/** Whether the value is what a project of that many frames says. */
export function isContent(value: unknown, frames: number): value is Content {
  if (!isProject(value)) return false;
  const { clip, pairs } = value as Content;
  if (pairs.some(([, { edits, found }]) => edits.done > edits.actions.length || !(found === null || fits(found.packed)))) return false;
  if (clip === null) return true;
  const masks = [...clip.frames.map((frame) => frame?.runs ?? null), ...clip.found, ...[...clip.painted, ...(clip.exact ?? [])].map(([, runs]) => runs)];
  const images = masks.filter((image) => image !== null);
  const inside = [clip.range, ...clip.spans.map(({ range }) => range)].every(({ first, last }) => first <= last && last < frames);
  return clip.frames.length === frames && clip.found.length === frames && clip.at < frames && inside && images.every((image) => sameSize(image, images[0]!));
}

/** The content of a file of version 1 as of this version. Its clips have one state, of all frames that have masks. */
export function upgraded(content: unknown): unknown {
  if (!isOld(content) || content.clip === null) return content;
  const { state, ...clip } = content.clip;
  const range = rangeOf(clip.frames);
  const numbers = Array.from({ length: clip.largest }, (_, k) => [k + 1, k + 1]);
  const spans = state === null || range === null ? [] : [{ range, state, numbers }];
  return { ...content, clip: { ...clip, spans, found: clip.frames.map((frame) => frame?.runs ?? null), became: [] } };
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
const isPainted = listOf(entryOf(isIndex, isRuns));
const isClip = objectOf({
  range: isRange,
  longestSide: isSide,
  largest: isFrom(0, 254),
  names: mapOf(isText),
  classes: optional(mapOf(isText)),
  colours: mapOf(isColour),
  frames: listOf(orNull(isFrame)),
  found: listOf(orNull(isRuns)),
  painted: isPainted,
  spread: optional(listOf(entryOf(isIndex, isOne('forward', 'backward', 'none')))),
  exact: optional(isPainted),
  became: listOf(entryOf(isFrom(1, 254), isFrom(0, 254))),
  locks: optional(listOf(entryOf(isFrom(1, 254), isFlag))),
  accepted: optional(listOf(isIndex)),
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
  junctions: optional(listOf(isJunction)),
  evidence: objectOf({ candidates: listOf(objectOf({ motions: isSide, score: isNumber })) }),
  unlabelled: isIndex,
  milliseconds: mapOf(isNumber),
  settings: mapOf(either(either(isText, isFlag), isNumber)),
});
const isFound = objectOf({ packed: objectOf({ report: isReport, runs: isRuns }), waited: isNumber });
const isPair = objectOf({ edits: isEdits, found: orNull(isFound), ownMotions: orNull(isMotions), width: isSide, height: isSide });

const isProject = objectOf({ settings: isSettings, classList: optional(listOf(isText)), clip: orNull(isClip), pairs: listOf(entryOf(isText, isPair)) });

/** What {@link upgraded} reads of a file of version 1. */
const isOld = objectOf<{ readonly clip: { readonly state: Blob | null; readonly frames: readonly (TrackedFrame | null)[]; readonly largest: number } | null }>({
  clip: orNull(objectOf({ state: orNull(isBlob), frames: listOf(orNull(isFrame)), largest: isFrom(0, 254) })) as Check<never>,
});
