//! The content of a project's file besides its header, and the checks of it: a file may come from anywhere.

import type { Runs } from '../correction/runs.js';
import { type Click, type Annotation, isPrompt, points } from '../state/annotation.js';
import type { Range, Version } from '../state/tracked.js';
import type { Project } from './project.js';
import { type Check, either, isFlag, isFrom, isNumber, isOne, isText, listOf, objectOf, optional, orNull, recordOf } from './schema.js';

export type Content = Pick<Project, 'settings' | 'classList' | 'clip'>;

/** Whether the value is the content of a project of that many frames. */
export function isContent(value: unknown, frames: number): value is Content {
  if (!isProject(value)) return false;
  const { clip } = value as Content;
  const { range, past, future, pending } = clip;
  const versions = [{ ...clip, together: pending }, ...past, ...future];
  return isWithin(range, frames) && clip.at < frames && versions.every((version) => isWhole(version, frames));
}

/** Whether the parts of a version fit each other. */
function isWhole({ frames, found, annotations: carried, exact, spans, together = [] }: Version, count: number): boolean {
  const annotations = [...carried, ...together.flatMap((one) => ('annotations' in one ? one.annotations : []))];
  const drawn = together.flatMap((one) => ('drawn' in one ? [...one.drawn] : []));
  if (drawn.some(([index]) => !frames[index])) return false;
  const masks = [...frames.map((frame) => frame?.runs ?? null), ...found, ...annotations.map((one) => ('labels' in one ? one.labels : null)), ...exact.values(), ...drawn.map(([, runs]) => runs)];
  const images = masks.filter((image) => image !== null);
  const inside = spans.every(({ range }) => isWithin(range, count)) && annotations.every((one) => isInside(one, frames[one.frame]?.runs));
  return frames.length === count && found.length === count && inside && images.every((image) => sameSize(image, images[0]!));
}

function isWithin({ first, last }: Range, frames: number): boolean {
  return first <= last && last < frames;
}

/** Whether clicks and box of a prompt are within the masks of its frame. */
function isInside(one: Annotation, masks: Runs | undefined): boolean {
  if (masks === undefined || !isPrompt(one)) return masks !== undefined;
  const { clicks, box } = one;
  const isIn = (x: number, y: number): boolean => x < masks.width && y < masks.height;
  const [left, top, width, height] = box ?? [0, 0, 1, 1];
  return points(one) && clicks.every(([x, y]) => isIn(x, y)) && width > 0 && height > 0 && isIn(left + width - 1, top + height - 1);
}

function sameSize(one: Pick<Runs, 'width' | 'height'>, other: Pick<Runs, 'width' | 'height'>): boolean {
  return one.width === other.width && one.height === other.height;
}

export const isRuns: Check<Runs> = (value): value is Runs => value instanceof Object && 'ends' in value && value.ends instanceof Uint32Array;
const isBlob: Check<Blob> = (value) => value instanceof Blob;

function mapOf(isKey: Check<unknown>, isValue: Check<unknown>): Check<unknown> {
  return (value): value is unknown => value instanceof Map && [...value].every(([key, one]) => isKey(key) && isValue(one));
}

function setOf(isOne: Check<unknown>): Check<unknown> {
  return (value): value is unknown => value instanceof Set && [...value].every(isOne);
}

const isSide = isFrom(1);
const isIndex = isFrom(0);
const isMotions = either(isOne('auto'), isFrom(1, 10));
const isSettings = objectOf({ motions: isMotions, quality: isOne('fast', 'best'), subject: optional(isFlag), markUnknown: isFlag, longestSide: isSide });
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
const NOTES = { names: recordOf(isText), classes: recordOf(isText), colours: recordOf(isColour), locked: setOf(isFrom(1, 254)), accepted: setOf(isFrame) };
const isNumbers = listOf(isFrom(1, 254));
const isCorrection = objectOf({
  annotations: optional(listOf(either(isPainted, isPrompted))),
  edits: optional(objectOf({ merge: optional(listOf(isNumbers)), delete: optional(isNumbers) })),
  drawn: optional(mapOf(isIndex, isRuns)),
  notes: optional(objectOf({ names: optional(NOTES.names), classes: optional(NOTES.classes), colours: optional(NOTES.colours), locked: optional(NOTES.locked), accepted: optional(NOTES.accepted) })),
});
const VERSION = {
  ...NOTES,
  longestSide: isSide,
  largest: isFrom(0, 254),
  together: optional(listOf(isCorrection)),
  frames: listOf(orNull(isFrame)),
  found: listOf(orNull(isRuns)),
  annotations: listOf(either(isPainted, isPrompted)),
  exact: mapOf(isIndex, isRuns),
  became: mapOf(isFrom(1, 254), isFrom(0, 254)),
  spans: listOf(objectOf({ range: isRange, state: isBlob, numbers: mapOf(isFrom(1, 254), isFrom(0, 254)) })),
};
const isClip = objectOf({
  ...VERSION,
  range: isRange,
  past: listOf(objectOf(VERSION)),
  future: listOf(objectOf(VERSION)),
  at: isIndex,
  hidden: listOf(isFrom(1, 254)),
  pending: optional(listOf(isCorrection)),
  solved: orNull(objectOf({ settings: isText, pairs: mapOf(isIndex, isBlob) })),
});

const isProject = objectOf({ settings: isSettings, classList: listOf(isText), clip: isClip });
