//! What the page does when it is asked to: open frames, choose them from a clip, segment, correct, cancel. Views call these and read
//! the state; every failure ends as a notice in the state, and the page goes on working.

import { WHOLE } from './camera.js';
import { type Clip, looksLikeFilm, openClip } from './clips/clip.js';
import { Correcting, isPending } from './correcting.js';
import { codeOf, sentenceOf } from './errors.js';
import { type LoadedFrame, filesByName, frameFromBlob, frameFromUrl } from './frames.js';
import { openFolder } from './clips/folder.js';
import { LiveView } from './live.js';
import { type Sample, SAMPLES } from './samples.js';
import { Segmenting } from './segmenting.js';
import { sourceOfFilm } from './sources.js';
import { type Film, FRESH, type FramePair, type Settings, type Slot, type Store } from './state.js';
import { strings } from './strings.js';

/** A film is opened at its start, with so many frames between the two. */
const FRAMES_APART = 1;

export class Session {
  readonly #store: Store;
  readonly #segmenting = new Segmenting();
  readonly correcting: Correcting;
  readonly #live: LiveView;
  /** Counts what the user opened, so that a slow decoding never overtakes a later one. */
  #opened = 0;

  constructor(store: Store) {
    this.#store = store;
    this.correcting = new Correcting(store, this.#segmenting, (error) => this.#fail(error));
    this.#live = new LiveView(
      store,
      () => this.correcting.leave(),
      (error) => this.#fail(error),
    );
  }

