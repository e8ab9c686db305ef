//! The objects of a whole clip: how far their segmentation is, the masks of each frame, and a person's annotations.

import type { ClipFrame, Note } from 'veronese';
import type { ClipOptions, ClipProgress } from '../segmented.js';
import type { Clip } from '../clips/clip.js';
import { type Runs, differingPixels } from '../correction/runs.js';
import type { Colour } from '../drawing/palette.js';
import type { Annotation } from './annotation.js';

/** Frames from one index to another, both included. */
export interface Range {
  readonly first: number;
  readonly last: number;
}

/** One frame of a clip, segmented. */
export interface TrackedFrame extends Pick<ClipFrame, 'objects' | 'background'> {
  /** Its labels: 0 is the background, 255 unlabelled, another number an object. */
  readonly runs: Runs;
}

type ChangeCause = 'corrected' | 'undone' | 'redone';

/** The run on the clip as a whole. */
export type ClipRun =
  | { readonly phase: 'idle' | 'cancelled' | 'failed' }
  /** `changed`: number of frames whose masks are others than before. `kept`: of accepted ones that a correction came to and left as they are. `notes`: why nothing was found, or what is likely to be wrong. */
  | { readonly phase: 'done'; readonly cause: 'found' | 'same' | 'repeated' | 'continued' | 'locked' | 'unlocked' | 'accepted' | 'described' | ChangeCause; readonly changed: number; readonly kept?: number; readonly notes?: readonly Note[] }
  | {
      readonly phase: 'working';
      readonly stage: ClipProgress['stage'];
      /** Time left until all masks are there, seconds; `null` until it is known. */
      readonly left: number | null;
      /** Number of frames that are labelled, or that a correction has come through, and of those that it may reach. */
      readonly labelled: number;
      readonly of?: number;
    };

/** The solved pairs of each frame, for a run that goes on. The bytes are in blobs, which browsers can move to disk. */
export interface SolvedPairs {
  /** The settings they were solved with, as text. */
  readonly settings: string;
  /** By index of the frame. */
  readonly pairs: Map<number, Blob>;
}

/** Frames that were segmented together. */
export interface Span {
  readonly range: Range;
  /** The package's state of these frames, in a blob, which browsers can move to disk. */
  readonly state: Blob;
  /** The numbers of their objects here by those of the package, which counts anew in each run. */
  readonly numbers: ReadonlyMap<number, number>;
}

/** The masks of all frames and what they follow from: one step of undo and redo. Frames that do not change are shared between steps. */
export interface Version {
  /** By index; `null` for frames without masks. */
  readonly frames: readonly (TrackedFrame | null)[];
  /** The package's states of these frames. Where spans overlap, the masks are of the last. There are none until the first masks are complete. */
  readonly spans: readonly Span[];
  /** Longer side of the frames as they were segmented, pixels. */
  readonly longestSide: number;
  /** The masks before corrections, by index: they tell which object of another run is which. */
  readonly found: readonly (Runs | null)[];
  /** The annotations of objects in frames, in the order in which they were given. */
  readonly annotations: readonly Annotation[];
  /** Labels drawn exactly in frames, by index: their masks have them, whatever else is annotated; 255 where nothing was drawn. */
  readonly exact: ReadonlyMap<number, Runs>;
  /** The fate of objects that were merged or deleted: the number of another object, or 0. */
  readonly became: ReadonlyMap<number, number>;
  /** The objects that nothing changes until a person unlocks them. */
  readonly locked: ReadonlySet<number>;
  /** The masks that a person has accepted. Masks that change are others, and are not. */
  readonly accepted: ReadonlySet<TrackedFrame>;
  /** Names, classes and colours that a person gave to objects, by `keyOf`. */
  readonly names: Readonly<Record<string, string>>;
  readonly classes: Readonly<Record<string, string>>;
  readonly colours: Readonly<Record<string, Colour>>;
  /** The largest number that an object ever had. Numbers are not used again. */
  readonly largest: number;
  /** Of an earlier version: what was said of it and carried together, without the last; undoing that one carries these. */
  readonly together?: readonly Correction[] | undefined;
}

/** An annotation: of objects in frames, of whole objects, pixels drawn exactly, or notes, which change no masks. */
export type Correction = (Annotated | { readonly edits: NonNullable<ClipOptions['edits']> } | Drawn | Noted) & Partial<Noted>;

export interface Annotated {
  readonly annotations: readonly Annotation[];
}

/** Labels drawn exactly in frames, by index. */
export interface Drawn {
  readonly drawn: ReadonlyMap<number, Runs>;
}

/** Notes in the place of those before: they change no masks. */
export interface Noted {
  readonly notes: Partial<Notes>;
}

/** What was said and has not been carried through the clip as a whole, in its order, and the masks before it. */
export interface Pending {
  readonly settled: Version;
  readonly corrections: readonly Correction[];
}

/** The parts of a version that change no masks. */
export type Notes = Pick<Version, 'locked' | 'accepted' | 'names' | 'classes' | 'colours'>;

