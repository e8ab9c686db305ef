//! Which masks are on screen: those of the pair or those of the clip, of which kind, in which version. They are in the state, where this
//! alone replaces one kind by another.

import { NO_EDITS } from '../correction/edits.js';
import type { Kind } from '../result/masks.js';
import { frameOf, resultOf } from '../state/objects.js';
import type { FramePair } from '../state/pair.js';
import { FRESH, type Look, type Run, type State, type Store, isCurrent, isPassing } from '../state/state.js';
import { type ClipRun, type Tracked, type Version, isDrafting, isSeen, versionOf } from '../state/tracked.js';
import type { Masks } from './pair/masks.js';
import { type PairSegmenting, STARTING } from './pair/segmenting.js';
import type { Solving } from './pair/solving.js';

export class Shown {
  readonly #store: Store;
  readonly #segmenting: PairSegmenting;
  readonly #solving: Solving;
  readonly #masks: Masks;

  constructor(store: Store, segmenting: PairSegmenting, solving: Solving, masks: Masks) {
    this.#store = store;
    this.#segmenting = segmenting;
    this.#solving = solving;
    this.#masks = masks;
    // Objects of drafts have other numbers, however the run on them ends.
    store.subscribe((now, before) => {
      const sameClip = now.tracked?.clip === before.tracked?.clip;
      if (sameClip && now.look.kind === 'objects' && isDrafting(now.tracked) !== isDrafting(before.tracked)) this.select(null);
    });
  }

  /** Shows masks of this kind. Mask numbers change meaning, so choices that refer to them are reset. */
  kind(kind: Kind): void {
    const { look, pair, tracked, live } = this.#store.get();
    if (live !== null || look.kind === kind || (kind === 'objects' && !isSeen(tracked))) return;
    const { hidden, solo, stabilised, selected, among } = FRESH;
    if (kind !== 'objects' && look.kind !== 'objects') return this.#store.look({ kind, hidden, solo, stabilised, selected, among });
    this.#masks.leave();
    this.pair(pair, { ...look, ...FRESH, kind });
  }

  /** Selects a mask alone. */
  select(mask: number | null): void {
    const { selected, among } = this.#store.get().look;
    if (selected !== mask || among !== null) this.#store.look({ selected: mask, among: null });
  }

  /** Shows a pair with the masks that there are: those of the clip, or its own, which are found if necessary. */
  pair(pair: FramePair, look: Look, others: Partial<State> = {}): void {
    const { tracked, playing, scrubbing } = { ...this.#store.get(), ...others };
    if (look.kind === 'objects' && tracked !== null) {
      this.#solving.stop();
      const { names, classes, colours } = tracked;
      const result = resultOf(tracked, pair);
      this.#store.set({ ...others, pair, found: null, edits: NO_EDITS, result, run: { phase: 'done', cause: 'tracked' }, look: { ...look, names, classes, colours } });
      return;
    }
    const restored = this.#masks.stateFor(pair);
    const current = isCurrent(restored);
    const passing = isPassing({ playing, scrubbing });
    const starting: Run = pair.first !== null && pair.second !== null && !passing ? STARTING : { phase: 'idle' };
    this.#store.set({ ...others, pair, ...restored, run: current ? { phase: 'done', cause: 'restored' } : starting, look });
    if (current) this.#solving.settle('restored');
    else if (!passing) void this.#segmenting.segment();
  }

  /** Shows another version of the clip's masks. */
  version(version: Version, run: ClipRun): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    this.#store.clip({ ...versionOf(version), run });
    const { names, classes, colours } = version;
    const { look } = this.#store.get();
    const { selected } = look;
    const same = look.names === names && look.classes === classes && look.colours === colours;
    if (look.kind === 'objects' && !same) this.#store.look({ names, classes, colours });
    const now = version.became.get(selected ?? 0);
    if (now !== undefined) this.#store.look({ selected: now === 0 ? null : now });
    if (tracked.spans.length === 0) this.kind('objects');
    this.objects(tracked);
  }

  /** Shows the masks of the clip as soon as there are some of a frame on screen, and whenever these change. `before`: what there was. */
  objects(before: Tracked): void {
    const { look, pair, tracked } = this.#store.get();
    if (tracked === null) return;
    const frames = [pair.first, pair.second].filter((frame) => frame !== null);
    const came = frames.some((frame) => frameOf(before, frame) === null && frameOf(tracked, frame) !== null);
    if (came) this.kind('objects');
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
