//! A project: the work on one clip, or on one pair of frames, without the frames. It is gathered from the state, and put back into it when
//! the same frames are opened again. What was undone in a clip is not part of it.

import { NO_EDITS, asSaved } from '../correction/edits.js';
import { type Kept, keptFrom } from '../state/kept.js';
import { type FramePair, type Subject, keyOfPair, subjectOf, subjectOfClip, timelineOf } from '../state/pair.js';
import type { State } from '../state/state.js';
import { type SolvedPairs, type Tracked, type Version, isComplete, isTracked, lengthOf, savedOf, untracked, versionOf } from '../state/tracked.js';

/** The objects of a clip. */
export interface ProjectClip extends Version, Pick<Tracked, 'range'> {
  /** The frame on screen and the objects that are not ticked, when the project was written. */
  readonly at: number;
  readonly hidden: readonly number[];
  /** The solved pairs, while frames to segment have no masks; `null` if all have. */
  readonly solved: SolvedPairs | null;
}

export interface Project extends Subject, Pick<State, 'settings' | 'classList'> {
  /** A small picture of the frame on screen and its masks, as a `data:` address. */
  readonly thumbnail?: string | undefined;
  /** `null` if the subject is no clip, or is not segmented. */
  readonly clip: ProjectClip | null;
  /** The edited pairs, by their key. */
  readonly pairs: ReadonlyMap<string, Kept>;
}

/** The work on this subject; `null` if nothing was ever done with it. */
export function projectFrom(state: State, of: string, solvedPairs: ReadonlyMap<string, SolvedPairs>): Project | null {
  const { settings, motionsElsewhere, classList } = state;
  const pairs = new Map([...state.kept].filter(([, kept]) => kept.subject.of === of));
  const open = subjectOf(state.pair)?.of === of ? keptFrom(state) : null;
  if (open !== null) pairs.set(...open);
  const tracked = trackedOf(state, of);
  const clip = tracked !== null && (!tracked.clip.sample || tracked.solved > 0 || isTracked(tracked)) ? tracked : null;
  const subject = clip === null ? [...pairs.values()][0]?.subject : subjectOfClip(clip.clip);
  if (subject === undefined) return null;
  return { ...subject, classList, settings: { ...settings, motions: motionsElsewhere ?? settings.motions }, clip: clip && partOf(clip, state, solvedPairs.get(of) ?? null), pairs };
}

function trackedOf({ tracked, keptClips }: State, of: string): Tracked | null {
  return tracked?.clip.fingerprint === of ? tracked : (keptClips.get(of) ?? null);
}

function partOf(tracked: Tracked, { settings, timeline, look }: State, solved: SolvedPairs | null): ProjectClip {
  const { range } = tracked;
  const open = timeline?.clip === tracked.clip ? timeline : null;
  const hidden = open !== null && look.kind === 'objects' ? [...look.hidden] : [];
  const longestSide = Math.min(tracked.longestSide, settings.longestSide); // unknown before the first masks
  // A complete clip can be corrected without its pairs.
  return { ...versionOf(tracked), range, longestSide, at: open?.first ?? 0, hidden, solved: isComplete(tracked) ? null : solved };
}

/** The state in which what the project has counts as saved, unless it has changed since. */
export function withSaved({ edits, pair, kept, tracked, keptClips }: State, { of, clip, pairs }: Project): Partial<State> {
  const savedClip = <T extends Tracked | null>(now: T): T =>
    clip === null || now?.clip.fingerprint !== of ? now : { ...now, saved: savedOf(clip) };
  const savedEdits = <T extends Kept['edits']>(now: T, key: string | null): T => {
    const written = pairs.get(key ?? '');
    return written === undefined ? now : { ...now, saved: asSaved(written.edits).saved };
  };
  return {
    edits: savedEdits(edits, keyOfPair(pair)),
    kept: new Map([...kept].map(([key, one]) => [key, { ...one, edits: savedEdits(one.edits, key) }])),
    tracked: savedClip(tracked),
    keptClips: new Map([...keptClips].map(([fingerprint, one]) => [fingerprint, savedClip(one)])),
  };
}

const NOTHING: Tracked['saved'] = { frames: [], locked: new Set(), accepted: new Set(), names: {}, classes: {}, colours: {} };

/** Whether a person did anything with the clip. */
function hasWork({ past, annotations, exact, became, locked, accepted, names, classes, colours }: Tracked): boolean {
  const counts = [past.length, annotations.length, ...[exact, became, locked, accepted].map(({ size }) => size), ...[names, classes, colours].map((kept) => Object.keys(kept).length)];
  return counts.some((count) => count > 0);
}

/** The state in which nothing that was done with this subject counts as saved. */
export function withoutSaved({ edits, pair, kept, tracked, keptClips }: State, of: string): Partial<State> {
  const { saved } = NO_EDITS;
  const unsavedClip = <T extends Tracked | null>(now: T): T => (now?.clip.fingerprint === of && hasWork(now) ? { ...now, saved: NOTHING } : now);
  return {
    edits: subjectOf(pair)?.of === of ? { ...edits, saved } : edits,
    kept: new Map([...kept].map(([key, one]) => [key, one.subject.of === of ? { ...one, edits: { ...one.edits, saved } } : one])),
    tracked: unsavedClip(tracked),
    keptClips: new Map([...keptClips].map(([fingerprint, one]) => [fingerprint, unsavedClip(one)])),
  };
}

/** The state with the work of the project, which is of this pair or of its clip. */
export function withProject(state: State, { of, settings, classList: saved, clip, pairs }: Project, pair: FramePair): Partial<State> {
  const kept = new Map([...state.kept, ...[...pairs].map(([key, one]) => [key, { ...one, edits: asSaved(one.edits) }] as const)]);
  // The project's classes keep their numbers.
  const classList = [...new Set([...saved, ...state.classList])];
  const common = { settings, motionsElsewhere: null, classList, kept };
  const opened = timelineOf(pair)?.clip;
  if (clip === null || opened === undefined) return common;
  const { tracked, keptClips } = state;
  if (tracked?.clip.fingerprint === of) return { ...common, tracked: continued(tracked, clip) };
  return { ...common, keptClips: new Map(keptClips).set(of, continued(keptClips.get(of) ?? untracked(opened), clip)) };
}

/** Masks of a project that replace others are one more step. */
function continued(before: Tracked, { solved, at: _at, hidden: _hidden, ...clip }: ProjectClip): Tracked {
  const complete = isComplete(clip);
  const begun = (solved?.pairs.size ?? 0) > 0 || clip.frames.some((frame) => frame !== null);
  return {
    ...before,
    ...clip,
    run: complete ? { phase: 'done', cause: 'continued', changed: 0 } : { phase: begun ? 'cancelled' : 'idle' },
    solved: complete ? lengthOf(clip.range) : (solved?.pairs.size ?? 0),
    past: isTracked(before) ? [...before.past, versionOf(before)] : [],
    future: [],
    saved: savedOf(clip),
  };
}
