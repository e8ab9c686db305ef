//! The objects of a whole clip: how far their segmentation is, the masks of each frame, and what is known of frames and objects.

import type { ClipClick, ClipEntry, ClipFrame, ClipFrameStatus, Note } from 'veronese';
import type { Clip } from '../clips/clip.js';
import { type Runs, differingPixels } from '../result/runs.js';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED } from '../result/masks.js';

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

/** The masks of all frames by index; `null` for frames without masks. */
export type Masks = readonly (TrackedFrame | null)[];

/** Why a run on the clip is done. */
export type DoneCause = 'found' | 'same' | 'repeated' | 'continued' | 'locked' | 'unlocked' | 'accepted' | 'described' | 'corrected' | 'undone' | 'redone';

/** The run on the clip as a whole. */
export type ClipRun =
  | { readonly phase: 'idle' | 'cancelled' | 'failed' }
  /** `changed`: number of frames whose masks are others than before. `kept`: of accepted ones that a correction came to and left as they are. `notes`: why nothing was found, or what is likely to be wrong. */
  | { readonly phase: 'done'; readonly cause: DoneCause; readonly changed: number; readonly kept?: number; readonly notes?: readonly Note[] }
  | {
      readonly phase: 'working';
      readonly stage: 'pairs' | 'labels' | 'corrections';
      /** Time left until all masks are there, seconds; `null` until it is known. */
      readonly left: number | null;
      /** Number of frames that are labelled, or that a correction has come through, and of those that it may reach. */
      readonly labelled: number;
      readonly of?: number;
    };

/** First column, first row, width and height, pixels of the masks. */
export type Box = readonly [x: number, y: number, width: number, height: number];

/** Clicks and a box that point to an object in a frame. */
export interface Prompt {
  readonly object: number;
  readonly clicks: readonly ClipClick[];
  readonly box: Box | null;
}

/** What a person has annotated in a frame. */
export interface Annotated {
  /** The objects that are painted, outlined or pointed to. */
  readonly objects: readonly number[];
  readonly prompts: readonly Prompt[];
}

/** What a clip says of its frames and objects, with what a person has told it that has not taken effect yet. */
export interface ClipState {
  readonly frames: Masks;
  /** What is known of each frame; empty until the clip is open. */
  readonly status: readonly ClipFrameStatus[];
  /** All objects that there are and were. */
  readonly objects: readonly ClipEntry[];
  /** By index of the frame. */
  readonly annotated: ReadonlyMap<number, Annotated>;
}

export interface Tracked extends ClipState {
  readonly clip: Clip;
  readonly run: ClipRun;
  /** The frames to segment, from the in point to the out point. */
  readonly range: Range;
  /** What is shown while the first masks are being found, by index: drafts. They go when a run ends. */
  readonly previews: Masks;
  /** Number of frames whose pairs are solved, nearly all the work. They are kept when a run is cancelled. */
  readonly solved: number;
  /** The masks before the last command that has changed some. */
  readonly before: Masks;
  /** The lowest number that no object has had; 0 if none is left. */
  readonly nextObject: number;
  /** How many steps can be undone and redone. */
  readonly steps: { readonly undo: number; readonly redo: number };
  /** Whether an undo or redo is not on screen yet. */
  readonly isMoving: boolean;
  /** What was taken away as a file last. */
  readonly exported: Pick<ClipState, 'status' | 'objects'> | null;
  /** The frames at which a person looked because an object is least certain there, by its number. */
  readonly checked: ReadonlyMap<number, number>;
}

export function untracked(clip: Clip): Tracked {
  const frames = Array.from({ length: clip.count }, () => null);
  return {
    clip,
    run: { phase: 'idle' },
    range: { first: 0, last: clip.count - 1 },
    previews: frames,
    solved: 0,
    frames,
    before: frames,
    status: [],
    objects: [],
    annotated: new Map(),
    nextObject: 1,
    steps: { undo: 0, redo: 0 },
    isMoving: false,
    exported: null,
    checked: new Map(),
  };
}

/** Whether the first masks are complete, so that the clip takes corrections. */
export function isReady(tracked: Tracked | null): tracked is Tracked {
  return tracked !== null && tracked.status.some(({ hasMasks }) => hasMasks);
}

/** Whether a frame takes corrections. */
export function takesCorrections({ status }: Pick<Tracked, 'status'>, index: number): boolean {
  return status[index]?.hasMasks === true;
}

/** The objects that there are, by number. */
export function objectsOf({ objects }: Pick<Tracked, 'objects'>): ReadonlyMap<number, ClipEntry> {
  return new Map(objects.filter(({ number, became }) => number === became).map((object) => [object.number, object]));
}

/** The objects that nothing changes until a person unlocks them. */
export function lockedIn({ objects }: Pick<Tracked, 'objects'>): ReadonlySet<number> {
  return new Set(objects.filter(({ locked }) => locked).map(({ number }) => number));
}

/** Names, classes and colours that a person gave to objects, by number. */
export interface Described {
  readonly names: Readonly<Record<number, string>>;
  readonly classes: Readonly<Record<number, string>>;
  readonly colours: Readonly<Record<number, Colour>>;
}

export function describedIn(tracked: Pick<Tracked, 'objects'>): Described {
  const given = <T>(what: (object: ClipEntry) => T | undefined): Record<number, T> =>
    Object.fromEntries([...objectsOf(tracked).values()].flatMap((object) => {
      const value = what(object);
      return value === undefined ? [] : [[object.number, value]];
    }));
  return { names: given(({ name }) => name || undefined), classes: given((object) => object.class || undefined), colours: given(({ colour }) => colour) };
}

