//! Correcting the result. What a person does is written down at once and never waits; the labels follow. They are solved from the
//! result as it was found, so that they depend on the strokes alone and not on the order of undoing, one answer at a time and then
//! for the strokes that are there by then. What was done to a pair is kept when it is left and is back when it comes again.

import type { Segmentation } from 'veronese';
import { strings } from '../common/strings.js';
import {
  UNTOUCHED,
  type Given,
  asSaved,
  grouped,
  isTouched,
  lastStroke,
  maskWith,
  placeOf,
  scaled,
  strokesOf,
  withAction,
} from '../correction/edits.js';
import { type Part, knownAs, labellingOf, labelsIn } from '../correction/parts.js';
import { Solutions, packedResult, unpackedResult } from '../correction/solutions.js';
import { type Stroke, evidenceOf, possible, sayings } from '../correction/strokes.js';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED, type Kind, keyOf, labelSet, merged, takenApart } from '../result/masks.js';
import type { Kept } from '../state/kept.js';
import { type FramePair, keyOfPair } from '../state/pair.js';
import { FRESH, type After, type Look, type Result, type State, type Store } from '../state/state.js';
import type { Segmenting } from './segmenting.js';

export class Correcting {
  readonly #store: Store;
  readonly #segmenting: Segmenting;
  readonly #fail: (error: unknown) => void;
  readonly #solutions = new Solutions();
  /** The solving that is under way. */
  #solving: symbol | null = null;
  /** What the answer that is waited for comes from. */
  #after: After = 'solved';
  /** Ends the stroke that is being drawn, as if the brush was lifted. */
  finishStroke: () => void = () => undefined;

