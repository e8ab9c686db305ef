//! Which masks are on screen: those of the pair or those of the clip, of which kind, in which version. They are in the state, where this
//! alone replaces one kind by another.

import type { Kind } from '../result/masks.js';
import { frameOf, resultOf } from '../state/objects.js';
import type { FramePair } from '../state/pair.js';
import { FRESH, type Look, type Run, type State, type Store, isPassing } from '../state/state.js';
import { type Tracked, describedIn, isDrafting, isSeen } from '../state/tracked.js';
import { type PairSegmenting, STARTING } from './pair/segmenting.js';

export class Shown {
  readonly #store: Store;
  readonly #segmenting: PairSegmenting;
  /** Whether a person chose the kind of masks: then others do not take its place when they are found. */
  #chosen = false;

  constructor(store: Store, segmenting: PairSegmenting) {
    this.#store = store;
    this.#segmenting = segmenting;
    // Objects of drafts have other numbers, however the run on them ends.
    store.subscribe((now, before) => {
      const sameClip = now.tracked?.clip === before.tracked?.clip;
      if (sameClip && now.look.kind === 'objects' && isDrafting(now.tracked) !== isDrafting(before.tracked)) this.select(null);
    });
  }

  /** Shows the kind of masks that a person chooses. */
  choose(kind: Kind): void {
    this.#chosen = kind !== 'objects';
    this.kind(kind);
  }

  /** Shows masks of this kind. Mask numbers change meaning, so choices that refer to them are reset. */
  kind(kind: Kind): void {
    const { look, pair, tracked, live } = this.#store.get();
    if (live !== null || look.kind === kind || (kind === 'objects' && !isSeen(tracked))) return;
    const { hidden, solo, stabilised, selected, among } = FRESH;
    if (kind !== 'objects' && look.kind !== 'objects') return this.#store.look({ kind, hidden, solo, stabilised, selected, among });
    this.pair(pair, { ...look, ...FRESH, kind });
  }

  /** Selects a mask alone. */
  select(mask: number | null): void {
    const { selected, among } = this.#store.get().look;
    if (selected !== mask || among !== null) this.#store.look({ selected: mask, among: null });
  }

  /** Shows a pair with the masks of the clip, or its own, which are found anew. */
  pair(pair: FramePair, look: Look, others: Partial<State> = {}): void {
    const left = this.#store.get().tracked;
    const { tracked, playing, scrubbing } = { ...this.#store.get(), ...others };
    if (left !== null && tracked?.clip !== left.clip) this.#chosen = false;
    this.#segmenting.stop();
    if (look.kind === 'objects' && tracked !== null) {
      const result = resultOf(tracked, pair);
      this.#store.set({ ...others, pair, result, run: { phase: 'done', cause: 'tracked' }, look: { ...look, ...describedIn(tracked) } });
      return;
    }
    const passing = isPassing({ playing, scrubbing });
    const starting: Run = pair.first !== null && pair.second !== null && !passing ? STARTING : { phase: 'idle' };
    const { names, classes, colours } = FRESH;
    this.#store.set({ ...others, pair, result: null, run: starting, look: { ...look, names, classes, colours } });
    if (!passing) void this.#segmenting.segment();
  }

  /** Takes what has changed of the clip, and shows its masks if there are some of a frame on screen. */
  clip(change: Partial<Tracked>): void {
    const { tracked: before, look } = this.#store.get();
    if (before === null) return;
    const tracked = { ...before, ...change };
    const described = change.objects === undefined || change.objects === before.objects ? {} : this.#described(tracked, look);
    // At once, so that the focus goes on from a row that is gone to the one that is selected.
    this.#store.set({ tracked, look: { ...look, ...described } });
    this.#objects(before);
  }

  /** Names and colours of objects, and what became of the one that is selected. */
  #described(tracked: Tracked, { kind, selected }: Look): Partial<Look> {
    const into = tracked.objects.find(({ number }) => number === selected)?.became;
    const now = into === undefined ? selected : into === 0 ? null : into;
    return { selected: now, ...(kind === 'objects' && describedIn(tracked)) };
  }

  /** Shows the masks of the clip as soon as there are some of a frame on screen, and whenever these change. `before`: what there was. */
  #objects(before: Tracked): void {
    const { look, pair, tracked } = this.#store.get();
    if (tracked === null) return;
    const frames = [pair.first, pair.second].filter((frame) => frame !== null);
    const came = frames.some((frame) => frameOf(before, frame) === null && frameOf(tracked, frame) !== null);
    if (came && !this.#chosen) this.kind('objects');
    const changed = frames.some((frame) => frameOf(tracked, frame) !== frameOf(before, frame));
    if (look.kind === 'objects' && changed) this.#store.set({ result: resultOf(tracked, pair) });
  }

  /** Shows no drafts any more when a run on the clip has ended, and the masks of the pair if there are no others. */
  ended(): void {
    const { look, tracked, pair } = this.#store.get();
    if (look.kind !== 'objects' || tracked === null) return;
    if (isSeen(tracked)) this.#store.set({ result: resultOf(tracked, pair) });
    else this.kind('groups');
  }
}
