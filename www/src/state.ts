//! The page's state: one plain object, replaced as a whole and never changed in place. Views render it; nothing else remembers anything.

import type { Segmentation, SegmentOptions } from 'veronese';
import type { LoadedFrame } from './frames.js';
import { DEFAULT_SETTINGS } from './controls.js';

/** The two frames; a missing one is still being asked for. */
export interface FramePair {
  readonly first: LoadedFrame | null;
  readonly second: LoadedFrame | null;
}

export type Slot = keyof FramePair;

/** What the settings form holds: the options of the package that the page offers. */
export type Settings = Readonly<Required<Pick<SegmentOptions, 'motions' | 'quality' | 'markUnknown' | 'seed'>>>;

/** What the work is doing. `index` counts stages from 0; `of` is 0 while the number of stages is not known. */
export type Run =
  | { readonly phase: 'idle' | 'opening' | 'done' | 'cancelled' | 'failed' }
  | { readonly phase: 'working'; readonly stage: string; readonly index: number; readonly of: number };

/** A segmentation together with the frames it was made from, so that late views never mix two requests. */
export interface Result {
  readonly segmentation: Segmentation;
  readonly pair: { readonly first: LoadedFrame; readonly second: LoadedFrame };
  /** Milliseconds from request to answer, as the page saw it: transfer to the worker and back included. */
  readonly waited: number;
}

/** How the result is looked at. Labels refer to the current result. */
export interface Look {
  readonly frame: Slot;
  readonly colouring: 'motions' | 'groups';
  /** Opacity of the masks, 0…1. */
  readonly opacity: number;
  readonly outlines: boolean;
  readonly hidden: ReadonlySet<number>;
  readonly solo: number | null;
  /** The second frame is drawn warped by this motion, so that its pixels stand still. */
  readonly still: number | null;
}

/** Something went wrong (`code` set) or needs saying. */
export interface Notice {
  readonly sentence: string;
  readonly code: string | null;
}

export interface State {
  readonly pair: FramePair;
  readonly settings: Settings;
  readonly run: Run;
  readonly result: Result | null;
  readonly look: Look;
  readonly notice: Notice | null;
}

export const INITIAL: State = {
  pair: { first: null, second: null },
  settings: DEFAULT_SETTINGS,
  run: { phase: 'idle' },
  result: null,
  look: { frame: 'first', colouring: 'motions', opacity: 0.5, outlines: true, hidden: new Set(), solo: null, still: null },
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
