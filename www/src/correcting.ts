//! Correcting the result: strokes and merges, with undo and redo. The labels under strokes are solved again from the result as it
//! was found, so that they depend on the strokes alone and not on the order of undoing.

import { type Kind, labelSet, merged, regrouped, takenApart } from './masks.js';
import type { Segmenting } from './segmenting.js';
import type { Edit, Store } from './state.js';
import { type Stroke, evidenceOf } from './strokes.js';

/** So many steps can be undone … */
const MOST_STEPS = 50;
/** … as long as their labels take no more than this, bytes. */
const MOST_MEMORY = 128 * 2 ** 20;

export class Correcting {
  readonly #store: Store;
  readonly #segmenting: Segmenting;
  readonly #fail: (error: unknown) => void;

  constructor(store: Store, segmenting: Segmenting, fail: (error: unknown) => void) {
    this.#store = store;
    this.#segmenting = segmenting;
    this.#fail = fail;
  }

  merge(one: number, other: number): void {
    const { result, look } = this.#store.get();
    if (result === null || one === other) return;
    this.#edit({ segmentation: merged(result.segmentation, look.kind, one, other) });
    // What was merged is one mask only among groups.
    const { motions } = this.#store.get().result!.segmentation;
    const labels = labelSet(result.segmentation, look.kind, one);
    const selected = motions.find(({ label }) => (labels >> label) & 1)?.group ?? null;
    this.#store.look({ kind: 'groups', selected, hidden: new Set(), solo: null, still: null });
  }

  takeApart(group: number): void {
    const { result } = this.#store.get();
    if (result !== null) this.#edit({ segmentation: takenApart(result.segmentation, group) });
  }

  /** A stroke that says "this mask" (`brush`) or "not this mask" (`eraser`). */
  async stroke(points: readonly number[], tool: 'brush' | 'eraser', mask: number): Promise<void> {
    const { result, look, tool: { radius }, history } = this.#store.get();
    if (result === null) return;
    const { segmentation } = result;
    const own = labelSet(segmentation, look.kind, mask);
    const everything = (1 << segmentation.motions.length) - 1;
    const labels = tool === 'brush' ? own : everything & ~own;
    if (labels === 0) return; // nothing is left that it could be
    await this.#solve([...history.strokes, { points, radius, labels }]);
  }

  /** Ids of masks change with the groups: what was chosen by them is forgotten. */
  undo(): void {
    const { history } = this.#store.get();
    const edit = history.past.at(-1);
    if (edit === undefined) return;
    this.#segmenting.cancel();
    this.#show(edit, { past: history.past.slice(0, -1), future: [this.#now(), ...history.future] });
  }

  redo(): void {
    const { history } = this.#store.get();
    const [edit, ...future] = history.future;
    if (edit === undefined) return;
    this.#segmenting.cancel();
    this.#show(edit, { past: [...history.past, this.#now()], future });
  }

  async #solve(strokes: readonly Stroke[]): Promise<void> {
    const { result, history } = this.#store.get();
    if (result === null || history.found === null) return;
    const { width, height, motions } = result.segmentation;
    this.#store.set({ run: { phase: 'working', stage: 'labels', index: 0, of: 1 } });
    const began = performance.now();
    try {
      const solved = await this.#segmenting.relabel(result.pair, history.found, evidenceOf(strokes, width, height));
      if (solved === null) return;
      const groups = motions.map(({ group }) => group);
      const segmentation = regrouped(solved, ({ label, group }) => groups[label] ?? group);
      this.#store.set({ run: { phase: 'done' } });
      this.#edit({ segmentation, strokes }, performance.now() - began);
    } catch (error) {
      this.#fail(error);
    }
  }

  #now(): Edit {
    const { result, history } = this.#store.get();
    return { segmentation: result!.segmentation, strokes: history.strokes };
  }

  #edit(change: Partial<Edit>, waited?: number): void {
    const { history } = this.#store.get();
    const now = this.#now();
    const most = Math.max(1, Math.min(MOST_STEPS, Math.floor(MOST_MEMORY / now.segmentation.labels.length)));
    this.#show({ ...now, ...change }, { past: [...history.past, now].slice(-most), future: [] }, waited);
  }

  #show({ segmentation, strokes }: Edit, where: { past: readonly Edit[]; future: readonly Edit[] }, waited?: number): void {
    const { result, history, run } = this.#store.get();
    if (result === null) return;
    this.#store.set({
      result: { ...result, segmentation, waited: waited ?? result.waited },
      history: { ...history, ...where, strokes },
      run: run.phase === 'working' ? { phase: 'done' } : run,
    });
  }
}

/** Whether a mask of this kind can be taken apart. */
export function isMerged(kind: Kind, motions: readonly unknown[]): boolean {
  return kind === 'groups' && motions.length > 1;
}
