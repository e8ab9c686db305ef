//! What a project's file says, besides its header, and the checks of it: a file may come from anywhere.

import type { Edits } from '../correction/edits.js';
import type { Runs } from '../correction/runs.js';
import { UNLABELLED } from '../result/masks.js';
import type { Kept } from '../state/kept.js';
import type { SolvedPairs } from '../state/tracked.js';
import type { Project, ProjectClip } from './project.js';
import { type Check, either, isFlag, isFrom, isNumber, isOne, isText, listOf, mapOf, objectOf, orNull } from './schema.js';

type Entries<K, V> = readonly (readonly [K, V])[];

/** A project with lists of entries in place of maps. */
export interface Content extends Pick<Project, 'settings'> {
  readonly clip:
    | (Omit<ProjectClip, 'painted' | 'solved'> & {
        readonly painted: Entries<number, Runs>;
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
  const images = [...clip.frames.flatMap((frame) => (frame === null ? [] : [frame.runs])), ...clip.painted.map(([, runs]) => runs)];
  const { first, last } = clip.range;
  return clip.frames.length === frames && clip.at < frames && first <= last && last < frames && images.every((image) => sameSize(image, images[0]!));
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
const isClip = objectOf({
  range: objectOf({ first: isIndex, last: isIndex }),
  longestSide: isSide,
  largest: isFrom(0, 254),
  names: mapOf(isText),
  colours: mapOf(isColour),
  frames: listOf(orNull(isFrame)),
  painted: listOf(entryOf(isIndex, isRuns)),
  at: isIndex,
  hidden: listOf(isFrom(1, 254)),
  state: orNull(isBlob),
  solved: orNull(objectOf({ settings: isText, pairs: listOf(entryOf(isIndex, isBlob)) })),
});

const isPart = objectOf({ of: isRuns, labels: isFrom(0, 0xffff) });
const isStroke = objectOf({ points: listOf(isNumber), radius: isNumber, tool: isOne('brush', 'eraser'), mask: isPart });
const isGrouping = objectOf({ of: isRuns, groups: listOf(isFrom(0, 255)) });
const isAppearance = objectOf({ kind: isOne('groups', 'motions'), id: isFrom(0, 255), mask: isPart });
const isNamed = either(objectOf({ name: isText }), objectOf({ colour: isColour }));
const isEdits = objectOf({
  actions: listOf(either(objectOf({ stroke: isStroke }), objectOf({ grouping: isGrouping }))),
  done: isIndex,
  appearances: listOf((value): value is unknown => isAppearance(value) && isNamed(value)),
});
const isJunction = objectOf({ labels: listOf(isFrom(0, 15), 2), likelihood: isNumber, border: isIndex });
/** Files of earlier versions have none. */
const isJunctions: Check<unknown> = (value): value is unknown => value === undefined || listOf(isJunction)(value);
const isReport = objectOf({
  width: isSide,
  height: isSide,
  motions: listOf(objectOf({ label: isFrom(0, 15), matrix: isMatrix, pixels: isIndex, share: isNumber, residual: isNumber, bbox: isBox, group: isFrom(0, 255) })),
  junctions: isJunctions,
  evidence: objectOf({ candidates: listOf(objectOf({ motions: isSide, score: isNumber })) }),
  unlabelled: isIndex,
  milliseconds: mapOf(isNumber),
  settings: mapOf(either(either(isText, isFlag), isNumber)),
});
const isFound = objectOf({ packed: objectOf({ report: isReport, runs: isRuns }), waited: isNumber });
const isPair = objectOf({ edits: isEdits, found: orNull(isFound), ownMotions: orNull(isMotions), width: isSide, height: isSide });

const isProject = objectOf({ settings: isSettings, clip: orNull(isClip), pairs: listOf(entryOf(isText, isPair)) });