  constructor(store: Store, segmenting: Segmenting, fail: (error: unknown) => void) {
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
    // What was merged is one mask only among groups.
    const selected = maskWith(labels, this.#store.get().result!.segmentation, 'groups');
    this.#store.look({ kind: 'groups', selected, hidden: new Set(), solo: null, still: null });
  }

  takeApart(group: number): void {
    const { result } = this.#store.get();
    if (result !== null) this.#regroup(takenApart(result.segmentation, group), 'apart');
  }

  /** The mask that a stroke begun now is about; null, with a word to the user, where it could say nothing. */
  maskFor(tool: Stroke['tool']): Part | null {
    const { result, found, look, live } = this.#store.get();
    if (live !== null) return null;
    const { noMasks, chooseMask, nothingElse, notPainted } = strings.notices;
    const refuse = (sentence: string): null => (this.#store.set({ notice: { sentence, code: null } }), null);
    if (result === null || found === null) return refuse(noMasks);
    if (look.selected === null) return refuse(chooseMask);
    const mask = { of: labellingOf(found), labels: labelSet(result.segmentation, look.kind, look.selected) };
    return possible({ tool, mask }, found) === 0 ? refuse(tool === 'eraser' ? nothingElse : notPainted) : mask;
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

  /** An empty name gives the mask its own again. */
  give(id: number, what: { name: string } | { colour: Colour }): void {
    const { result, found, look, edits } = this.#store.get();
    if (result === null || found === null) return;
    const { kind } = look;
    const [property] = Object.keys(what) as ['name' | 'colour'];
    const others = edits.given.filter((one) => !(property in one && one.kind === kind && placeOf(one, result.segmentation, found) === id));
    const taken = 'name' in what && what.name === '';
    if (taken && others.length === edits.given.length) return;
    const mask = { of: labellingOf(found), labels: labelSet(result.segmentation, kind, id) };
    const given = taken ? others : [...others, { kind, id, mask, ...what }];
    this.#store.set({ edits: { ...edits, given }, look: { ...look, ...appearance(given, result.segmentation, found) } });
  }

  /** The masks were saved as `edits` made them. */
  saved({ edits, pair }: State): void {
    const now = this.#store.get();
    if (now.pair === pair) this.#store.set({ edits: { ...now.edits, saved: asSaved(edits).saved } });
  }

  /** The state as soon as no stroke waits for its answer, or nobody works on one. */
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

  /** Takes what was found in a pair: what was done to it so far is carried over. `final` unless a better result follows. */
  async take(found: Segmentation, pair: Result['pair'], began: number, final: boolean): Promise<void> {
    const under = lastStroke(this.#store.get().edits);
    const solved = await this.#solved(pair, found);
    if (solved === null) return;
    if (under !== null) this.#solutions.add(under, found, solved);
    const before = this.#store.get();
    const segmentation = grouped(solved, before.edits, found);
    this.#store.set({
      found,
      result: { segmentation, pair, waited: performance.now() - began, under },
      run: final ? { phase: 'done', after: 'found' } : before.run,
      look: { ...before.look, ...carried(before, segmentation, found), ...appearance(before.edits.given, segmentation, found) },
    });
    if (isPending(this.#store.get())) this.settle('solved'); // drawn meanwhile
  }

  /** What was done to the pair that is open is kept for when it comes again. */
  leave(): void {
    this.finishStroke();
    const { pair, edits, found, result, kept, settings, insisting } = this.#store.get();
    const key = keyOfPair(pair);
    if (key === null || pair.first === null) return;
    const insisted = insisting === null ? null : settings.motions;
    if (!isTouched(edits) && insisted === null) return;
    const packed = found === null ? null : { packed: packedResult(found, labellingOf(found)), waited: result?.waited ?? 0 };
    const { width, height } = pair.first;
    this.#store.set({
      kept: new Map(kept).set(key, { edits, insisted, width, height, found: packed }),
      ...(insisting === null ? {} : { settings: { ...settings, motions: insisting }, insisting: null }),
    });
  }

  /** What of the state is another with this pair: empty, or what was done to it before. */
  arrival(pair: FramePair): Pick<State, 'found' | 'result' | 'edits' | 'kept' | 'settings' | 'insisting'> {
    const { kept, settings, insisting } = this.#store.get();
    const key = keyOfPair(pair) ?? '';
    const known = kept.get(key);
    if (known === undefined) return { found: null, result: null, edits: UNTOUCHED, kept, settings, insisting };
    const others = new Map(kept);
    others.delete(key);
    const number = known.insisted === null ? { settings, insisting } : { settings: { ...settings, motions: known.insisted }, insisting: settings.motions };
    return { ...this.#restored(known, pair as Result['pair']), ...number, kept: others };
  }

  #restored({ edits, found: known, width, height }: Kept, pair: Result['pair']): Pick<State, 'found' | 'result' | 'edits'> {
    const { first } = pair;
    if (first.width !== width || first.height !== height) {
      return { found: null, result: null, edits: scaled(edits, first.width / width, first.height / height) };
    }
    if (known === null) return { found: null, result: null, edits };
    const found = knownAs(unpackedResult(known.packed), known.packed.runs);
    const last = lastStroke(edits);
    const solved = last === null ? undefined : this.#solutions.get(last, found);
    const segmentation = grouped(solved ?? found, edits, found);
    return { found, edits, result: { segmentation, pair, waited: known.waited, under: solved === undefined ? null : last } };
  }

  /** No answer is waited for any more; strokes without one stay. */
  interrupt(): void {
    this.#solving = null;
  }

  /** Shows what follows from the edits, as soon as it is known. */
  settle(after: After): void {
    const { result, found, edits, run } = this.#store.get();
    if (result === null || found === null) return;
    this.#after = after;
    const last = lastStroke(edits);
    const known = last === result.under ? result.segmentation : last === null ? found : this.#solutions.get(last, found);
    if (known !== undefined) this.#show(known, last, after);
    else {
      const { motions } = grouped(result.segmentation, edits, found);
      const regrouped = motions.some(({ group }, k) => group !== result.segmentation.motions[k]!.group);
      if (regrouped) this.#show(result.segmentation, result.under, null);
      // Another segmentation is coming and will be solved under all strokes.
      if (!isSegmenting(run)) void this.#solve();
    }
  }

  #go(by: 1 | -1, after: After): void {
    const { edits } = this.#store.get();
    const done = edits.done + by;
    if (done < 0 || done > edits.actions.length) return;
    this.#store.set({ edits: { ...edits, done } });
    this.settle(after);
  }

  #regroup({ motions }: Segmentation, after: After): void {
    const { edits, found } = this.#store.get();
    if (found === null) return;
    const grouping = { of: labellingOf(found), groups: motions.map(({ group }) => group) };
    this.#store.set({ edits: withAction(edits, { grouping }) });
    this.settle(after);
  }