  openSample(sample: Sample = SAMPLES[0]): Promise<void> {
    return this.#open(async () => {
      const { first, second } = sample;
      const { longestSide } = this.#store.get().settings;
      const [a, b] = await Promise.all([
        frameFromUrl(first, 'first.png', longestSide),
        frameFromUrl(second, 'second.png', longestSide),
      ]);
      this.#close(this.#store.get().film?.clip);
      return { first: a, second: b };
    });
  }

  /**
   * Opens files. A video, or more than two images, is a film to choose from; two images make a new pair, in the order of their
   * names; one goes into `slot`, or, where none is named, into the slot that is empty, or begins a new pair.
   */
  openFiles(files: Iterable<File>, slot: Slot | null = null): Promise<void> {
    const given = [...files];
    const film = given.find(looksLikeFilm);
    if (film !== undefined) return this.#openFilm(() => openClip(film), film);
    const sorted = filesByName(given.filter((file) => file.type.startsWith('image/') || given.length <= 2));
    const [one, two] = sorted;
    if (one === undefined) {
      this.say(strings.notices.noFiles, 'no-image');
      return Promise.resolve();
    }
    if (sorted.length > 2) return this.#openFilm(() => openFolder(sorted));
    return this.#open(async () => {
      const { longestSide } = this.#store.get().settings;
      if (two !== undefined) {
        const [first, second] = await Promise.all([
          frameFromBlob(one, one.name, longestSide),
          frameFromBlob(two, two.name, longestSide),
        ]);
        this.#close(this.#store.get().film?.clip);
        return { first, second };
      }
      const frame = await frameFromBlob(one, one.name, longestSide);
      const { pair } = this.#store.get();
      if (slot !== null) return { ...pair, [slot]: frame };
      if (pair.first !== null && pair.second === null) return { ...pair, second: frame };
      return { first: frame, second: null };
    });
  }

  /** Chooses a frame of the film that is open; frames outside are the nearest inside. */
  choose(slot: Slot, index: number): Promise<void> {
    const { film, settings } = this.#store.get();
    if (film === null) return Promise.resolve();
    const chosen = Math.min(Math.max(Math.round(index), 0), film.clip.count - 1);
    if (film[slot] === chosen) return Promise.resolve();
    this.#store.set({ film: { ...film, [slot]: chosen } });
    return this.#open(async () => {
      const frame = await frameOf(film, chosen, settings.longestSide);
      return { ...this.#store.get().pair, [slot]: frame };
    });
  }

  /** Moves both frames along the film. */
  step(by: number): Promise<void> {
    const { film, settings } = this.#store.get();
    if (film === null) return Promise.resolve();
    const { clip } = film;
    const most = clip.count - 1;
    const shift = Math.min(Math.max(by, -Math.min(film.first, film.second)), most - Math.max(film.first, film.second));
    if (shift === 0) return Promise.resolve();
    const [first, second] = [film.first + shift, film.second + shift];
    this.#store.set({ film: { ...film, first, second } });
    return this.#open(async () => ({
      first: await frameOf(film, first, settings.longestSide),
      second: await frameOf(film, second, settings.longestSide),
    }));
  }

  /** Switches the camera on or off. */
  async toggleLive(): Promise<void> {
    if (this.#store.get().live !== null) return this.#live.stop();
    this.#opened += 1;
    this.#stop();
    this.#close(this.#store.get().film?.clip);
    this.#store.set({ run: { phase: 'opening' }, notice: null });
    await this.#live.start();
  }

  /** The first frame becomes the second. */
  swap(): void {
    const { pair, film } = this.#store.get();
    this.#opened += 1;
    if (film !== null) this.#store.set({ film: { ...film, first: film.second, second: film.first } });
    this.#take({ first: pair.second, second: pair.first });
  }

  /** Takes other settings and, where there is a pair, segments it again. */
  change(settings: Partial<Settings>): void {
    const { settings: before, insisting } = this.#store.get();
    this.#store.set({ settings: { ...before, ...settings }, insisting: settings.motions === undefined ? insisting : null });
    if (this.#store.get().live === null) void this.segment();
  }

  /** So many motions in this pair; in others as many as before. */
  insist(motions: number): void {
    const { settings, insisting } = this.#store.get();
    this.change({ motions });
    this.#store.set({ insisting: insisting ?? settings.motions });
  }

  /** Takes up again what was cancelled. */
  again(): void {
    if (this.correcting.isCurrent()) this.correcting.settle(isPending(this.#store.get()) ? 'solved' : 'found');
    else void this.segment();
  }

  /** Segments the pair with the settings, or says what is missing. */
  async segment(): Promise<void> {
    const { pair, settings } = this.#store.get();
    const { first, second } = pair;
    this.correcting.interrupt();
    if (first === null || second === null) {
      this.#segmenting.cancel();
      this.#store.set({ run: { phase: 'idle' } });
      return;
    }
    this.#store.set({ run: { phase: 'working', work: 'segmenting', stage: '', index: 0, of: 0 } });
    const began = performance.now();
    try {
      // Of a new pair something is seen soon: what fast work finds, until better work is done.
      if (settings.quality === 'best' && this.#store.get().result === null) {
        const preview = await this.#segmenting.run({ first, second }, { ...settings, quality: 'fast' });
        if (preview === null) return;
        await this.correcting.take(preview, { first, second }, began, false);
      }
      const segmentation = await this.#segmenting.run({ first, second }, settings, ({ stage, index, of }) =>
        this.#store.set({ run: { phase: 'working', work: 'segmenting', stage, index, of } }),
      );
      if (segmentation !== null) await this.correcting.take(segmentation, { first, second }, began, true);
    } catch (error) {
      this.#fail(error);
    }
  }

  /** Chooses the mask that is worked on. */
  select(mask: number | null): void {
    this.#store.look({ selected: mask });
  }

  /** Stops at once; an older result stays. */
  cancel(): void {
    const { run } = this.#store.get();
    if (run.phase !== 'working' && run.phase !== 'opening') return;
    this.#opened += 1;
    this.#stop();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  #stop(): void {
    this.#segmenting.cancel();
    this.correcting.interrupt();
  }

  /** Says something to the user; with a code it is an error. */
  say(sentence: string, code: string | null = null): void {
    this.#store.set({ notice: { sentence, code } });
  }

  #openFilm(load: () => Promise<Clip>, file: File | null = null): Promise<void> {
    return this.#open(async (current) => {
      const clip = await load();
      if (!current()) {
        clip.close();
        return this.#store.get().pair;
      }
      try {
        const second = Math.min(FRAMES_APART, clip.count - 1);
        const { longestSide } = this.#store.get().settings;
        const film = { clip, source: file === null ? null : await sourceOfFilm(file), first: 0, second };
        const frames = { first: await frameOf(film, 0, longestSide), second: await frameOf(film, second, longestSide) };
        if (!current()) throw new Error('overtaken');
        this.#close(this.#store.get().film?.clip);
        this.#store.set({ film });
        return frames;
      } catch (error) {
        clip.close();
        throw error;
      }
    });
  }

  #close(clip: Clip | undefined): void {
    if (clip === undefined) return;
    clip.close();
    this.#store.set({ film: null });
  }

  async #open(load: (current: () => boolean) => Promise<FramePair>): Promise<void> {
    const turn = ++this.#opened;
    const before = this.#store.get().run;
    this.#stop();
    this.#live.stop();
    this.#store.set({ run: { phase: 'opening' }, notice: null });
    try {
      const pair = await load(() => turn === this.#opened);
      if (turn === this.#opened) this.#take(pair);
    } catch (error) {
      if (turn !== this.#opened) return;
      this.#fail(error);
      // What was open stays open; where work on it was interrupted, it is taken up again.
      if (before.phase === 'working' && before.work === 'segmenting') void this.segment();
      else this.correcting.settle(before.phase === 'done' ? before.after : 'found');
    }
  }

  #take(pair: FramePair): void {
    this.correcting.leave();
    this.#stop();
    const { look, pair: before, camera } = this.#store.get();
    const only: Slot = pair.first === null && pair.second !== null ? 'second' : 'first';
    const view = pair.first !== null && pair.second !== null && look.view === 'split' ? 'split' : only;
    const sameSize = before.first !== null && pair.first !== null && before.first.width === pair.first.width && before.first.height === pair.first.height;
    this.#store.set({
      pair,
      run: { phase: 'idle' },
      ...this.correcting.arrival(pair),
      look: { ...look, ...FRESH, view },
      camera: sameSize ? camera : WHOLE,
    });
    // Nobody draws the old frames any more: give their memory back now, not at the next collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    if (this.correcting.isCurrent()) this.correcting.settle('restored');
    else void this.segment();
  }

  #fail(error: unknown): void {
    this.#store.set({ run: { phase: 'failed' }, notice: { sentence: sentenceOf(error), code: codeOf(error) } });
  }
}

/** A frame of the film, known by the film and its number there. */
async function frameOf({ clip, source }: Film, index: number, longestSide: number): Promise<LoadedFrame> {
  const frame = await clip.frame(index, longestSide);
  return source === null ? frame : { ...frame, source: `${source} ${index}` };
}