export interface Tracked extends Version {
  readonly clip: Clip;
  readonly run: ClipRun;
  /** While corrections are carried: the masks are those before these, as far as these have changed them. `null` if there are none. */
  readonly pending: Pending | null;
  /** The frames to segment, from the in point to the out point. */
  readonly range: Range;
  /**
   * What is shown while the first masks are being found, by index: drafts, and the masks that take their place. Drafts are no work of anyone,
   * and go when a run ends.
   */
  readonly previews: Version['frames'];
  /** Number of frames whose pairs are solved, nearly all the work. They are kept when a run is cancelled. */
  readonly solved: number;
  /** Earlier versions, and later ones that were undone; the nearest is last. */
  readonly past: readonly Version[];
  readonly future: readonly Version[];
  /** The frames at which a person looked because an object is least certain there, by its number. */
  readonly checked: ReadonlyMap<number, number>;
  /** The last masks that were exported, kept as a project, or found by themselves. */
  readonly saved: Saved;
}

type Saved = Notes & Pick<Version, 'frames'> & { readonly corrections?: Pending['corrections'] | undefined };

const NO_NOTES: Notes = { locked: new Set(), accepted: new Set(), names: {}, classes: {}, colours: {} };

export function untracked(clip: Clip): Tracked {
  const frames = Array.from({ length: clip.count }, () => null);
  return {
    clip,
    run: { phase: 'idle' },
    pending: null,
    range: { first: 0, last: clip.count - 1 },
    previews: frames,
    solved: 0,
    frames,
    spans: [],
    longestSide: Infinity,
    found: frames,
    annotations: [],
    exact: new Map(),
    became: new Map(),
    ...NO_NOTES,
    largest: 0,
    past: [],
    future: [],
    checked: new Map(),
    saved: { frames, ...NO_NOTES },
  };
}

export function versionOf({ frames, spans, longestSide, found, annotations, exact, became, largest, ...others }: Version): Version {
  return { frames, spans, longestSide, found, annotations, exact, became, largest, ...notesOf(others) };
}

export function notesOf({ locked, accepted, names, classes, colours }: Notes): Notes {
  return { locked, accepted, names, classes, colours };
}

/** The record of a clip that is kept or exported as it is. */
export function savedOf({ frames, corrections, ...others }: Saved): Saved {
  return { frames, corrections, ...notesOf(others) };
}

/** The frames that a person corrected, by index, and of which objects. A frame may be there several times. */
export function correctedIn({ annotations, exact }: Pick<Version, 'annotations' | 'exact'>): (readonly [number, readonly number[]])[] {
  const ofObjects = annotations.map((one) => [one.frame, one.object === 0 && 'labels' in one ? [...one.labels.labels] : [one.object]] as const);
  return [...ofObjects, ...[...exact].map(([index, { labels }]) => [index, [...labels]] as const)];
}

/** A version with the frames of one before where their labels are the same, so that they are not others. */
export function unchanged<V extends Pick<Version, 'frames'>>(before: Pick<Version, 'frames'>, now: V): V {
  const isSame = (one: ArrayLike<number>, other: ArrayLike<number>): boolean => one.length === other.length && Array.prototype.every.call(one, (value, k) => value === other[k]);
  const frames = now.frames.map((frame, index) => {
    const [was, is] = [before.frames[index]?.runs, frame?.runs];
    return was && is && isSame(was.ends, is.ends) && isSame(was.labels, is.labels) ? before.frames[index]! : frame;
  });
  const isAll = (all: Version['frames']): boolean => frames.every((frame, index) => frame === all[index]);
  return isAll(now.frames) ? now : { ...now, frames: isAll(before.frames) ? before.frames : frames };
}

/** Whether leaving would lose what a person did. */
export function isUnsavedClip({ saved, past, future, pending, ...others }: Tracked): boolean {
  const settled = pending?.settled ?? others;
  // An undone step is a correction as well: the next visit would have it still.
  const corrected = past.length > 0 || future.length > 0;
  const noted = (Object.keys(NO_NOTES) as (keyof Notes)[]).some((part) => settled[part] !== saved[part]);
  return noted || pending?.corrections !== saved.corrections || (settled.frames !== saved.frames && corrected);
}

/** Whether a correction is being carried through the clip. */
export function isCorrecting(run: ClipRun): boolean {
  return run.phase === 'working' && run.stage === 'corrections';
}

/** One object through a clip. */
export interface Life {
  readonly id: number;
  /** Indices of the first and the last frame that show it. */
  readonly first: number;
  readonly last: number;
  /** The frame that lost it, at confidence 0, or else the one that shows it with the lowest confidence, 0 to 1. */
  readonly doubtful: { readonly index: number; readonly confidence: number };
}

