//! The state of the page: one plain object, replaced as a whole and never mutated. Views render it.

import { type ReadonlySignal, signal } from '@preact/signals';
import type { ClipAnnotation, Segmentation } from 'veronese';
import type { Painting } from '../drawing/paint.js';
import { WHOLE, type Viewport } from '../drawing/viewport.js';
import type { ImageFolder } from '../frames/files.js';
import type { FrameMasks } from '../result/masks.js';
import { type FramePair, type LoadedFrame, type Slot, type Timeline, timelineOf } from './pair.js';
import { DEFAULT_SETTINGS, type Settings } from './settings.js';
import type { Tracked } from './tracked.js';

/** Masks with the frame that they belong to, so that views never draw them over another. */
export interface Result {
  readonly masks: FrameMasks;
  readonly frame: LoadedFrame;
  /** Those of the other frame of the pair. */
  readonly second: FrameMasks | null;
}

/** The motions between two frames: `session/inspecting.ts`. */
export interface Inspected {
  readonly first: LoadedFrame;
  readonly second: LoadedFrame;
  /** `null` if they could not be found. */
  readonly segmentation: Segmentation | null;
  /** Time from request to result, transfers to and from the worker included, milliseconds. */
  readonly waited: number;
}

/** How frames and masks are displayed. */
export interface Look extends Painting {
  readonly view: Slot | 'split';
  /** Position of the split, 0…1 of the width of the view. */
  readonly divide: number;
  /** Whether the two frames alternate. */
  readonly blinking: boolean;
  /** Opacity of the masks, 0…1. */
  readonly opacity: number;
  readonly outlines: boolean;
  /** The outlines of a clip's objects in the frames before and after. */
  readonly onion: boolean;
  /** The motions of the frame that is inspected, in the place of its objects. */
  readonly motions: boolean;
  /** The selected object, to which brush and eraser refer. */
  readonly selected: number | null;
  /** The objects of a clip that are selected together, `selected` among them; `null` while one is selected alone. */
  readonly among: ReadonlySet<number> | null;
  /** Names and classes that a person gave to the objects of a clip, by number, as the colours. */
  readonly names: Readonly<Record<number, string>>;
  readonly classes: Readonly<Record<number, string>>;
}

export type ToolName = 'look' | 'brush' | 'eraser' | 'polygon' | 'box';

/** The meaning of a press with the box tool: a new object, more of the one that is selected, or pixels that do not belong to it. */
export type Pointing = 'new' | 'add' | 'remove';

export interface Tool {
  readonly name: ToolName;
  /** Of the brush, pixels of the frame. */
  readonly radius: number;
  /** Whether what is drawn is kept pixel for pixel, and nothing follows. */
  readonly exact: boolean;
  /** Where an annotation of a clip's frame spreads otherwise. */
  readonly spread: Exclude<ClipAnnotation['propagate'], 'exact' | undefined>;
  readonly pointing: Pointing;
}

/** The state of the camera while it is on. */
export interface Live {
  /** Frames per second, lately. */
  readonly rate: number;
}

/** Which of several folders has the frames. */
export interface Question {
  readonly folders: readonly ImageFolder[];
  /** Those of all folders. */
  readonly images: readonly File[];
  /** With the images that are opened; `null` for none. */
  readonly answer: (images: readonly File[] | null) => void;
}

/** Whether the browser keeps the work on what is open. */
export type Keeping =
  /** It has not had to. */
  | { readonly is: 'nothing' }
  /**
   * `at`: since when, milliseconds since 1970. `without`: a copy of the frames was too large, so a person opens them again. `waits`: later
   * changes are about to be kept.
   */
  | { readonly is: 'kept'; readonly at: number; readonly without: boolean; readonly waits: boolean }
  /** It did not the last time. `code`: why. */
  | { readonly is: 'refused'; readonly code: Refusal };

export const NOTHING_KEPT: Keeping = { is: 'nothing' };

export type Refusal = 'storage-full' | 'storage-refused' | 'open-elsewhere';

/** A message to the user; an error if `code` is set. */
export interface Notice {
  readonly sentence: string;
  readonly code: string | null;
  /** What a person can choose, which ends the notice. */
  readonly choices: readonly Choice[];
}

export interface Choice {
  readonly label: string;
  readonly choose: () => void;
}

/** Which frames are open: `session/frames.ts`, and `session/opening.ts` while they are loaded. */
interface FramesState {
  readonly pair: FramePair;
  readonly timeline: Timeline | null;
  /** Whether something is being opened. The current pair stays until it is ready. */
  readonly opening: boolean;
  /** Whether a clip is segmented as soon as it is opened. */
  readonly automatic: boolean;
  readonly question: Question | null;
}

