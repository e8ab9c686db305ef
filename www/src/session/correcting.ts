//! Correcting the result. Edits are recorded at once, and the labels are updated in the background. They are always solved from the
//! original segmentation, so they depend on the strokes alone and not on the order of undo and redo. One request runs at a time; the next
//! takes all strokes drawn by then. The edits of a pair are kept when it is left, and restored when it is opened again.

import type { Segmentation } from 'veronese';
import { strings } from '../common/strings.js';
import {
  NO_EDITS,
  type Appearance,
  asSaved,
  grouped,
  lastStroke,
  maskIdOf,
  maskWith,
  scaled,
  strokesOf,
  withAction,
} from '../correction/edits.js';
import { type Part, labellingOf, labelsIn, withLabelling } from '../correction/parts.js';
import { Solutions, unpackedResult } from '../correction/solutions.js';
import { type Stroke, allowedLabels, constraintsFrom, evidenceOf } from '../correction/strokes.js';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED, keyOf, labelSet, merged, separated, ungrouped } from '../result/masks.js';
import { type Kept, keptFrom } from '../state/kept.js';
import { type FramePair, keyOfPair } from '../state/pair.js';
import { FRESH, type Cause, type Look, type Result, type State, type Store, isPending } from '../state/state.js';
import type { PairWorker } from './pair/worker.js';

export class Correcting {
  readonly #store: Store;
  readonly #segmenting: PairWorker;
  readonly #fail: (error: unknown) => void;
  readonly #solutions = new Solutions();
  /** Identifies the running request. */
  #solving: symbol | null = null;
  /** What led to the pending update. */
  #cause: Cause = 'solved';
  /** Ends the stroke that is being drawn. Set by the brush. */
  finishStroke: () => void = () => undefined;

  constructor(store: Store, segmenting: PairWorker, fail: (error: unknown) => void) {
    this.#store = store;
    this.#segmenting = segmenting;
    this.#fail = fail;
  }

