//! The page's state: one plain object, replaced as a whole and never changed in place. Views render it; nothing else remembers anything.

import type { Segmentation, SegmentOptions } from 'veronese';
import { type Camera, WHOLE } from './camera.js';
import type { Clip } from './clips/clip.js';
import { DEFAULT_SETTINGS } from './controls.js';
import { type Edits, UNTOUCHED } from './edits.js';
import type { LoadedFrame } from './frames.js';
import type { Kept } from './kept.js';
import type { Kind } from './masks.js';
import type { Colour } from './palette.js';
import type { Stroke } from './strokes.js';

/** The two frames; a missing one is still being asked for. */
export interface FramePair {
  readonly first: LoadedFrame | null;
  readonly second: LoadedFrame | null;
}

export type Slot = keyof FramePair;

/** What the settings form holds: the options of the package that the page offers. */
export type Settings = Readonly<Required<Pick<SegmentOptions, 'motions' | 'quality' | 'markUnknown' | 'seed'>>> & {
  /** Frames with a longer side are made smaller before anything else, pixels; masks are taken away at the size of the file. */
  readonly longestSide: number;
};

/** What the masks that are shown come from. */
export type After = 'found' | 'solved' | 'undone' | 'redone' | 'merged' | 'apart' | 'restored';

/** What the work is doing. `index` counts stages from 0; `of` is 0 while the number of stages is not known. */
export type Run =
  | { readonly phase: 'idle' | 'cancelled' | 'failed' | 'live' }
  | { readonly phase: 'done'; readonly after: After }
  | { readonly phase: 'working'; readonly work: 'segmenting' | 'solving'; readonly stage: string; readonly index: number; readonly of: number };

/** A segmentation together with the frames it was made from, so that late views never mix two requests. */
export interface Result {
  readonly segmentation: Segmentation;
  readonly pair: { readonly first: LoadedFrame; readonly second: LoadedFrame };
  /** Milliseconds from request to answer, as the page saw it: transfer to the worker and back included. */
  readonly waited: number;
  /** The last stroke that the labels were solved under. */
  readonly under: Stroke | null;
}

/** How the result is looked at. Numbers of masks refer to the current result and kind. */
export interface Look {
  readonly view: Slot | 'split';
  /** Where the two frames meet in the split view, 0…1 of the view. */
  readonly divide: number;
  /** Both frames in turn. */
  readonly blinking: boolean;
  readonly kind: Kind;
  /** Opacity of the masks, 0…1. */
  readonly opacity: number;
  readonly outlines: boolean;
  readonly arrows: boolean;
  readonly residual: boolean;
  readonly hidden: ReadonlySet<number>;
  readonly solo: number | null;
  /** The mask that is worked on, and that the brush paints. */
  readonly selected: number | null;
  /** The second frame is drawn warped by this mask's motion, so that its pixels stand still. */
  readonly still: number | null;
  /** Names and colours that were given and belong to a mask that is there, by {@link keyOf}. They follow from the edits. */
  readonly names: Readonly<Record<string, string>>;
  readonly colours: Readonly<Record<string, Colour>>;
}

/** Names and colours belong to a mask of one kind. */
export function keyOf(kind: Kind, id: number): string {
  return `${kind}-${id}`;
}

export type ToolName = 'look' | 'brush' | 'eraser';

export interface Tool {
  readonly name: ToolName;
  /** Of the brush, pixels of the frame. */
  readonly radius: number;
}

/** A clip that is open, and the frames chosen from it; `null` where the pair's frame is another file. */
export interface Film {
  readonly clip: Clip;
  readonly first: number | null;
  readonly second: number | null;
}

/** The film that the frames of a pair are of: it is open for as long as one of them is. */
export function filmOf({ first, second }: FramePair): Film | null {
  const [a, b] = [first, second].map((frame) => (frame?.origin && 'clip' in frame.origin ? frame.origin : null));
  const clip = a?.clip ?? b?.clip;
  return clip === undefined ? null : { clip, first: a?.index ?? null, second: b?.clip === clip ? b.index : null };
}

/** The camera is on. */
export interface Live {
  /** Segmentations per second, lately. */
  readonly rate: number;
}

/** Something went wrong (`code` set) or needs saying. */
export interface Notice {
  readonly sentence: string;
  readonly code: string | null;
}

export interface State {
  readonly pair: FramePair;
  readonly film: Film | null;
  readonly live: Live | null;
  /** Something is being opened; what is open stays until it is there. */
  readonly opening: boolean;
  readonly settings: Settings;
  /** The number of motions that was set before somebody insisted on another for this pair alone; null where nobody did. */
  readonly insisting: Settings['motions'] | null;
  readonly run: Run;
  readonly result: Result | null;
  /** As it was found, before anybody touched it. */
  readonly found: Segmentation | null;
  /** What was done to this pair. */
  readonly edits: Edits;
  /** What was done to others, by `keyOfPair`. */
  readonly kept: ReadonlyMap<string, Kept>;
  readonly look: Look;
  readonly camera: Camera;
  readonly tool: Tool;
  readonly notice: Notice | null;
}

/** Whether the result of a new pair is still to come: what shows the last one shows it until then, so that nothing jumps. */
export function isAwaited({ result, run }: State): boolean {
  return result === null && run.phase === 'working';
}

/** What of a look belongs to one result. */
export const FRESH = { hidden: new Set<number>(), solo: null, still: null, selected: null, blinking: false, names: {}, colours: {} } as const;

export const INITIAL: State = {
  pair: { first: null, second: null },
  film: null,
  live: null,
  opening: false,
  settings: DEFAULT_SETTINGS,
  insisting: null,
  run: { phase: 'idle' },
  result: null,
  found: null,
  edits: UNTOUCHED,
  kept: new Map(),
  look: { view: 'first', divide: 0.5, kind: 'groups', opacity: 0.5, outlines: true, arrows: false, residual: false, ...FRESH },
  camera: WHOLE,
  tool: { name: 'look', radius: 8 },
  notice: null,
};

export type Listener = (now: State, before: State) => void;

/** Holds the state and tells everybody who asked when it changes. */
export class Store {
  #state: State = INITIAL;
  readonly #listeners = new Set<Listener>();

  get(): State {
    return this.#state;
  }

  /** Replaces the named parts and tells the listeners, in the order in which they came. */
  set(change: Partial<State>): void {
    const before = this.#state;
    this.#state = { ...before, ...change };
    for (const listener of this.#listeners) listener(this.#state, before);
  }

  /** Changes how the result is looked at. */
  look(change: Partial<Look>): void {
    this.set({ look: { ...this.#state.look, ...change } });
  }

  /** Calls `listener` at every change; the function returned ends that. */
  subscribe(listener: Listener): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}
