//! The page's state: one plain object, replaced as a whole and never changed in place. Views render it; nothing else remembers anything.

import type { Segmentation } from 'veronese';
import { UNTOUCHED, type Edits } from '../correction/edits.js';
import type { Stroke } from '../correction/strokes.js';
import type { Painting } from '../drawing/paint.js';
import { WHOLE, type Viewport } from '../drawing/viewport.js';
import type { Kept } from './kept.js';
import type { Film, FramePair, LoadedFrame, Slot } from './pair.js';
import { DEFAULT_SETTINGS, type Settings } from './settings.js';

/** What the masks that are shown come from. */
export type Cause = 'found' | 'solved' | 'undone' | 'redone' | 'merged' | 'ungrouped' | 'restored';

/** What the work is doing. `index` counts stages from 0; `of` is 0 while the number of stages is not known. */
export type Run =
  | { readonly phase: 'idle' | 'cancelled' | 'failed' | 'live' }
  | { readonly phase: 'done'; readonly cause: Cause }
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
export interface Look extends Painting {
  readonly view: Slot | 'split';
  /** Where the two frames meet in the split view, 0…1 of the view. */
  readonly divide: number;
  /** Both frames in turn. */
  readonly blinking: boolean;
  /** Opacity of the masks, 0…1. */
  readonly opacity: number;
  readonly outlines: boolean;
  readonly arrows: boolean;
  readonly residual: boolean;
  /** The mask that is worked on, and that the brush paints. */
  readonly selected: number | null;
  /** The second frame is drawn warped by this mask's motion, so that its pixels stand still. */
  readonly stabilised: number | null;
  /** Names that the user gave to masks, by `keyOf`. Like the colours, they follow from the edits. */
  readonly names: Readonly<Record<string, string>>;
}

export type ToolName = 'look' | 'brush' | 'eraser';

export interface Tool {
  readonly name: ToolName;
  /** Of the brush, pixels of the frame. */
  readonly radius: number;
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
  readonly motionsElsewhere: Settings['motions'] | null;
  readonly run: Run;
  readonly result: Result | null;
  /** As it was found, before anybody touched it. */
  readonly found: Segmentation | null;
  /** What was done to this pair. */
  readonly edits: Edits;
  /** What was done to others, by `keyOfPair`. */
  readonly kept: ReadonlyMap<string, Kept>;
  readonly look: Look;
  readonly viewport: Viewport;
  readonly tool: Tool;
  readonly notice: Notice | null;
}

/** Whether the result of a new pair is still to come: what shows the last one shows it until then, so that nothing jumps. */
export function isAwaited({ result, run }: State): boolean {
  return result === null && run.phase === 'working';
}

/** What of a look belongs to one result. */
export const FRESH = { hidden: new Set<number>(), solo: null, stabilised: null, selected: null, blinking: false, names: {}, colours: {} } as const;

export const INITIAL: State = {
  pair: { first: null, second: null },
  film: null,
  live: null,
  opening: false,
  settings: DEFAULT_SETTINGS,
  motionsElsewhere: null,
  run: { phase: 'idle' },
  result: null,
  found: null,
  edits: UNTOUCHED,
  kept: new Map(),
  look: { view: 'first', divide: 0.5, kind: 'groups', opacity: 0.5, outlines: true, arrows: false, residual: false, ...FRESH },
  viewport: WHOLE,
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