/** The frame, or the one before if its labels are the same, so that it is not another. */
export function unchanged(before: TrackedFrame | null | undefined, now: TrackedFrame): TrackedFrame {
  const isSame = (one: ArrayLike<number>, other: ArrayLike<number>): boolean => one.length === other.length && Array.prototype.every.call(one, (value, k) => value === other[k]);
  return before && isSame(before.runs.ends, now.runs.ends) && isSame(before.runs.labels, now.runs.labels) ? before : now;
}

/** Whether a person has done anything with the clip. */
export function isAnnotated({ status, objects }: Pick<Tracked, 'status' | 'objects'>): boolean {
  return status.some(({ annotated, accepted }) => annotated || accepted) || objects.some(({ number, name, class: named, colour, locked, became }) => number !== became || locked || colour !== undefined || name !== '' || named !== '');
}

/** The prompt of an object in a frame; `null` if there is none. */
export function promptOf({ annotated }: Pick<Tracked, 'annotated'>, frame: number | null, id: number | null): Prompt | null {
  return annotated.get(frame ?? -1)?.prompts.find(({ object }) => object === id) ?? null;
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

const known = new WeakMap<Masks, readonly Life[]>();

/** All objects of a clip by number. Masks do not change, so they are looked through once. */
export function livesOf({ frames }: Pick<Tracked, 'frames'>): readonly Life[] {
  const lives = known.get(frames) ?? livesIn(frames);
  known.set(frames, lives);
  return lives;
}

function livesIn(frames: Masks): Life[] {
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
function lostIn(frames: Masks, index: number): number[] {
  const frame = frames[index];
  if (frame == null) return [];
  const clear = [frames[index - 1], frames[index + 1]].flatMap((beside) => (beside == null ? [] : beside.objects.filter(({ bbox: [x, y, width, height] }) =>
    Math.min(x, y, beside.runs.width - x - width, beside.runs.height - y - height) > 0)));
  return clear.map(({ id }) => id).filter((id) => frame.objects.every((object) => object.id !== id));
}

/** The frames whose masks a person has accepted, by index. */
export function acceptedIn({ status }: Pick<Tracked, 'status'>): number[] {
  return [...status.keys()].filter((index) => status[index]!.accepted);
}

/**
 * The frame that most needs a look: of those with masks that are not accepted, one that lost an object, or with the least certain one, and of
 * several the next after frame `from`; `null` if none is left.
 */
export function toReview({ frames, status }: Pick<Tracked, 'frames' | 'status'>, from: number): number | null {
  const left = [...frames.keys()].filter((index) => frames[index] != null && status[index]?.accepted !== true);
  const certainty = (index: number): number =>
    Math.min(lostIn(frames, index).length > 0 ? 0 : 1, ...(frames[index]?.objects ?? []).map(({ confidence }) => confidence));
  const ahead = (index: number): number => (index - from - 1 + frames.length) % frames.length;
  const [first] = left.toSorted((one, other) => certainty(one) - certainty(other) || ahead(one) - ahead(other));
  return first ?? null;
}

/** The frames whose masks are others than before the last change of masks, by index, with how they were. Those that are accepted are done with. */
export function changedIn({ frames, before, status }: Pick<Tracked, 'frames' | 'before' | 'status'>): Map<number, TrackedFrame> {
  return new Map(frames.flatMap((frame, index) => {
    const was = before[index];
    return frame === null || was == null || frame === was || status[index]?.accepted ? [] : [[index, was] as const];
  }));
}

/** These frames, those first of which most pixels have changed. */
export function largestChanges(tracked: Tracked): number[] {
  const sizes = new Map([...changedIn(tracked)].map(([index, before]) => [index, differingPixels(before.runs, tracked.frames[index]!.runs)] as const));
  return [...sizes.keys()].sort((one, other) => sizes.get(other)! - sizes.get(one)! || one - other);
}

/** From the first frame that has masks to the last; `null` if there are none. */
export function rangeOf(frames: Masks): Range | null {
  const first = frames.findIndex((frame) => frame !== null);
  return first < 0 ? null : { first, last: frames.findLastIndex((frame) => frame !== null) };
}

/** Number of frames in a range. */
export function lengthOf({ first, last }: Range): number {
  return last - first + 1;
}

/** Number of frames in the range that have masks. */
export function masksIn(frames: Masks, { first, last }: Range): number {
  return frames.slice(first, last + 1).filter((frame) => frame !== null).length;
}

/** Whether there are masks of any frame. */
export function isTracked(tracked: Tracked | null): tracked is Tracked {
  return tracked !== null && tracked.frames.some((frame) => frame !== null);
}

const NONE: Masks = [];

/** The masks that are on screen: those of the clip, or until the first ones are complete also drafts. */
export function shownFrames(tracked: Tracked | null): Masks {
  if (tracked === null) return NONE;
  const { frames, previews, run, before } = tracked;
  const isFirst = before.every((frame) => frame === null);
  return run.phase === 'working' && run.stage !== 'corrections' && isFirst ? previews : frames;
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

/** The number of a label that names an object. */
export function isObject(label: number): boolean {
  return label !== 0 && label !== UNLABELLED;
}
