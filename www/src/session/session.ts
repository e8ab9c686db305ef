//! What the page does: open frames, choose them from a clip, segment, correct, cancel. Views call these methods and read the state. Every
//! failure ends as a notice in the state, and the page stays usable.

import type { Clip } from '../clips/clip.js';
import { openFolder } from '../clips/folder.js';
import { openClip } from '../clips/open.js';
import { PageError, codeOf, sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { WHOLE } from '../drawing/viewport.js';
import { nameOfFile, selectOpenable } from '../frames/files.js';
import { frameFromBlob, frameFromUrl } from '../frames/frame.js';
import { SAMPLES, type Sample } from '../frames/samples.js';
import { type FramePair, type LoadedFrame, type Slot, type Timeline, timelineOf } from '../state/pair.js';
import type { Settings } from '../state/settings.js';
import { FRESH, type Run, type Store } from '../state/state.js';
import { Correcting, isCurrent, isPending } from './correcting.js';
import { LiveView } from './live.js';
import { Segmenting } from './segmenting.js';

/** Distance between the two frames when a clip is opened. */
const FRAMES_APART = 1;

/** The state of a run before its first stage. */
const STARTING: Run = { phase: 'working', work: 'segmenting', stage: '', index: 0, of: 0 };

export class Session {
  readonly #store: Store;
  readonly #segmenting = new Segmenting();
  readonly correcting: Correcting;
  readonly #live: LiveView;
  /** Incremented by each opening, so that a slow one never replaces a later one. */
  #opened = 0;

  constructor(store: Store) {
    this.#store = store;
    this.correcting = new Correcting(store, this.#segmenting, (error) => this.#fail(error));
    this.#live = new LiveView(store, (error) => this.#fail(error));
  }

  /** Opens a sample; `swapped`: with the second frame first. */
  openSample(sample: Sample = SAMPLES[0], swapped = false): Promise<void> {
    return this.#openFrames(
      () => Promise.all((swapped ? (['second', 'first'] as const) : (['first', 'second'] as const)).map((slot) => this.#frameOfSample(sample, slot))),
      pairOf,
    );
  }

  /**
   * Opens files. A video or more than two images is a clip to choose frames from. Two images make a new pair, in the order of their
   * names. One image goes into `slot`; without a slot, it becomes the missing second frame or the first of a new pair.
   */
  openFiles(files: Iterable<File> | Promise<Iterable<File>>, slot: Slot | null = null): Promise<void> {
    return this.#openFrames(
      async () => {
        const { video, images } = selectOpenable(await files);
        if (video !== null) return this.#startOf(await openClip(video));
        if (images.length > 2) return this.#startOf(await openFolder(images));
        if (images.length === 0) throw new PageError('no-image', strings.notices.noFiles);
        const { longestSide } = this.#store.get().settings;
        return Promise.all(images.map((image) => frameFromBlob(image, nameOfFile(image), longestSide)));
      },
      (frames, pair) => {
        if (frames.length === 2) return pairOf(frames);
        const [frame] = frames as [LoadedFrame];
        if (slot !== null) return { ...pair, [slot]: frame };
        return pair.first !== null && pair.second === null ? { ...pair, second: frame } : { first: frame, second: null };
      },
    );
  }

  /** Chooses a frame of the open clip; the index is clamped. */
  choose(slot: Slot, index: number): Promise<void> {
    const { timeline } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    return this.#goTo({ [slot]: Math.min(Math.max(Math.round(index), 0), timeline.clip.count - 1) });
  }

  /** Steps all frames that are of the clip. */
  step(by: number): Promise<void> {
    const { timeline } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip, first, second } = timeline;
    const places = [first, second].filter((place) => place !== null);
    const shift = Math.min(Math.max(by, -Math.min(...places)), clip.count - 1 - Math.max(...places));
    return this.#goTo({ first: first === null ? null : first + shift, second: second === null ? null : second + shift });
  }

  /** Switches the camera on or off. */
  toggleLive(): Promise<void> {
    if (this.#store.get().live !== null) return Promise.resolve(this.#live.stop());
    return this.#open(
      () => this.#live.start(),
      (show) => {
        this.correcting.keep();
        this.#stop();
        const { timeline } = this.#store.get();
        show();
        timeline?.clip.close();
      },
    );
  }

  /** Swaps the two frames. */
  swap(): void {
    const { first, second } = this.#store.get().pair;
    this.#invalidate();
    this.#setPair({ first: second, second: first });
  }

  /** Changes settings and segments the pair again. */
  change(settings: Partial<Settings>): void {
    const { settings: before, motionsElsewhere } = this.#store.get();
    this.#store.set({ settings: { ...before, ...settings }, motionsElsewhere: settings.motions === undefined ? motionsElsewhere : null });
    if (this.#store.get().live === null) void this.segment();
  }

  /** Sets the number of motions for this pair alone. */
  forceMotions(motions: number): void {
    const { settings, motionsElsewhere } = this.#store.get();
    this.change({ motions });
    this.#store.set({ motionsElsewhere: motionsElsewhere ?? settings.motions });
  }

  /** Resumes what was cancelled. */
  again(): void {
    if (isCurrent(this.#store.get())) this.correcting.settle(isPending(this.#store.get()) ? 'solved' : 'found');
    else void this.segment();
  }

  /** Segments the pair with the current settings; idle if a frame is missing. */
  async segment(): Promise<void> {
    const { pair, settings } = this.#store.get();
    const { first, second } = pair;
    this.correcting.interrupt();
    if (first === null || second === null) {
      this.#segmenting.cancel();
      this.#store.set({ run: { phase: 'idle' } });
      return;
    }
    this.#store.set({ run: STARTING });
    const began = performance.now();
    try {
      // A fast preview of a new pair, shown until the best result is ready.
      if (settings.quality === 'best' && this.#store.get().result === null) {
        const preview = await this.#segmenting.run({ first, second }, { ...settings, quality: 'fast' });
        if (preview === null) return;
        await this.correcting.accept(preview, { first, second }, began, false);
      }
      const segmentation = await this.#segmenting.run({ first, second }, settings, ({ stage, index, of }) =>
        this.#store.set({ run: { phase: 'working', work: 'segmenting', stage, index, of } }),
      );
      if (segmentation !== null) await this.correcting.accept(segmentation, { first, second }, began, true);
    } catch (error) {
      this.#fail(error);
    }
  }

  /** Selects a mask. */
  select(mask: number | null): void {
    this.#store.look({ selected: mask });
  }

  /** Stops at once; the last result stays. */
  cancel(): void {
    const { run, opening } = this.#store.get();
    if (opening) return this.#stopOpening();
    if (run.phase !== 'working') return;
    this.#stop();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  #stop(): void {
    this.#segmenting.cancel();
    this.correcting.interrupt();
  }

  /** Shows a notice; with a code it is an error. */
  say(sentence: string, code: string | null = null): void {
    this.#store.set({ notice: { sentence, code } });
  }

  /** The first two frames of a clip. */
  async #startOf(clip: Clip): Promise<LoadedFrame[]> {
    try {
      return [await this.#frameOf(clip, 0), await this.#frameOf(clip, Math.min(FRAMES_APART, clip.count - 1))];
    } catch (error) {
      clip.close();
      throw error;
    }
  }

  async #frameOf(clip: Clip, index: number): Promise<LoadedFrame> {
    return { ...(await clip.frame(index, this.#store.get().settings.longestSide)), origin: { clip, index } };
  }

  async #frameOfSample(sample: Sample, slot: Slot): Promise<LoadedFrame> {
    return { ...(await frameFromUrl(sample[slot], `${slot}.png`, this.#store.get().settings.longestSide)), origin: { sample, slot } };
  }

  /** Goes to other frames of the clip. The timeline moves at once; the pair changes when the frames are loaded. */
  #goTo(places: Partial<Pick<Timeline, Slot>>): Promise<void> {
    const { timeline, pair, opening } = this.#store.get();
    if (timeline === null) return Promise.resolve();
    const { clip } = timeline;
    const wanted: Timeline = { ...timeline, ...places };
    const shown = timelineOf(pair);
    const missing = (['first', 'second'] as const).flatMap((slot) => {
      const index = wanted[slot];
      return index === null || index === shown?.[slot] ? [] : [{ slot, index }];
    });
    if (missing.length === 0) {
      if (opening) this.#stopOpening();
      return Promise.resolve();
    }
    this.#store.set({ timeline: wanted });
    return this.#openFrames(
      async () => {
        const frames: LoadedFrame[] = [];
        for (const { index } of missing) frames.push(await this.#frameOf(clip, index));
        return frames;
      },
      (frames, now) => ({ ...now, ...Object.fromEntries(missing.map(({ slot }, k) => [slot, frames[k]])) }),
    );
  }

  /** Loads frames and puts them into the pair. */
  #openFrames(load: () => Promise<LoadedFrame[]>, place: (frames: LoadedFrame[], pair: FramePair) => FramePair): Promise<void> {
    return this.#open(
      load,
      (frames) => {
        this.#live.stop();
        this.#setPair(place(frames, this.#store.get().pair));
      },
      (frames) => {
        for (const { bitmap, origin } of frames) {
          bitmap.close();
          if (origin !== undefined && 'clip' in origin && origin.clip !== this.#store.get().timeline?.clip) origin.clip.close();
        }
      },
    );
  }

  /**
   * Opens something. The current pair stays, and work on it continues, until `take` is called with its replacement. The last request wins;
   * earlier ones are discarded.
   */
  async #open<T>(load: () => Promise<T>, take: (opened: T) => void, discard: (opened: T) => void = () => undefined): Promise<void> {
    const turn = this.#invalidate();
    this.#store.set({ opening: true, notice: null });
    try {
      const opened = await load();
      if (turn !== this.#opened) return discard(opened);
      this.#store.set({ opening: false });
      take(opened);
    } catch (error) {
      if (turn !== this.#opened) return;
      this.#stopOpening();
      this.say(sentenceOf(error), codeOf(error));
    }
  }

  /** Invalidates whatever is being opened. */
  #invalidate(): number {
    if (this.#store.get().live === null) this.#live.stop();
    return ++this.#opened;
  }

  /** Stops opening: the timeline returns to the frames on screen. */
  #stopOpening(): void {
    this.#invalidate();
    this.#store.set({ opening: false, timeline: timelineOf(this.#store.get().pair) });
  }

  #setPair(pair: FramePair): void {
    this.correcting.keep();
    this.#stop();
    const { look, pair: before, viewport, timeline: left } = this.#store.get();
    const only: Slot = pair.first === null && pair.second !== null ? 'second' : 'first';
    const complete = pair.first !== null && pair.second !== null;
    const view = complete && look.view === 'split' ? 'split' : only;
    const sameSize = before.first !== null && pair.first !== null && before.first.width === pair.first.width && before.first.height === pair.first.height;
    const timeline = timelineOf(pair);
    const restored = this.correcting.stateFor(pair);
    const current = isCurrent(restored);
    this.#store.set({
      pair,
      timeline,
      opening: false,
      ...restored,
      run: current ? { phase: 'done', cause: 'restored' } : complete ? STARTING : { phase: 'idle' },
      look: { ...look, ...FRESH, view },
      viewport: sameSize ? viewport : WHOLE,
    });
    // The old frames are no longer drawn: free their memory now, not at the next garbage collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    if (left !== null && left.clip !== timeline?.clip) left.clip.close();
    if (current) this.correcting.settle('restored');
    else void this.segment();
  }

  #fail(error: unknown): void {
    this.#store.set({ run: { phase: 'failed' }, notice: { sentence: sentenceOf(error), code: codeOf(error) } });
  }
}

function pairOf([first, second]: readonly LoadedFrame[]): FramePair {
  return { first: first ?? null, second: second ?? null };
}