/** All objects of a clip by number. */
export function livesOf({ frames }: Pick<Tracked, 'frames'>): Life[] {
  const lives = new Map<number, Life>();
  frames.forEach((frame, index) => {
    for (const { id, confidence } of frame?.objects ?? []) {
      const { first = index, doubtful } = lives.get(id) ?? {};
      const least = doubtful === undefined || confidence < doubtful.confidence ? { index, confidence } : doubtful;
      lives.set(id, { id, first, last: index, doubtful: least });
    }
  });
  frames.forEach((_, index) => {
    for (const id of lostIn(frames, index)) {
      const life = lives.get(id)!;
      if (life.doubtful.confidence > 0) lives.set(id, { ...life, doubtful: { index, confidence: 0 } });
    }
  });
  return [...lives.values()].sort((one, other) => one.id - other.id);
}

/** The objects that a frame does not show although the one before or after it shows them clear of its border: they cannot have left in between. */
function lostIn(frames: Tracked['frames'], index: number): number[] {
  const frame = frames[index];
  if (frame == null) return [];
  const clear = [frames[index - 1], frames[index + 1]].flatMap((beside) => (beside == null ? [] : beside.objects.filter(({ bbox: [x, y, width, height] }) =>
    Math.min(x, y, beside.runs.width - x - width, beside.runs.height - y - height) > 0)));
  return clear.map(({ id }) => id).filter((id) => frame.objects.every((object) => object.id !== id));
}

/** The frames whose masks a person has accepted, by index. */
export function acceptedIn({ frames, accepted }: Pick<Version, 'frames' | 'accepted'>): number[] {
  return [...frames.keys()].filter((index) => frames[index] != null && accepted.has(frames[index]));
}

/**
 * The frame that most needs a look: of those with masks that are not accepted, one that lost an object, or with the least certain one, and of
 * several the next after frame `from`; `null` if none is left.
 */
export function toReview({ frames, accepted }: Pick<Version, 'frames' | 'accepted'>, from: number): number | null {
  const left = [...frames.keys()].filter((index) => frames[index] != null && !accepted.has(frames[index]));
  const certainty = (index: number): number =>
    Math.min(lostIn(frames, index).length > 0 ? 0 : 1, ...(frames[index]?.objects ?? []).map(({ confidence }) => confidence));
  const ahead = (index: number): number => (index - from - 1 + frames.length) % frames.length;
  const [first] = left.toSorted((one, other) => certainty(one) - certainty(other) || ahead(one) - ahead(other));
  return first ?? null;
}

/** The frames whose masks are others than before the last change of masks, by index, with how they were. Those that are accepted are done with. */
export function changedIn({ frames, past, accepted }: Pick<Tracked, 'frames' | 'past' | 'accepted'>): Map<number, TrackedFrame> {
  const before = past.findLast((version) => version.frames !== frames)?.frames ?? frames;
  return new Map(frames.flatMap((frame, index) => (frame === null || before[index] == null || frame === before[index] || accepted.has(frame) ? [] : [[index, before[index]] as const])));
}

/** These frames, those first of which most pixels have changed. */
export function largestChanges(tracked: Tracked): number[] {
  const sizes = new Map([...changedIn(tracked)].map(([index, before]) => [index, differingPixels(before.runs, tracked.frames[index]!.runs)] as const));
  return [...sizes.keys()].sort((one, other) => sizes.get(other)! - sizes.get(one)! || one - other);
}

/** From the first frame that has masks to the last; `null` if there are none. */
export function rangeOf(frames: Version['frames']): Range | null {
  const first = frames.findIndex((frame) => frame !== null);
  return first < 0 ? null : { first, last: frames.findLastIndex((frame) => frame !== null) };
}

/** Number of frames in a range. */
export function lengthOf({ first, last }: Range): number {
  return last - first + 1;
}

/** Number of frames in the range that have masks. */
export function masksIn(frames: Version['frames'], { first, last }: Range): number {
  return frames.slice(first, last + 1).filter((frame) => frame !== null).length;
}

/** Whether there are masks of any frame. */
export function isTracked(tracked: Tracked | null): tracked is Tracked {
  return tracked !== null && tracked.frames.some((frame) => frame !== null);
}

/** The masks that are on screen: those of the clip, or until the first ones are complete also drafts. */
export function shownFrames(tracked: Tracked | null): Version['frames'] {
  if (tracked === null) return [];
  const { frames, previews, run, spans } = tracked;
  return run.phase === 'working' && spans.length === 0 ? previews : frames;
}

/** Whether there are drafts on screen, whose objects have other numbers than those of the masks will have. */
export function isDrafting(tracked: Tracked | null): boolean {
  return tracked !== null && shownFrames(tracked) !== tracked.frames;
}

/** Whether what is shown of a frame is a draft. */
export function isDraft(tracked: Tracked | null, index: number): boolean {
  return tracked?.frames[index] === null && shownFrames(tracked)[index] !== null;
}

/** Whether there are masks of any frame to show. */
export function isSeen(tracked: Tracked | null): tracked is Tracked {
  return shownFrames(tracked).some((frame) => frame !== null);
}

/** Whether all frames to segment have their masks, and take corrections. */
export function isComplete({ frames, spans, range }: Pick<Tracked, 'frames' | 'spans' | 'range'>): boolean {
  return spans.length > 0 && masksIn(frames, range) === lengthOf(range);
}
