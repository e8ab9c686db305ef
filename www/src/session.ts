//! What the page does when it is asked to: open frames, swap them, segment, cancel. Views call these and read the state; every
//! failure ends as a notice in the state, and the page goes on working.

import { filesByName, frameFromBlob, frameFromUrl } from './frames.js';
import { codeOf, sentenceOf } from './errors.js';
import { INTEL_TWO_CARS, type Sample } from './samples.js';
import { Segmenting } from './segmenting.js';
import type { FramePair, Settings, Slot, Store } from './state.js';
import { strings } from './strings.js';

export class Session {
  readonly #store: Store;
  readonly #segmenting = new Segmenting();
  /** Counts what the user opened, so that a slow decoding never overtakes a later one. */
  #opened = 0;

  constructor(store: Store) {
    this.#store = store;
  }

  openSample(sample: Sample = INTEL_TWO_CARS): Promise<void> {
    return this.#open(async () => {
      const { first, second } = sample;
      const [a, b] = await Promise.all([frameFromUrl(first, 'first.png'), frameFromUrl(second, 'second.png')]);
      return { first: a, second: b };
    });
  }

  /**
   * Opens files. Two or more make a new pair, in the order of their names; one goes into `slot`, or, where none is named, into the
   * slot that is empty, or begins a new pair.
   */
  openFiles(files: Iterable<File>, slot: Slot | null = null): Promise<void> {
    const sorted = filesByName(files);
    const [one, two] = sorted;
    if (one === undefined) {
      this.#store.set({ notice: { sentence: strings.notices.noFiles, code: 'no-image' } });
      return Promise.resolve();
    }
    return this.#open(async () => {
      if (two !== undefined) {
        const [first, second] = await Promise.all([frameFromBlob(one, one.name), frameFromBlob(two, two.name)]);
        if (sorted.length > 2) {
          this.#store.set({ notice: { sentence: strings.notices.someUnused(sorted.length, one.name, two.name), code: null } });
        }
        return { first, second };
      }
      const frame = await frameFromBlob(one, one.name);
      const { pair } = this.#store.get();
      if (slot !== null) return { ...pair, [slot]: frame };
      if (pair.first !== null && pair.second === null) return { ...pair, second: frame };
      return { first: frame, second: null };
    });
  }

  /** The first frame becomes the second. */
  swap(): void {
    const { first, second } = this.#store.get().pair;
    this.#opened += 1;
    this.#take({ first: second, second: first });
  }

  /** Takes other settings and, where there is a pair, segments it again. */
  change(settings: Partial<Settings>): void {
    this.#store.set({ settings: { ...this.#store.get().settings, ...settings } });
    void this.segment();
  }

  /** Segments the pair with the settings, or says what is missing. */
  async segment(): Promise<void> {
    const { pair, settings } = this.#store.get();
    const { first, second } = pair;
    if (first === null || second === null) {
      this.#segmenting.cancel();
      this.#store.set({ run: { phase: 'idle' } });
      return;
    }
    this.#store.set({ run: { phase: 'working', stage: '', index: 0, of: 0 } });
    const began = performance.now();
    try {
      const segmentation = await this.#segmenting.run({ first, second }, settings, ({ stage, index, of }) =>
        this.#store.set({ run: { phase: 'working', stage, index, of } }),
      );
      if (segmentation === null) return;
      const { result, look } = this.#store.get();
      // A different number of motions has different labels: what was chosen by label no longer means anything.
      const sameLabels = result?.segmentation.count === segmentation.count && result.pair.first === first;
      this.#store.set({
        run: { phase: 'done' },
        result: { segmentation, pair: { first, second }, waited: performance.now() - began },
        look: sameLabels ? look : { ...look, hidden: new Set(), solo: null, still: null },
      });
    } catch (error) {
      this.#fail(error);
    }
  }

  /** Stops at once; an older result stays. */
  cancel(): void {
    const { run } = this.#store.get();
    if (run.phase !== 'working' && run.phase !== 'opening') return;
    this.#opened += 1;
    this.#segmenting.cancel();
    this.#store.set({ run: { phase: 'cancelled' } });
  }

  /** Says something to the user; with a code it is an error. */
  say(sentence: string, code: string | null = null): void {
    this.#store.set({ notice: { sentence, code } });
  }

  async #open(load: () => Promise<FramePair>): Promise<void> {
    const turn = ++this.#opened;
    const before = this.#store.get().run;
    this.#segmenting.cancel();
    this.#store.set({ run: { phase: 'opening' }, notice: null });
    try {
      const pair = await load();
      if (turn === this.#opened) this.#take(pair);
    } catch (error) {
      if (turn !== this.#opened) return;
      this.#fail(error);
      // What was open stays open; where its segmentation was interrupted, it is taken up again.
      const { pair, result } = this.#store.get();
      if (before.phase === 'working') void this.segment();
      else if (result !== null && result.pair.first === pair.first && result.pair.second === pair.second) {
        this.#store.set({ run: { phase: 'done' } });
      }
    }
  }

  #take(pair: FramePair): void {
    const { look, pair: before } = this.#store.get();
    const only: Slot = pair.first === null && pair.second !== null ? 'second' : 'first';
    this.#store.set({ pair, result: null, look: { ...look, frame: only, hidden: new Set(), solo: null, still: null } });
    // Nobody draws the old frames any more: give their memory back now, not at the next collection.
    for (const frame of [before.first, before.second]) if (frame !== pair.first && frame !== pair.second) frame?.bitmap.close();
    void this.segment();
  }

  #fail(error: unknown): void {
    this.#store.set({ run: { phase: 'failed' }, notice: { sentence: sentenceOf(error), code: codeOf(error) } });
  }
}