/** How frames are passed: `session/playing.ts`; and the camera: `session/camera`. */
interface PassingState {
  /** Whether the clip is being played. */
  readonly playing: boolean;
  /** How many times as fast as it was taken. */
  readonly speed: number;
  /** Whether a pointer is being dragged through the clip. */
  readonly scrubbing: boolean;
  readonly live: Live | null;
}

/** What is seen of the frame: `session/shown.ts`, and `session/inspecting.ts`. */
interface SeenState {
  readonly settings: Settings;
  readonly result: Result | null;
  /** Whether a person inspects the frame. */
  readonly inspecting: boolean;
  readonly inspected: Inspected | null;
}

/** The objects of clips: `session/clip`. */
interface ClipState {
  /** Those of the open clip. */
  readonly tracked: Tracked | null;
  /** The classes that objects can have, in the order of their numbers in files. */
  readonly classList: readonly string[];
}

/** A person's choices for the screen and the tools: the views. */
interface ChosenState {
  readonly look: Look;
  readonly viewport: Viewport;
  readonly tool: Tool;
}

/** Messages: a notice, until it is read, and whether work is kept: `projects/projects.ts`. */
interface ToldState {
  readonly notice: Notice | null;
  readonly keeping: Keeping;
}

/** Each part names who changes it. Projects that are opened are put into all of them. */
export interface State extends FramesState, PassingState, SeenState, ClipState, ChosenState, ToldState {}

/** Whether the frames on screen are left at once. */
export function isPassing({ playing, scrubbing }: Pick<State, 'playing' | 'scrubbing'>): boolean {
  return playing || scrubbing;
}

/** The frame of a clip that is on screen, which the timeline may have left for one that is being read; `null` if there is none. */
export function seenIn({ pair, look }: Pick<State, 'pair' | 'look'>): { readonly index: number; readonly frame: LoadedFrame } | null {
  const slot = look.view === 'second' ? 'second' : 'first';
  const [index, frame] = [timelineOf(pair)?.[slot], pair[slot]];
  return index === undefined || frame === null ? null : { index, frame };
}

/** The objects that are selected. */
export function selectedIn({ selected, among }: Look): readonly number[] {
  return [...(among ?? (selected === null ? [] : [selected]))];
}

/** The initial values of the parts of a look that belong to one clip. */
export const FRESH = { hidden: new Set<number>(), solo: null, selected: null, blinking: false, among: null, names: {}, classes: {}, colours: {} } as const;

export const INITIAL: State = {
  pair: { first: null, second: null },
  timeline: null,
  tracked: null,
  classList: [],
  playing: false,
  speed: 1,
  scrubbing: false,
  live: null,
  opening: false,
  automatic: true,
  settings: DEFAULT_SETTINGS,
  result: null,
  inspecting: false,
  inspected: null,
  look: { view: 'first', divide: 0.5, opacity: 0.35, outlines: true, onion: false, motions: false, ...FRESH },
  viewport: WHOLE,
  tool: { name: 'look', radius: 8, exact: false, spread: 'both', pointing: 'new' },
  notice: null,
  question: null,
  keeping: NOTHING_KEPT,
};

export type Listener = (now: State, before: State) => void;

/** Holds the state. Components read the signal; what is no component, as canvases, listens. */
export class Store {
  readonly #signal = signal<State>(INITIAL);
  readonly #listeners = new Set<Listener>();

  get state(): ReadonlySignal<State> {
    return this.#signal;
  }

  get(): State {
    return this.#signal.peek();
  }

  /** Replaces parts of the state. Components are rendered again, then the listeners are called in the order of their subscription. */
  set(change: Partial<State>): void {
    const before = this.#signal.peek();
    this.#signal.value = { ...before, ...change };
    for (const listener of this.#listeners) listener(this.get(), before);
  }

  /** Changes how frames and masks are displayed. */
  look(change: Partial<Look>): void {
    this.set({ look: { ...this.get().look, ...change } });
  }

  /** Changes what is known of the open clip, if there is one. */
  clip(change: Partial<Tracked>): void {
    const { tracked } = this.get();
    if (tracked !== null) this.set({ tracked: { ...tracked, ...change } });
  }

  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code: string | null = null, choices: readonly Choice[] = []): void {
    this.set({ notice: { sentence, code, choices } });
  }

  /** Calls `listener` at every change. Returns a function that ends the subscription. */
  subscribe(listener: Listener): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}
