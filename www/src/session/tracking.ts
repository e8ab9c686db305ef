//! The clip as a whole: its frames are segmented in a worker of their own. What is done stays when a run is cancelled or fails.

import { type ClipFrame, type Pixels, Segmenter } from 'veronese';
import type { Clip } from '../clips/clip.js';
import { packed } from '../correction/runs.js';
import type { Colour } from '../drawing/palette.js';
import { keyOf } from '../result/masks.js';
import type { Settings } from '../state/settings.js';
import type { Store } from '../state/state.js';
import { type Tracked, type TrackedFrame, untracked } from '../state/tracked.js';

/** Masks are shown at most this often while they come, milliseconds. */
const OFTEN = 100;

/** What the pairs of each frame have told, for a run that goes on. The bytes are in blobs, which browsers can move to disk. */
interface Known {
  readonly settings: string;
  readonly pairs: Map<number, Blob>;
}

interface Hooks {
  /** The masks of some frames have changed; `before`: what there was. */
  readonly changed: (before: Tracked) => void;
  readonly failed: (error: unknown) => void;
}

export class Tracking {
  readonly #store: Store;
  readonly #hooks: Hooks;
  readonly #segmenter = new Segmenter();
  readonly #known = new WeakMap<Clip, Known>();
  /** The run under way. */
  #current: AbortController | null = null;

  constructor(store: Store, hooks: Hooks) {
    this.#store = store;
    this.#hooks = hooks;
  }

  /** What is known of this clip. A run on another one ends. */
  of(clip: Clip | null): Tracked | null {
    const { tracked } = this.#store.get();
    if (clip !== null && tracked?.clip === clip) return tracked;
    this.#end();
    return clip === null ? null : untracked(clip);
  }

  /** Segments the open clip, or continues with it. */
  async segment(): Promise<void> {
    const { tracked, settings } = this.#store.get();
    if (tracked === null) return;
    const { clip } = tracked;
    const { longestSide, ...options } = settings;
    const { pairs } = this.#knownOf(clip, settings);
    const time = new TimeLeft(pairs.size, clip.count);
    await this.#run(async (signal, set) => {
      const frames = new Frames(clip, longestSide);
      const solving = (): void => set({ run: { phase: 'working', stage: 'pairs', left: time.at(pairs.size) }, solved: pairs.size });
      solving();
      const found = this.#segmenter.segmentClip(frames, {
        ...options,
        signal,
        transfer: true,
        knownPairs: (index) => bytesOf(pairs.get(index)),
        onPairs: (index, bytes) => {
          pairs.set(index, new Blob([new Uint8Array(bytes)]));
          solving();
        },
      });
      await this.#take(found, frames, set);
    });
  }

  /** Stops the run; what is done stays. */
  cancel(): void {
    const { tracked } = this.#store.get();
    if (this.#current === null || tracked === null) return;
    this.#end();
    this.#store.set({ tracked: { ...tracked, run: { phase: 'cancelled' } } });
  }

  /** Sets the name or colour of an object. An empty name restores the default. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const key = keyOf('objects', id);
    const { [key]: _, ...others } = tracked.names;
    const names = 'colour' in what ? tracked.names : what.name === '' ? others : { ...others, [key]: what.name };
    const colours = 'colour' in what ? { ...tracked.colours, [key]: what.colour } : tracked.colours;
    this.#store.set({ tracked: { ...tracked, names, colours } });
    this.#store.look({ names, colours });
  }

  #end(): void {
    this.#current?.abort();
    this.#current = null;
  }

  /** Runs `work` instead of what is under way. `set` changes what is known of the clip, unless the run has ended. */
  async #run(work: (signal: AbortSignal, set: (change: Partial<Tracked>) => void) => Promise<void>): Promise<void> {
    this.#end();
    const own = (this.#current = new AbortController());
    const { signal } = own;
    const set = (change: Partial<Tracked>): void => {
      const { tracked } = this.#store.get();
      if (tracked !== null && !signal.aborted) this.#store.set({ tracked: { ...tracked, ...change } });
    };
    try {
      await work(signal, set);
      set({ run: { phase: 'done' } });
    } catch (error) {
      if (signal.aborted) return;
      set({ run: { phase: 'failed' } });
      this.#hooks.failed(error);
    } finally {
      if (this.#current === own) this.#current = null;
    }
  }

  /** Takes the labelled frames as they come. They replace all masks that there were. */
  async #take(found: AsyncIterable<ClipFrame>, { length, size }: Frames, set: (change: Partial<Tracked>) => void): Promise<void> {
    const frames: (TrackedFrame | null)[] = Array.from({ length }, () => null);
    let shown = 0;
    const show = (): void => {
      const { tracked: before } = this.#store.get();
      shown = performance.now();
      set({ frames: [...frames], run: { phase: 'working', stage: 'labels', left: null } });
      if (before !== null) this.#hooks.changed(before);
    };
    try {
      for await (const { index, labels, objects, background } of found) {
        frames[index] = { runs: packed(labels, size.width, size.height), objects, background };
        if (performance.now() - shown >= OFTEN) show();
      }
    } finally {
      if (frames.some((frame) => frame !== null)) show();
    }
  }

  /** What is known for these settings: other settings begin anew. */
  #knownOf(clip: Clip, settings: Settings): Known {
    const key = JSON.stringify([settings.motions, settings.quality, settings.seed, settings.longestSide]);
    const before = this.#known.get(clip);
    const known = before?.settings === key ? before : { settings: key, pairs: new Map<number, Blob>() };
    this.#known.set(clip, known);
    return known;
  }
}

/** The frames of a clip as the package reads them: whenever it needs one. */
class Frames {
  /** Of all frames, once one has been read. */
  size = { width: 0, height: 0 };

  constructor(
    readonly clip: Clip,
    readonly longestSide: number,
  ) {}

  get length(): number {
    return this.clip.count;
  }

  async read(index: number): Promise<Pixels> {
    const { data, width, height, bitmap } = await this.clip.frame(index, this.longestSide);
    bitmap.close();
    this.size.width = width;
    this.size.height = height;
    return { data, width, height };
  }
}

/** The time left, from the time that frames have taken so far. */
class TimeLeft {
  #began: { readonly at: number; readonly done: number } | null = null;

  /** `done`: frames that take no time, because they were done before. */
  constructor(
    readonly done: number,
    readonly of: number,
  ) {}

  /** Seconds left when so many frames are done; `null` if it cannot be told yet. */
  at(done: number): number | null {
    if (done === this.done) return null;
    // The first frame may have waited for the module.
    if (this.#began === null) {
      this.#began = { at: performance.now(), done };
      return null;
    }
    const each = (performance.now() - this.#began.at) / (done - this.#began.done);
    return (each * (this.of - done)) / 1000;
  }
}

async function bytesOf(blob: Blob | undefined): Promise<Uint8Array | undefined> {
  return blob === undefined ? undefined : new Uint8Array(await blob.arrayBuffer());
}