  merge(one: number, other: number): void {
    const { result, look } = this.#store.get();
    if (result === null || one === other) return;
    const joined = merged(result.segmentation, look.kind, one, other);
    const labels = labelSet(result.segmentation, look.kind, one);
    this.#regroup(joined, 'merged');
    // A merged mask exists only as a group.
    const selected = maskWith(labels, this.#store.get().result!.segmentation, 'groups');
    this.#store.look({ kind: 'groups', selected, hidden: new Set(), solo: null, stabilised: null });
  }

  ungroup(group: number): void {
    const { result } = this.#store.get();
    if (result !== null) this.#regroup(ungrouped(result.segmentation, group), 'ungrouped');
  }

  /** Takes a motion out of its group. */
  separate(label: number): void {
    const { result } = this.#store.get();
    if (result !== null) this.#regroup(separated(result.segmentation, label), 'separated');
  }

  /** The mask that a new stroke refers to. Returns `null` and tells the user why if the stroke would have no effect. */
  maskFor(tool: Stroke['tool']): Part | null {
    const { result, found, look, live } = this.#store.get();
    if (live !== null) return null;
    const { noMasks, chooseMask, nothingElse, notPainted } = strings.notices;
    const refuse = (sentence: string): null => (this.#store.set({ notice: { sentence, code: null } }), null);
    if (result === null || found === null) return refuse(noMasks);
    if (look.selected === null) return refuse(chooseMask);
    const mask = { of: labellingOf(found), labels: labelSet(result.segmentation, look.kind, look.selected) };
    return allowedLabels({ tool, mask }, found) === 0 ? refuse(tool === 'eraser' ? nothingElse : notPainted) : mask;
  }

  stroke(stroke: Stroke): void {
    this.#store.set({ edits: withAction(this.#store.get().edits, { stroke }) });
    this.settle('solved');
  }

  undo(): void {
    this.#go(-1, 'undone');
  }

  redo(): void {
    this.#go(1, 'redone');
  }

  /** Sets the name or colour of a mask. An empty name restores the default. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }): void {
    const { result, found, look, edits } = this.#store.get();
    if (result === null || found === null) return;
    const { kind } = look;
    const [property] = Object.keys(what) as ['name' | 'colour'];
    const others = edits.appearances.filter((one) => !(property in one && one.kind === kind && maskIdOf(one, result.segmentation, found) === id));
    const taken = 'name' in what && what.name === '';
    if (taken && others.length === edits.appearances.length) return;
    const mask = { of: labellingOf(found), labels: labelSet(result.segmentation, kind, id) };
    const appearances = taken ? others : [...others, { kind, id, mask, ...what }];
    this.#store.set({ edits: { ...edits, appearances }, look: { ...look, ...namesAndColours(appearances, result.segmentation, found) } });
  }

  /** Records that the masks were exported with these edits. */
  saved({ edits, pair }: State): void {
    const now = this.#store.get();
    if (now.pair === pair) this.#store.set({ edits: { ...now.edits, saved: asSaved(edits).saved } });
  }

  /** The state once all strokes are applied, or none is being applied. */
  settled(): Promise<State> {
    return new Promise((resolve) => {
      const look = (now: State, before: State): void => {
        const left = now.pair !== before.pair;
        if (!left && isPending(now) && now.run.phase === 'working') return;
        end();
        resolve(left ? before : now);
      };
      const end = this.#store.subscribe(look);
      look(this.#store.get(), this.#store.get());
    });
  }

  /** Shows a new segmentation of the pair with its edits applied. `final`: false if a better result follows. */
  async accept(found: Segmentation, pair: Result['pair'], began: number, final: boolean): Promise<void> {
    const under = lastStroke(this.#store.get().edits);
    const solved = await this.#solved(pair, found);
    if (solved === null) return;
    if (under !== null) this.#solutions.add(under, found, solved);
    const before = this.#store.get();
    const segmentation = grouped(solved, before.edits, found);
    this.#store.set({
      found,
      result: { segmentation, pair, waited: performance.now() - began, under },
      run: final ? { phase: 'done', cause: 'found' } : before.run,
      look: { ...before.look, ...carried(before, segmentation, found), ...namesAndColours(before.edits.appearances, segmentation, found) },
    });
    if (isPending(this.#store.get())) this.settle('solved'); // strokes drawn meanwhile
  }

  /** Keeps the edits of the open pair for when it is opened again. */
  keep(): void {
    this.finishStroke();
    const { kept, settings, motionsElsewhere } = this.#store.get();
    const own = keptFrom(this.#store.get());
    if (own === null) return;
    this.#store.set({
      kept: new Map([...kept, own]),
      ...(motionsElsewhere === null ? {} : { settings: { ...settings, motions: motionsElsewhere }, motionsElsewhere: null }),
    });
  }

  /** The parts of the state that depend on the pair: empty, or as they were kept. */
  stateFor(pair: FramePair): Pick<State, 'found' | 'result' | 'edits' | 'kept' | 'settings' | 'motionsElsewhere'> {
    const { kept, settings, motionsElsewhere } = this.#store.get();
    const key = keyOfPair(pair) ?? '';
    const known = kept.get(key);
    if (known === undefined) return { found: null, result: null, edits: NO_EDITS, kept, settings, motionsElsewhere };
    const others = new Map(kept);
    others.delete(key);
    const number =
      known.ownMotions === null
        ? { settings, motionsElsewhere }
        : { settings: { ...settings, motions: known.ownMotions }, motionsElsewhere: settings.motions };
    return { ...this.#restored(known, pair as Result['pair']), ...number, kept: others };
  }

  #restored({ edits, found: known, width, height }: Kept, pair: Result['pair']): Pick<State, 'found' | 'result' | 'edits'> {
    const { first } = pair;
    if (first.width !== width || first.height !== height) {
      return { found: null, result: null, edits: scaled(edits, first.width / width, first.height / height) };
    }
    if (known === null) return { found: null, result: null, edits };
    const found = withLabelling(unpackedResult(known.packed), known.packed.runs);
    const last = lastStroke(edits);
    const solved = last === null ? undefined : this.#solutions.get(last, found);
    const segmentation = grouped(solved ?? found, edits, found);
    return { found, edits, result: { segmentation, pair, waited: known.waited, under: solved === undefined ? null : last } };
  }

  /** Ignores the running request. Strokes that are not applied yet stay. */
  interrupt(): void {
    this.#solving = null;
  }

  /** Shows the labels that follow from the edits, solving them first if necessary. */
  settle(cause: Cause): void {
    const { result, found, edits, run } = this.#store.get();
    if (result === null || found === null) return;
    this.#cause = cause;
    const last = lastStroke(edits);
    const known = last === result.under ? result.segmentation : last === null ? found : this.#solutions.get(last, found);
    if (known !== undefined) this.#show(known, last, cause);
    else {
      const { motions } = grouped(result.segmentation, edits, found);
      const regrouped = motions.some(({ group }, k) => group !== result.segmentation.motions[k]!.group);
      if (regrouped) this.#show(result.segmentation, result.under, null);
      // A segmentation under way will be solved with all strokes.
      if (!isSegmenting(run)) void this.#solve();
    }
  }

  #go(by: 1 | -1, cause: Cause): void {
    const { edits } = this.#store.get();
    const done = edits.done + by;
    if (done < 0 || done > edits.actions.length) return;
    this.#store.set({ edits: { ...edits, done } });
    this.settle(cause);
  }

  #regroup({ motions }: Segmentation, cause: Cause): void {
    const { edits, found } = this.#store.get();
    if (found === null) return;
    const grouping = { of: labellingOf(found), groups: motions.map(({ group }) => group) };
    this.#store.set({ edits: withAction(edits, { grouping }) });
    this.settle(cause);
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
      if (this.#solving === own) this.#fail(error);
    } finally {
      if (this.#solving === own) this.#solving = null;
    }
  }

  /** The segmentation solved with the strokes in effect; `null` if the request was cancelled. */
  async #solved(pair: Result['pair'], found: Segmentation): Promise<Segmentation | null> {
    const constraints = constraintsFrom(strokesOf(this.#store.get().edits), found);
    return constraints.length === 0 ? found : this.#segmenting.relabel(pair, found, evidenceOf(constraints, found.width, found.height));
  }

  /** `cause` is `null` while a newer result is pending. */
  #show(solved: Segmentation, under: Stroke | null, cause: Cause | null, waited?: number): void {
    const before = this.#store.get();
    const { result, found, edits, run, look } = before;
    if (result === null || found === null) return;
    const segmentation = grouped(solved, edits, found);
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

/** Names and colours by the current numbers of their masks. */
function namesAndColours(appearances: readonly Appearance[], segmentation: Segmentation, found: Segmentation): Pick<Look, 'names' | 'colours'> {
  const [names, colours]: [Record<string, string>, Record<string, Colour>] = [{}, {}];
  for (const one of appearances) {
    const id = maskIdOf(one, segmentation, found);
    if (id === null) continue;
    if (one.name !== undefined) names[keyOf(one.kind, id)] = one.name;
    if (one.colour !== undefined) colours[keyOf(one.kind, id)] = one.colour;
  }
  return { names, colours };
}

/** Choices that refer to masks by number, with the numbers of these masks in the new result. */
function carried({ look, result, found }: State, now: Segmentation, foundNow: Segmentation): Pick<Look, 'hidden' | 'solo' | 'stabilised' | 'selected' | 'dismissed'> {
  const { hidden: none, dismissed: asked } = FRESH;
  if (result === null || found === null) return { hidden: none, solo: null, stabilised: null, selected: null, dismissed: asked };
  const { kind, hidden, solo, stabilised, selected } = look;
  const place = (id: number | null): number | null => {
    if (id === null) return null;
    const labels = labelSet(result.segmentation, kind, id);
    if (id === UNLABELLED) return now.unlabelled > 0 ? id : null;
    return maskWith(found === foundNow ? labels : labelsIn({ of: labellingOf(found), labels }, labellingOf(foundNow)), now, kind);
  };
  const dismissed = found === foundNow ? look.dismissed : asked;
  return { dismissed, hidden: new Set([...hidden].map(place).filter((id) => id !== null)), solo: place(solo), stabilised: place(stabilised), selected: place(selected) };
}
