//! Which masks are on screen: those of the open clip, drafts or not, of the frames that are seen. They are in the state, and change here alone.

import { frameOf, resultOf } from '../state/objects.js';
import type { FramePair } from '../state/pair.js';
import type { Look, State, Store } from '../state/state.js';
import { type Tracked, describedIn, isDrafting } from '../state/tracked.js';

export class Shown {
  readonly #store: Store;

  constructor(store: Store) {
    this.#store = store;
    // Objects of drafts have other numbers, however the run on them ends.
    store.subscribe((now, before) => {
      const sameClip = now.tracked?.clip === before.tracked?.clip;
      if (sameClip && isDrafting(now.tracked) !== isDrafting(before.tracked)) this.select(null);
    });
  }

  /** Selects a mask alone. */
  select(mask: number | null): void {
    const { selected, among } = this.#store.get().look;
    if (selected !== mask || among !== null) this.#store.look({ selected: mask, among: null });
  }

  /** Shows objects, not motions: what follows is about them. */
  objects(): void {
    if (this.#store.get().look.motions) this.#store.look({ motions: false });
  }

  /** Shows frames with the masks of their clip. */
  pair(pair: FramePair, look: Look, others: Partial<State> = {}): void {
    const { tracked } = { ...this.#store.get(), ...others };
    this.#store.set({ ...others, pair, result: resultOf(tracked, pair), look: { ...look, ...(tracked && describedIn(tracked)) } });
  }

  /** Takes what has changed of the clip, and shows the masks of the frames on screen. */
  clip(change: Partial<Tracked>): void {
    const { tracked: before, look } = this.#store.get();
    if (before === null) return;
    const tracked = { ...before, ...change };
    const described = change.objects === undefined || change.objects === before.objects ? {} : { ...describedIn(tracked), selected: becameOf(tracked, look.selected) };
    // At once, so that the focus goes on from a row that is gone to the one that is selected.
    this.#store.set({ tracked, look: { ...look, ...described } });
    this.#renew(before);
  }

  /** Shows no drafts any more when a run on the clip has ended. */
  ended(): void {
    const { tracked, pair } = this.#store.get();
    this.#store.set({ result: resultOf(tracked, pair) });
  }

  /** `before`: what was known of the clip. */
  #renew(before: Tracked): void {
    const { pair, tracked } = this.#store.get();
    const frames = [pair.first, pair.second].filter((frame) => frame !== null);
    if (tracked !== null && frames.some((frame) => frameOf(tracked, frame) !== frameOf(before, frame))) this.#store.set({ result: resultOf(tracked, pair) });
  }
}

/** What the selected object has become. */
function becameOf({ objects }: Tracked, selected: number | null): number | null {
  const into = objects.find(({ number }) => number === selected)?.became;
  return into === undefined ? selected : into === 0 ? null : into;
}
