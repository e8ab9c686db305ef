//! The clip of the package, from when the page opens a clip until it leaves it. Commands go to it, and what it says goes into the state: objects,
//! what is known of frames, and labels, which are asked for when they have changed, those on screen first.

import type { Clip as PackageClip, ClipEvent, ClipStep, SegmenterPool } from 'veronese';
import type { Clip } from '../../clips/clip.js';
import { PageError, codeOf } from '../../common/errors.js';
import { strings } from '../../common/strings.js';
import type { Effect } from '../../state/said.js';
import type { Store } from '../../state/state.js';
import { type Annotated, type ClipRun, type ClipState, type DoneCause, type Prompt, type Range, type Tracked, type TrackedFrame, isAnnotated, isObject, isTracked, lengthOf, unchanged, untracked } from '../../state/tracked.js';
import type { Keeper, KnownMasks, Remembered, Work } from '../../projects/work.js';
import { report } from '../failures.js';
import type { Shown } from '../shown.js';
import { ClipFrames, masksOf } from './frames.js';
import { TimeLeft } from './time-left.js';

/** Masks are shown at most this often while they come, milliseconds. */
const OFTEN = 100;

/** What a person has said, until it has taken effect. */
interface Said {
  readonly step: ClipStep;
  effect: Effect;
}

export interface Saying {
  readonly cause: DoneCause;
  /** The frames that are annotated. */
  readonly frames?: readonly number[];
  /** Number of frames that it may reach; 0 if it changes no masks. */
  readonly reach?: number;
  /** Number of these that are accepted, and stay as they are. */
  readonly kept?: number;
  /** What is said if the clip cannot do it. */
  readonly refusal?: string;
}

/** Parts of the page that a clip needs. */
interface Parts {
  readonly store: Store;
  readonly shown: Shown;
  readonly segmenter: SegmenterPool;
  readonly keeper: Keeper;
}

export class Living implements Work {
  readonly clip: Clip;
  readonly markUnknown: boolean;
  /** Settled when the clip is open; rejects with what kept it from that. */
  readonly opened: Promise<void>;
  readonly #parts: Parts;
  readonly #frames: ClipFrames;
  #package: PackageClip | null = null;
  #isClosed = false;
  /** What the clip has answered, without what has been said since. */
  #base: ClipState;
  #said: readonly Said[] = [];
  /** Frames whose labels have changed since they were asked for; and those of them that the step under way has changed. */
  readonly #stale = new Set<number>();
  readonly #fresh = new Set<number>();
  /** Frames whose labels were asked for, and are not there. */
  readonly #asked = new Set<number>();
  #isAsking = false;
  #lastShown = -Infinity;
  /** Why the run that is under way will be done, and the range that is being segmented. */
  #cause: DoneCause = 'continued';
  #range: { readonly step: ClipStep; readonly time: TimeLeft; isEnded: boolean } | null = null;
  /** How far the corrections under way have come. */
  #reached: { readonly frames: Set<number>; readonly of: number; readonly time: TimeLeft } | null = null;
  #kept = 0;
  #isUnderWay = false;
  #count = 0;
  /** Whether a range is to be segmented as soon as the clip is open. */
  #isStarting = false;
  /** Frames whose labels the last undo or redo has changed; and the end of all of these. */
  #moved: Set<number> | null = null;
  #moving: Promise<void> = Promise.resolve();
  /** How many of these have not ended. */
  #moves = 0;
  #longestSide: number | null = null;
  /** Number of steps up to the first masks. */
  #found: number;
  /** The range when the clip was opened. */
  readonly #firstRange: Range;

  /** `known`: what is known of it from before. `after`: what has to end before it can be opened. */
  constructor(clip: Clip, parts: Parts, remembered: Remembered, after: Promise<unknown>) {
    this.clip = clip;
    this.#parts = parts;
    this.#found = remembered.found ?? 0;
    this.#firstRange = remembered.range ?? { first: 0, last: clip.count - 1 };
    this.markUnknown = (remembered.markUnknown ?? parts.store.get().settings.markUnknown) === true;
    const frames = Array.from({ length: clip.count }, () => null);
    this.#base = { frames, status: [], objects: [], annotated: new Map() };
    const { store } = parts;
    this.#frames = new ClipFrames(clip, () => this.longestSide, () => [store.get().pair.first, store.get().pair.second]);
    this.opened = this.#open(remembered, after);
    this.opened.catch(() => undefined);
  }

