//! The clip that is open: its in point and out point, segmenting it, and the living clip of the package behind it.

import { SegmenterPool } from 'veronese';
import type { Clip } from '../../clips/clip.js';
import type { Projects } from '../../projects/projects.js';
import type { Remembered } from '../../projects/work.js';
import type { Store } from '../../state/state.js';
import type { Range, Tracked } from '../../state/tracked.js';
import { report } from '../failures.js';
import type { Shown } from '../shown.js';
import { Living } from './living.js';

/** More workers than this are not worth their memory. */
const MOST_WORKERS = 8;

/** Of more than two processors one is left for the page, which needs a part of one. */
function workersFor(processors: number): number {
  return Math.min(processors > 2 ? processors - 1 : processors, MOST_WORKERS);
}

export class ClipSegmenting {
  readonly #store: Store;
  readonly #shown: Shown;
  readonly #projects: Projects;
  readonly #segmenter = new SegmenterPool({ jobs: workersFor(navigator.hardwareConcurrency || 1) });
  #isWarm = false;
  #living: Living | null = null;
  /** A clip that is about to be shown, and the number of the request for it. */
  #next: Living | null = null;
  #ticket = 0;
  /** Number of steps up to the first masks, of clips that were open. */
  readonly #found = new Map<string, number>();
  /** Settled when all clips that were left are closed. */
  #left: Promise<unknown> = Promise.resolve();

  constructor(store: Store, shown: Shown, projects: Projects) {
    this.#store = store;
    this.#shown = shown;
    this.#projects = projects;
    store.subscribe(({ settings }, before) => {
      if (settings.markUnknown !== before.settings.markUnknown) this.#again();
    });
  }

  get living(): Living | null {
    return this.#living;
  }

  /** Starts a worker, which warms up until it has a clip. Called while the first frames are being read. */
  warmUp(): void {
    if (this.#isWarm) return;
    this.#isWarm = true;
    this.#segmenter.warmUp().catch(() => undefined); // the clip that needs the worker reports why there is none
  }

  /** Opens a clip that is about to be shown, with the work on it. If it fails, what is on screen stays. */
  async prepare(clip: Clip): Promise<void> {
    this.#forgetNext();
    const ticket = (this.#ticket += 1);
    try {
      const next = await this.#open(clip);
      if (ticket !== this.#ticket) return void this.#leave(next);
      this.#next = next;
      await next.opened;
    } catch (error) {
      if (ticket === this.#ticket) this.giveUp();
      throw error;
    }
  }

  /** What was about to be shown is not. */
  giveUp(): void {
    this.#ticket += 1;
    this.#forgetNext();
    const { tracked } = this.#store.get();
    if (this.#living?.isClosed && tracked?.clip === this.#living.clip) this.#renew(this.#living, this.#left);
  }

  /** The objects of this clip, which comes to the screen. */
  of(clip: Clip | null): Tracked | null {
    const { tracked } = this.#store.get();
    if (clip !== null && tracked?.clip === clip && this.#next?.clip !== clip) return tracked;
    this.#ticket += 1;
    const next = this.#next?.clip === clip ? this.#next : null;
    if (next === null) this.#forgetNext();
    this.#next = null;
    const left = this.#living;
    if (left !== null && !left.isClosed) void this.#leave(left);
    this.#living = clip === null ? null : (next ?? this.#new(clip, { found: this.#found.get(clip.fingerprint) ?? 0 }));
    return this.#living?.tracked ?? null;
  }

  /** Moves the in point or the out point of the open clip. The other one makes way. */
  setRange(edge: keyof Range, index: number): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const end = tracked.clip.count - 1;
    const at = Math.min(Math.max(index, 0), end);
    const { first, last } = tracked.range;
    const range = edge === 'first' ? { first: at, last: at > last ? end : last } : { first: at < first ? 0 : first, last: at };
    this.#store.clip({ range });
  }

  /** Segments the open clip from its in point to its out point, or goes on with it. Corrections are applied again. */
  async segment(): Promise<void> {
    try {
      await this.#living?.segment();
    } catch (error) {
      this.#store.clip({ run: { phase: 'failed' } });
      report(this.#store, error);
    }
  }

  /** Cancels the run on the clip. A correction under way is taken back. */
  cancel(): void {
    this.#living?.cancel();
  }

  /** Opens the clip again, as another option makes it another one. */
  #again(): void {
    const living = this.#living;
    const { tracked, settings } = this.#store.get();
    if (living === null || tracked?.clip !== living.clip || living.markUnknown === settings.markUnknown) return;
    const goesOn = living.isSegmenting;
    this.#renew(living, this.#leave(living));
    if (goesOn) void this.segment();
  }

  /** Opens a clip again that was closed. */
  #renew({ clip, found }: Living, after: Promise<unknown>): void {
    this.#living = this.#new(clip, { found }, after);
    this.#living.opened.catch((error: unknown) => report(this.#store, error));
  }

  /** The same work may still be being left. */
  async #open(clip: Clip): Promise<Living> {
    if (this.#living?.clip.fingerprint === clip.fingerprint && !this.#living.isClosed) void this.#leave(this.#living);
    await this.#left;
    return this.#new(clip, await this.#projects.remembered(clip));
  }

  #new(clip: Clip, remembered: Remembered, after: Promise<unknown> = this.#left): Living {
    const parts = { store: this.#store, shown: this.#shown, segmenter: this.#segmenter, keeper: this.#projects.keeperOf(clip) };
    return new Living(clip, parts, remembered, after);
  }

  #leave(living: Living): Promise<unknown> {
    this.#found.set(living.clip.fingerprint, living.found);
    this.#projects.leave(living);
    return (this.#left = Promise.all([this.#left, living.close()]));
  }

  #forgetNext(): void {
    if (this.#next !== null) void this.#leave(this.#next);
    this.#next = null;
  }
}
