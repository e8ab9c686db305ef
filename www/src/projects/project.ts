//! A project: the work on one clip, without the frames. It is gathered from the state, and put back into it when the same frames are opened
//! again.

import { type FramePair, timelineOf } from '../state/pair.js';
import { DEFAULT_SETTINGS } from '../state/settings.js';
import type { State } from '../state/state.js';
import { isPrompt } from '../state/annotation.js';
import { type Pending, type SolvedPairs, type Tracked, type TrackedFrame, type Version, isComplete, isTracked, lengthOf, savedOf, untracked, versionOf } from '../state/tracked.js';

/** The objects of a clip. */
export interface ProjectClip extends Version, Pick<Tracked, 'range' | 'past' | 'future'> {
  /** The frame on screen and the objects that are not ticked, when the project was written. */
  readonly at: number;
  readonly hidden: readonly number[];
  /** The solved pairs, while frames to segment have no masks; `null` if all have. */
  readonly solved: SolvedPairs | null;
  /** What was said and is not carried through the clip yet: it is carried when the clip is opened. */
  readonly pending?: Pending['corrections'] | undefined;
}

export interface Project extends Pick<State, 'settings' | 'classList'> {
  /** The clip: its fingerprint, its name, the number of its frames, and the sample that it is, if it is one. */
  readonly of: string;
  readonly name: string;
  readonly frames: number;
  readonly sample?: string;
  /** A small picture of the frame on screen and its masks, as a `data:` address. */
  readonly thumbnail?: string | undefined;
  readonly clip: ProjectClip;
}

/** The work on this clip; `null` if nothing was ever done with it. */
export function projectFrom(state: State, of: string, solvedPairs: ReadonlyMap<string, SolvedPairs>): Project | null {
  const { settings, classList } = state;
  const tracked = trackedOf(state, of);
  if (tracked === null || (tracked.clip.sample && tracked.solved === 0 && !isTracked(tracked))) return null;
  const { name, count, sample } = tracked.clip;
  return { of, name, frames: count, ...(sample && { sample: sample.id }), classList, settings, clip: partOf(tracked, state, solvedPairs.get(of) ?? null) };
}

function trackedOf({ tracked, keptClips }: State, of: string): Tracked | null {
  return tracked?.clip.fingerprint === of ? tracked : (keptClips.get(of) ?? null);
}

function partOf(tracked: Tracked, { settings, timeline, look }: State, solved: SolvedPairs | null): ProjectClip {
  const { range } = tracked;
  const open = timeline?.clip === tracked.clip ? timeline : null;
  const hidden = open !== null && look.kind === 'objects' ? [...look.hidden] : [];
  const longestSide = Math.min(tracked.longestSide, settings.longestSide); // unknown before the first masks
  const { settled = tracked, corrections: pending } = tracked.pending ?? {};
  // A complete clip can be corrected without its pairs.
  return { ...versionOf(settled), ...stepsOf(tracked), pending, range, longestSide, at: open?.first ?? 0, hidden, solved: isComplete(tracked) ? null : solved };
}

/** A version without what was accepted of earlier ones. */
function stepOf(version: Version): Version {
  return { ...versionOf(version), together: version.together, accepted: new Set(version.frames.filter((frame) => frame !== null && version.accepted.has(frame)) as TrackedFrame[]) };
}

/** As many steps of undo and redo are kept as have parts of so many bytes, the nearest first. */
const MOST_OF_STEPS = 5e6;

function stepsOf(tracked: Tracked): Pick<Tracked, 'past' | 'future'> {
  const counted = new Set<object>(partsOf(tracked).keys());
  let room = MOST_OF_STEPS;
  const fits = (version: Version): boolean => {
    for (const [part, bytes] of partsOf(version)) if (!counted.has(part) && counted.add(part)) room -= bytes;
    return room >= 0;
  };
  const nearest = (versions: readonly Version[]): Version[] => versions.slice(versions.findLastIndex((version) => !fits(version)) + 1).map(stepOf);
  return { past: nearest(tracked.past), future: nearest(tracked.future) };
}

/** What a version shares with others, and about how many bytes it takes. */
function partsOf({ frames, found, annotations, exact, spans }: Version): Map<object, number> {
  const images = [...frames.map((frame) => frame?.runs), ...found, ...annotations.map((one) => (isPrompt(one) ? null : one.labels)), ...exact.values()];
  const runs = images.flatMap((image) => (image ? [[image, image.ends.byteLength + image.labels.byteLength] as const] : []));
  return new Map<object, number>([...runs, ...spans.map(({ state }) => [state, state.size] as const)]);
}

/** The state with this clip, wherever it is, changed by `change`. */
function withClip({ tracked, keptClips }: State, of: string, change: (clip: Tracked) => Tracked): Pick<State, 'tracked' | 'keptClips'> {
  const changed = <T extends Tracked | null>(now: T): T => (now?.clip.fingerprint === of ? (change(now) as T) : now);
  return { tracked: changed(tracked), keptClips: new Map([...keptClips].map(([fingerprint, one]) => [fingerprint, changed(one)])) };
}

/** The state in which what the project has counts as saved, unless it has changed since. */
export function withSaved(state: State, { of, clip }: Project): Partial<State> {
  return withClip(state, of, (now) => ({ ...now, saved: savedOf({ ...clip, corrections: clip.pending }) }));
}

const NOTHING: Tracked['saved'] = { frames: [], locked: new Set(), accepted: new Set(), names: {}, classes: {}, colours: {} };

/** Whether a person did anything with the clip. */
function hasWork({ past, annotations, exact, became, locked, accepted, names, classes, colours }: Tracked): boolean {
  const counts = [past.length, annotations.length, ...[exact, became, locked, accepted].map(({ size }) => size), ...[names, classes, colours].map((kept) => Object.keys(kept).length)];
  return counts.some((count) => count > 0);
}

/** The state in which nothing that was done with this clip counts as saved. */
export function withoutSaved(state: State, of: string): Partial<State> {
  return withClip(state, of, (now) => (hasWork(now) ? { ...now, saved: NOTHING } : now));
}

/** The state with the work of the project, which is of the clip of this pair. */
export function withProject(state: State, { of, settings, classList: saved, clip }: Project, pair: FramePair): Partial<State> {
  // The project's classes keep their numbers.
  const common = { settings: { ...DEFAULT_SETTINGS, ...settings }, classList: [...new Set([...saved, ...state.classList])] };
  const opened = timelineOf(pair)?.clip;
  if (opened === undefined) return common;
  const { tracked, keptClips } = state;
  if (tracked?.clip.fingerprint === of) return { ...common, tracked: continued(tracked, clip) };
  return { ...common, keptClips: new Map(keptClips).set(of, continued(keptClips.get(of) ?? untracked(opened), clip)) };
}

/** Masks of a project that replace others are one more step. */
function continued(before: Tracked, { solved, at: _at, hidden: _hidden, pending: corrections, ...clip }: ProjectClip): Tracked {
  const complete = isComplete(clip);
  const begun = (solved?.pairs.size ?? 0) > 0 || clip.frames.some((frame) => frame !== null);
  return {
    ...before,
    ...clip,
    run: complete ? { phase: 'done', cause: 'continued', changed: 0 } : { phase: begun ? 'cancelled' : 'idle' },
    solved: complete ? lengthOf(clip.range) : (solved?.pairs.size ?? 0),
    ...(isTracked(before) ? { past: [...before.past, versionOf(before)], future: [] } : {}),
    pending: corrections === undefined ? null : { settled: versionOf(clip), corrections },
    saved: savedOf({ ...clip, corrections }),
  };
}
