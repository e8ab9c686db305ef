//! The labels of the pair: as they were found, with the strokes in effect. They are always solved from the original segmentation, so they
//! depend on the strokes alone and not on the order of undo and redo. One request runs at a time; the next takes all strokes drawn by then.
//! It owns the request under way and the labels that were solved before.

import type { Segmentation } from 'veronese';
import { grouped, lastStroke, strokesOf } from '../../correction/edits.js';
import { withEdits } from '../../correction/exact.js';
import { Solutions } from '../../correction/solutions.js';
import { type Stroke, constraintsFrom, evidenceOf } from '../../correction/strokes.js';
import { type Cause, type Result, type State, type Store, isPending } from '../../state/state.js';
import { fail } from '../failures.js';
import { carried, namesAndColours } from './carried.js';
import type { PairWorker } from './worker.js';

export class Solving {
  readonly #store: Store;
  readonly #worker: PairWorker;
  readonly #solutions = new Solutions();
  /** Identifies the running request. */
  #solving: symbol | null = null;
  /** The cause of the pending update. */
  #cause: Cause = 'solved';

  constructor(store: Store, worker: PairWorker) {
    this.#store = store;
    this.#worker = worker;
  }

  /** Shows a new segmentation of the pair with its edits applied. `final`: false if a better result follows. */
  async accept(found: Segmentation, pair: Result['pair'], began: number, final: boolean): Promise<void> {
    const under = lastStroke(this.#store.get().edits);
    const solved = await this.#solved(pair, found);
    if (solved === null) return;
    if (under !== null) this.#solutions.add(under, found, solved);
    const before = this.#store.get();
    const segmentation = withEdits(solved, before.edits, found);
    this.#store.set({
      found,
      result: { segmentation, pair, waited: performance.now() - began, under },
      run: final ? { phase: 'done', cause: 'found' } : before.run,
      look: { ...before.look, ...carried(before, segmentation, found), ...namesAndColours(before.edits.appearances, segmentation, found) },
    });
    if (isPending(this.#store.get())) this.settle('solved'); // strokes drawn meanwhile
  }

  /** Shows the labels that follow from the edits, solving them first if necessary. */
  settle(cause: Cause): void {
    const { result, found, edits, run } = this.#store.get();
    if (result === null || found === null) return;
    this.#cause = cause;
    const last = lastStroke(edits);
    const known = this.known(last, found);
    if (known !== undefined) this.#show(known, last, cause);
    else {
      const { motions } = grouped(result.segmentation, edits, found);
      const regrouped = motions.some(({ group }, k) => group !== result.segmentation.motions[k]!.group);
      if (regrouped || cause === 'drawn') this.#show(result.segmentation, result.under, null);
      // A segmentation under way will be solved with all strokes.
      if (!isSegmenting(run)) void this.#solve();
    }
  }

  /** The labels with the strokes up to `last`, if they need not be solved. */
  known(last: Stroke | null, found: Segmentation): Segmentation | undefined {
    return last === null ? found : this.#solutions.get(last, found);
  }

  /** Stops the work on the pair. Strokes that are not applied yet stay. */
  stop(): void {
    this.#worker.cancel();
    this.#solving = null;
  }

  /** Solves until all strokes are applied. */
  async #solve(): Promise<void> {
    this.#store.set({ run: { phase: 'working', work: 'solving', stage: 'labels', index: 0, of: 1 } });
    if (this.#solving !== null) return; // the loop below takes the newest strokes next
    const own = (this.#solving = Symbol());
    try {
      for (;;) {
        const { result, found, edits } = this.#store.get();
        const last = lastStroke(edits);
        if (result === null || found === null || last === null || last === result.under) break;
        const began = performance.now();
        const solved = this.#solutions.get(last, found) ?? (await this.#solved(result.pair, found));
        if (solved === null || this.#solving !== own) return;
        this.#solutions.add(last, found, solved);
        const now = strokesOf(this.#store.get().edits);
        // A result that lacks strokes is shown meanwhile; one with a stroke that was undone is not.
        if (now.includes(last)) this.#show(solved, last, now.at(-1) === last ? this.#cause : null, performance.now() - began);
      }
    } catch (error) {
      if (this.#solving === own) fail(this.#store, error);
    } finally {
      if (this.#solving === own) this.#solving = null;
    }
  }

  /** The segmentation solved with the strokes in effect; `null` if the request was cancelled. */
  async #solved(pair: Result['pair'], found: Segmentation): Promise<Segmentation | null> {
    const constraints = constraintsFrom(strokesOf(this.#store.get().edits), found);
    return constraints.length === 0 ? found : this.#worker.relabel(pair, found, evidenceOf(constraints, found.width, found.height));
  }

  /** `cause` is `null` while a newer result is pending. */
  #show(solved: Segmentation, under: Stroke | null, cause: Cause | null, waited?: number): void {
    const before = this.#store.get();
    const { result, found, edits, run, look } = before;
    if (result === null || found === null) return;
    const segmentation = withEdits(solved, edits, found);
    this.#store.set({
      result: { ...result, segmentation, under, waited: waited ?? result.waited },
      run: cause === null || isSegmenting(run) ? run : { phase: 'done', cause },
      look: { ...look, ...carried(before, segmentation, found), ...namesAndColours(edits.appearances, segmentation, found) },
    });
  }
}

function isSegmenting(run: State['run']): boolean {
  return run.phase === 'working' && run.work === 'segmenting';
}