  /** The longer side of the frames as they are segmented, pixels. */
  get longestSide(): number {
    const { width = 0, height = 0 } = this.#package ?? {};
    return this.#longestSide ?? (width > 0 ? Math.max(width, height) : this.#parts.store.get().settings.longestSide);
  }

  /** The state of the clip as it is now. */
  get state(): ClipState {
    return this.#said.reduce((clip, { effect }) => effect(clip), this.#base);
  }

  /** The state of the clip when it comes to the screen. */
  get tracked(): Tracked {
    const known = this.#known;
    const solved = known.status.filter(({ hasMasks }) => hasMasks).length;
    const { first, last } = this.#firstRange;
    const isComplete = solved > 0 && known.status.slice(first, last + 1).every(({ hasMasks }) => hasMasks);
    const run: ClipRun = this.#isUnderWay ? this.#correcting() : isComplete ? { phase: 'done', cause: 'continued', changed: 0 } : { phase: solved > 0 ? 'cancelled' : 'idle' };
    return { ...untracked(this.clip), ...known, range: this.#firstRange, before: known.frames, solved, run };
  }

  get isClosed(): boolean {
    return this.#isClosed;
  }

  get isSegmenting(): boolean {
    return this.#range !== null;
  }

  /** Number of steps up to the first masks. */
  get found(): number {
    return this.#found;
  }

  /** The masks as they are known, and the revision that each is of. */
  get masks(): KnownMasks {
    const { frames, status } = this.#base;
    const isKnown = (index: number): boolean => !this.#stale.has(index) && !this.#asked.has(index) && this.#said.length === 0;
    return { frames, revisions: status.map(({ revision }, index) => (isKnown(index) ? revision : 0)) };
  }

  save(): Promise<Uint8Array> {
    return this.#now.save();
  }

  async close(): Promise<void> {
    this.#isClosed = true;
    await this.opened.catch(() => undefined);
    await this.#package?.close();
  }

  /** Gives the clip a command, of which `effect` is seen at once. Resolves when it has taken effect, to whether it has. */
  async say(command: (clip: PackageClip) => ClipStep, effect: Effect, { cause, frames = [], reach = 0, kept = 0, refusal }: Saying): Promise<boolean> {
    const { keeper, store } = this.#parts;
    if (this.#package === null) {
      try {
        await this.opened;
      } catch (error) {
        report(store, error);
        return false;
      }
    }
    if (reach > 0) this.#begin(cause, kept);
    keeper.said();
    this.#count += 1;
    const said: Said = { step: command(this.#now), effect };
    this.#said = [...this.#said, said];
    const of = Math.max(reach, this.#reached?.of ?? 0);
    if (reach > 0) this.#reached = { frames: this.#reached?.frames ?? new Set(), time: new TimeLeft(0, of), of };
    this.#show(reach > 0 && this.#range === null ? { run: this.#correcting() } : {});
    if (frames.length === 1 && reach > 0) {
      // Only then what was painted is no longer laid over its frame.
      said.step.shown.then((frame) => this.#take(frame.index, masksOf(frame), said), () => undefined);
    }
    try {
      await said.step;
      // Seen until the labels are there.
      this.#base = { ...this.#base, frames: said.effect(this.#base).frames };
      return true;
    } catch (error) {
      const code = codeOf(error);
      if (code === 'invalid-option' && refusal !== undefined) store.say(refusal);
      else if (code === 'clip-closed' && store.get().tracked?.clip === this.clip) store.say(strings.notices.notReady);
      else if (code !== 'cancelled' && code !== 'clip-closed') report(store, reported(error));
      return false;
    } finally {
      this.#forget(said);
      keeper.settled();
      for (const index of frames) this.#stale.add(index);
      await this.#readAnnotations(frames).catch(() => undefined);
      this.#ended(reach > 0 ? null : cause);
    }
  }

  /** Takes back what points to an object in a frame if nothing is there. Returns whether it did. `count`: what {@link count} was then. */
  async withoutNothing(index: number, object: number, count: number): Promise<boolean> {
    const labels = await this.#now.labels(index).then((frame) => frame.labels, () => null);
    const number = this.#base.objects.find((one) => one.number === object)?.became ?? object;
    if (labels === null || labels.includes(number)) return false;
    // What was said since stays.
    if (this.#count === count) await this.undo();
    else await this.say((clip) => clip.clear({ frame: index, object }), (clip) => clip, { cause: 'undone', frames: [index] });
    return true;
  }

  /** How many commands were given. */
  get count(): number {
    return this.#count;
  }

  undo(): Promise<void> {
    return this.#move('undone', (clip) => this.#steps.undo > 0 && clip.undo());
  }

  redo(): Promise<void> {
    return this.#move('redone', (clip) => clip.steps.waiting === 0 && clip.steps.redo > 0 && clip.redo());
  }

  /**
   * Segments a range of frames. Drafts of masks are shown if there are none. Resolves when all masks are there.
   */
  async segment(): Promise<void> {
    const { store, keeper } = this.#parts;
    if (this.#package === null) {
      this.#isStarting = true;
      this.#show({ run: { phase: 'working', stage: 'pairs', left: null, labelled: 0 } });
      await this.opened;
      if (!this.#isStarting) return this.#show({ run: { phase: 'cancelled' } });
      this.#isStarting = false;
    }
    const { tracked, settings: { motions, quality, subject, longestSide } } = store.get();
    if (tracked?.clip !== this.clip) return;
    const { first, last } = tracked.range;
    const isAlone = tracked.frames.every((frame, index) => frame === null || (index >= first && index <= last));
    const isFirst = !isTracked(tracked);
    this.#longestSide = isAlone ? longestSide : null;
    this.#begin('found');
    if (!tracked.clip.sample) keeper.said();
    const isFloor = this.#steps.undo === 0;
    const isCorrected = tracked.status.slice(first, last + 1).some(({ annotated, accepted }) => annotated || accepted) || tracked.objects.some(({ number, became }) => number !== became);
    const step = this.#now.segment({ first, last, motions, quality, subject, drafts: isFirst });
    const range = { step, time: new TimeLeft(0, last - first + 1), isEnded: false };
    this.#range = range;
    this.#show({ run: { phase: 'working', stage: 'pairs', left: null, labelled: 0 }, previews: tracked.frames, solved: 0 });
    try {
      await step;
      if (isFloor && this.#said.length === 0) this.#found = this.#now.steps.undo;
      this.#longestSide = null;
      await this.#readLabels(first, last);
      if (this.#isClosed || this.#range !== range) return;
      this.#range = null;
      const notes = this.#frames.same || range.isEnded ? undefined : (await this.#now.tracks()).notes;
      const changed = lengthOf({ first, last });
      this.#show({ run: range.isEnded ? { phase: 'cancelled' } : { phase: 'done', cause: this.#frames.same ? 'same' : isCorrected ? 'repeated' : 'found', changed, notes: notes ?? [] } });
    } catch (error) {
      if (this.#isClosed) return;
      const isCancelled = codeOf(error) === 'cancelled' || range.isEnded;
      if (!isCancelled) report(store, reported(error));
      // What was read before a frame that could not be read has masks.
      await this.#readLabels(first, last).catch(() => undefined);
      this.#show({ run: { phase: isCancelled ? 'cancelled' : 'failed' } });
    } finally {
      this.#longestSide = null;
      if (this.#range === range) this.#range = null;
      this.#isUnderWay = this.#said.length > 0;
      keeper.settled();
      if (!this.#isClosed) this.#parts.shown.ended();
    }
  }

  /** Ends the range that is being segmented after the frames that are solved, or takes back what is being carried. */
  cancel(): void {
    const { tracked } = this.#parts.store.get();
    if (this.#isStarting) return void (this.#isStarting = false);
    if (this.#range === null && this.#said.length === 0) return void (this.#isUnderWay && this.undo());
    if (this.#range === null) {
      if (this.#said.length === 1) this.#cause = 'undone';
      return this.#said[0]!.step.cancel();
    }
    if (this.#range.isEnded || isTracked(tracked)) return this.#range.step.cancel();
    this.#range.isEnded = true;
    this.#now.finish();
    this.#show({ run: { phase: 'working', stage: 'labels', left: null, labelled: 0 } });
  }

  get #now(): PackageClip {
    if (this.#package === null) throw new PageError('not-ready', strings.notices.notReady);
    return this.#package;
  }

  async #open({ known = null, restored, at = 0 }: Remembered, after: Promise<unknown>): Promise<void> {
    const { segmenter, keeper } = this.#parts;
    const { markUnknown } = this;
    await after;
    const clip = await segmenter.openClip(this.#frames, { journal: keeper.journal, markUnknown });
    this.#package = clip;
    if (restored !== undefined) {
      await settledAll(clip);
      await clip.restore(restored);
    }
    if (this.#isClosed) return;
    clip.subscribe((event) => this.#hear(event));
    const frames = clip.frames.map(({ revision }, index) => (revision > 0 && known?.revisions[index] === revision ? (known.frames[index] ?? null) : null));
    this.#base = { ...this.#base, frames, status: clip.frames, objects: clip.objects };
    clip.frames.forEach(({ hasMasks }, index) => hasMasks && frames[index] === null && this.#stale.add(index));
    // The page may have been left before the number was written: without annotations, all steps are up to the first masks.
    if (this.#found === 0 && !isAnnotated({ status: clip.frames, objects: clip.objects })) this.#found = clip.steps.undo;
    // A frame that cannot be read keeps nothing else from being opened.
    const first = this.#stale.has(at) ? await clip.labels(at).catch(() => null) : null;
    if (first !== null && this.#stale.delete(at)) this.#take(at, masksOf(first));
    await this.#readAnnotations(this.#annotatedFrames());
    this.#isUnderWay = clip.steps.waiting > 0;
    if (this.#isUnderWay) this.#cause = 'corrected';
    const { run, solved, before } = this.tracked;
    this.#show({ run, solved, before });
    void this.#ask();
  }

  #hear(event: ClipEvent): void {
    if (this.#isClosed) return;
    const { store } = this.#parts;
    switch (event.type) {
      case 'frames':
        return this.#changed(event.frames);
      case 'objects':
      case 'settled':
        this.#base = { ...this.#base, status: this.#now.frames, objects: this.#now.objects };
        // What was said before the clip was opened has taken effect.
        return event.type === 'settled' && this.#isUnderWay && this.#said.length === 0 ? this.#ended(null) : this.#show();
      case 'draft': {
        const { tracked } = store.get();
        const { index } = event.frame;
        if (this.#range === null || tracked === null || tracked.frames[index] !== null) return;
        return this.#show({ previews: tracked.previews.with(index, masksOf(event.frame)) });
      }
      case 'progress':
        return this.#progress(event);
      case 'paused':
        return report(store, event.error);
      case 'closed':
        return void (event.reason.code === 'clip-closed' || report(store, event.reason));
      case 'kept':
      case 'unkept':
      case 'revived':
        return;
    }
  }

  /** Labels of frames have changed, or frames have no masks any more. */
  #changed(indices: readonly number[]): void {
    const status = this.#now.frames;
    const hasMasks = (index: number): boolean => status[index]?.hasMasks === true;
    for (const index of indices) {
      this.#moved?.add(index);
      if (!hasMasks(index)) this.#stale.delete(index);
      else for (const frames of [this.#stale, this.#fresh]) frames.add(index);
    }
    this.#base = { ...this.#base, status, frames: this.#base.frames.map((frame, index) => (hasMasks(index) ? frame : null)) };
    void this.#ask();
  }

  #progress({ stage, frame, done, of }: Extract<ClipEvent, { type: 'progress' }>): void {
    if (stage === 'pairs') {
      const range = this.#range;
      if (range === null || range.isEnded || of === undefined) return;
      return this.#show({ run: { phase: 'working', stage, left: range.time.at(done), labelled: 0 }, solved: done });
    }
    if (this.#reached === null || this.#range !== null) return;
    this.#reached.frames.add(frame);
    this.#show({ run: this.#correcting() });
  }

  /** How far corrections have come. A frame may be read again: first it tells what objects look like. */
  #correcting(): ClipRun {
    if (this.#reached === null) return { phase: 'working', stage: 'corrections', left: null, labelled: 0 };
    const { frames, of, time } = this.#reached;
    const labelled = Math.min(frames.size, of);
    return { phase: 'working', stage: 'corrections', left: time.at(labelled), labelled, of };
  }

  /** What follows is compared with the masks as they are now, unless something is under way. */
  #begin(cause: DoneCause, kept = 0): void {
    this.#cause = cause;
    this.#kept = kept;
    this.#isUnderWay = true;
    this.#moved = null;
    if (this.#said.length === 0) this.#parts.store.clip({ before: this.state.frames });
  }

  /** Goes back or forth in what was done, one move after another. `move` is `false` if there is nothing to move to. */
  #move(cause: DoneCause, move: (clip: PackageClip) => false | Promise<boolean>): Promise<void> {
    if (this.#package === null || this.#isClosed) return Promise.resolve();
    this.#moves += 1;
    this.#show();
    this.#moving = this.#moving.then(async () => {
      const isMoved = await this.#moveNow(cause, move);
      this.#moves -= 1;
      if (isMoved) this.#ended(null);
      else this.#show();
    });
    return this.#moving;
  }

  async #moveNow(cause: DoneCause, move: (clip: PackageClip) => false | Promise<boolean>): Promise<boolean> {
    const { keeper } = this.#parts;
    const moving = !this.#isClosed && move(this.#now);
    if (moving === false) return false;
    this.#begin(cause);
    this.#moved = new Set();
    keeper.said();
    const isMoved = await moving.catch(() => false);
    keeper.settled();
    if (isMoved) await this.#readAnnotations(this.#annotatedFrames()).catch(() => undefined);
    else this.#isUnderWay = this.#said.length > 0;
    return isMoved;
  }

  #forget(said: Said): void {
    this.#said = this.#said.filter((one) => one !== said);
  }

  /** Says that all is done when all has taken effect and is on screen. `cause`: of what has changed no masks. */
  #ended(cause: DoneCause | null): void {
    if (this.#isClosed) return;
    if (this.#said.length === 0) this.#fresh.clear();
    if (this.#stale.size > 0) void this.#ask();
    const { tracked } = this.#parts.store.get();
    if (tracked === null || this.#said.length > 0 || this.#range !== null) return this.#show();
    if (cause !== null && !this.#isUnderWay) return this.#show({ run: { phase: 'done', cause, changed: 0 } });
    if (this.#stale.size > 0 || this.#isAsking || this.#now.steps.waiting > 0) return this.#show();
    this.#isUnderWay = false;
    this.#reached = null;
    const changed = this.#moved?.size ?? this.#base.frames.filter((frame, index) => frame !== tracked.before[index]).length;
    this.#show({ run: { phase: 'done', cause: this.#cause, changed, kept: this.#kept } });
  }

  /** Asks for the labels of all frames that have changed, one after another. */
  async #ask(): Promise<void> {
    if (this.#isAsking || this.#package === null) return;
    this.#isAsking = true;
    try {
      for (let index = this.#next(); index !== null && !this.#isClosed; index = this.#next()) {
        this.#stale.delete(index);
        this.#fresh.delete(index);
        this.#asked.add(index);
        const frame = await this.#now.labels(index).catch(() => null);
        if (frame === null || this.#isClosed) continue;
        this.#asked.delete(index);
        this.#take(index, masksOf(frame));
      }
    } finally {
      this.#isAsking = false;
    }
    if (this.#isUnderWay && this.#stale.size === 0) this.#ended(null);
  }

  /** The frame to ask for: on screen, else while a step is under way one that it has just changed, so that no labels keep it from going on. */
  #next(): number | null {
    const { timeline } = this.#parts.store.get();
    const waits = this.#stale.has(timeline?.first ?? -1) ? timeline!.first : this.#stale.has(timeline?.second ?? -1) ? timeline!.second : null;
    if (waits !== null) return waits;
    const [any] = this.#said.length > 0 ? this.#fresh : this.#stale;
    return any ?? null;
  }

  /** The masks of a frame are there. `said`: what they have taken in. */
  #take(index: number, frame: TrackedFrame, said: Said | null = null): void {
    if (this.#isClosed) return;
    const { timeline } = this.#parts.store.get();
    const before = this.#parts.store.get().tracked?.before[index] ?? null;
    const now = unchanged(before, unchanged(this.#base.frames[index], frame));
    this.#base = { ...this.#base, frames: this.#base.frames.with(index, now) };
    if (said !== null) said.effect = withoutFrames(said.effect);
    const onScreen = index === timeline?.first || index === timeline?.second;
    if (!onScreen && performance.now() - this.#lastShown < OFTEN && this.#stale.size > 0) return;
    this.#show();
  }

  /** The labels of all frames of a range that was segmented, which are shown as they come. */
  async #readLabels(first: number, last: number): Promise<void> {
    const isFirst = this.#range !== null;
    let labelled = 0;
    const { timeline } = this.#parts.store.get();
    const all = Array.from({ length: last - first + 1 }, (_, k) => first + k).filter((index) => this.#now.frames[index]?.hasMasks);
    all.sort((one, other) => Number(other === timeline?.first) - Number(one === timeline?.first) || one - other);
    for (const index of all) {
      if (this.#isClosed) return;
      this.#stale.delete(index);
      this.#asked.add(index);
      const frame = masksOf(await this.#now.labels(index));
      this.#asked.delete(index);
      labelled += 1;
      this.#base = { ...this.#base, frames: this.#base.frames.with(index, unchanged(this.#base.frames[index], frame)) };
      const { tracked } = this.#parts.store.get();
      if (tracked === null || (performance.now() - this.#lastShown < OFTEN && index !== timeline?.first)) continue;
      const previews = tracked.previews.map((shown, at) => this.#base.frames[at] ?? shown);
      this.#show({ previews, ...(isFirst && { run: { phase: 'working', stage: 'labels', left: null, labelled } }), solved: all.length });
    }
  }

  #annotatedFrames(): number[] {
    const { annotated } = this.#base;
    return this.#now.frames.flatMap((status, index) => (status.annotated || annotated.has(index) ? [index] : []));
  }

  /** What a person has annotated in frames. */
  async #readAnnotations(frames: readonly number[]): Promise<void> {
    const read = new Map<number, Annotated>();
    for (const index of frames) {
      const objects = new Set<number>();
      const prompts: Prompt[] = [];
      for (const one of await this.#now.annotations(index)) {
        if ('labels' in one) for (const label of one.labels) objects.add(label);
        else objects.add(one.object);
        if ('clicks' in one || 'box' in one) prompts.push({ object: one.object, clicks: one.clicks ?? [], box: one.box ?? null });
      }
      read.set(index, { objects: [...objects].filter(isObject), prompts });
    }
    const annotated = new Map([...this.#base.annotated, ...read].filter(([, { objects }]) => objects.length > 0));
    this.#base = { ...this.#base, annotated };
  }

  /** Puts what is known into the state. */
  #show(change: Partial<Tracked> = {}): void {
    if (this.#isClosed || this.#parts.store.get().tracked?.clip !== this.clip) return;
    this.#lastShown = performance.now();
    const known = this.#known;
    // What is undone is not marked as a change.
    const isUndone = this.#moved !== null && this.#cause === 'undone';
    this.#parts.shown.clip({ ...known, ...(isUndone && { before: known.frames }), ...change });
  }

  /** What of the state is the clip's own. */
  get #known(): Pick<Tracked, keyof ClipState | 'nextObject' | 'steps' | 'isMoving'> {
    const isMoving = this.#moves > 0 || (this.#isUnderWay && this.#moved !== null);
    return { ...this.state, nextObject: this.#package?.nextObject ?? 1, steps: this.#steps, isMoving };
  }

  /** The first masks are no step that a person would take back. */
  get #steps(): Tracked['steps'] {
    const { undo = 0, redo = 0, waiting = 0 } = this.#package?.steps ?? {};
    return { undo: Math.max(0, undo + waiting - (this.#range === null ? 0 : 1) - this.#found), redo };
  }
}

/** The effect on everything but the masks, which are the clip's own now. */
function withoutFrames(effect: Effect): Effect {
  return (clip) => ({ ...effect({ ...clip, frames: [] }), frames: clip.frames });
}

/** Waits until a clip has done all that was said before it was opened. */
async function settledAll(clip: PackageClip): Promise<void> {
  while (clip.steps.waiting > 0) {
    await new Promise<void>((resolve) => {
      const leave = clip.subscribe(({ type }) => {
        if (type !== 'settled' && type !== 'paused' && type !== 'closed') return;
        leave();
        resolve();
      });
    });
  }
}

function reported(error: unknown): unknown {
  const code = codeOf(error);
  if (code === 'object-locked') return new PageError(code, strings.notices.locked);
  return code === 'invalid-input' ? new PageError('other-state', strings.notices.otherState) : error;
}