  /** Solves until the answer is that to the newest strokes. */
  async #solve(): Promise<void> {
    this.#store.set({ run: { phase: 'working', work: 'solving', stage: 'labels', index: 0, of: 1 } });
    if (this.#solving !== null) return; // the newest strokes are taken up after those that are being solved
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
        // With strokes missing it is better than nothing; with strokes too many it is wrong.
        if (now.includes(last)) this.#show(solved, last, now.at(-1) === last ? this.#after : null, performance.now() - began);
      }
    } catch (error) {
      if (this.#solving === own) this.#fail(error);
    } finally {
      if (this.#solving === own) this.#solving = null;
    }
  }

  /** The labels of what was found under the strokes that count; null when the work was ended. */
  async #solved(pair: Result['pair'], found: Segmentation): Promise<Segmentation | null> {
    const said = sayings(strokesOf(this.#store.get().edits), found);
    return said.length === 0 ? found : this.#segmenting.relabel(pair, found, evidenceOf(said, found.width, found.height));
  }

  /** `after` is null while a better answer is waited for. */
  #show(solved: Segmentation, under: Stroke | null, after: After | null, waited?: number): void {
    const before = this.#store.get();
    const { result, found, edits, run, look } = before;
    if (result === null || found === null) return;
    const segmentation = grouped(solved, edits, found);
    this.#store.set({
      result: { ...result, segmentation, under, waited: waited ?? result.waited },
      run: after === null || isSegmenting(run) ? run : { phase: 'done', after },
      look: { ...look, ...carried(before, segmentation, found), ...appearance(edits.given, segmentation, found) },
    });
  }
}

/** Whether what was found is what the settings give, so that the frames need not be segmented again. */
export function isCurrent({ found, settings }: Pick<State, 'found' | 'settings'>): boolean {
  return found !== null && (['motions', 'quality', 'markUnknown', 'seed'] as const).every((name) => found.settings[name] === settings[name]);
}

/** Whether strokes wait for their answer. */
export function isPending({ result, edits }: Pick<State, 'result' | 'edits'>): boolean {
  return result !== null && lastStroke(edits) !== result.under;
}

/** Whether a mask of this kind can be taken apart. */
export function isMerged(kind: Kind, motions: readonly unknown[]): boolean {
  return kind === 'groups' && motions.length > 1;
}

function isSegmenting(run: State['run']): boolean {
  return run.phase === 'working' && run.work === 'segmenting';
}

/** Names and colours by the numbers that their masks have now. */
function appearance(given: readonly Given[], segmentation: Segmentation, found: Segmentation): Pick<Look, 'names' | 'colours'> {
  const [names, colours]: [Record<string, string>, Record<string, Colour>] = [{}, {}];
  for (const one of given) {
    const id = placeOf(one, segmentation, found);
    if (id === null) continue;
    if (one.name !== undefined) names[keyOf(one.kind, id)] = one.name;
    if (one.colour !== undefined) colours[keyOf(one.kind, id)] = one.colour;
  }
  return { names, colours };
}

/** What was chosen by the numbers of masks, by the numbers that these masks have now. */
function carried({ look, result, found }: State, now: Segmentation, foundNow: Segmentation): Pick<Look, 'hidden' | 'solo' | 'still' | 'selected'> {
  const { hidden: none } = FRESH;
  if (result === null || found === null) return { hidden: none, solo: null, still: null, selected: null };
  const { kind, hidden, solo, still, selected } = look;
  const place = (id: number | null): number | null => {
    if (id === null) return null;
    const labels = labelSet(result.segmentation, kind, id);
    if (id === UNLABELLED) return now.unlabelled > 0 ? id : null;
    return maskWith(found === foundNow ? labels : labelsIn({ of: labellingOf(found), labels }, labellingOf(foundNow)), now, kind);
  };
  return { hidden: new Set([...hidden].map(place).filter((id) => id !== null)), solo: place(solo), still: place(still), selected: place(selected) };
}
