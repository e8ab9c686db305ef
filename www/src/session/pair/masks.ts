//! The edits of the pair's masks: strokes, groups, names and colours, undo and redo. The edits are in the state; the labels
//! follow from them. They are kept when the pair is left, and restored when it is opened again.

import type { Segmentation } from 'veronese';
import { strings } from '../../common/strings.js';
import { type Action, NO_EDITS, lastStroke, maskIdOf, maskWith, scaled, withAction } from '../../correction/edits.js';
import { drawnExactly, withEdits } from '../../correction/exact.js';
import { labellingOf, withLabelling } from '../../correction/parts.js';
import { unpackedResult } from '../../correction/solutions.js';
import { type Path, type Stroke, allowedLabels } from '../../correction/strokes.js';
import type { Colour } from '../../drawing/palette.js';
import { labelSet, merged, separated, ungrouped } from '../../result/masks.js';
import { type Kept, keptFrom } from '../../state/kept.js';
import { type FramePair, keyOfPair } from '../../state/pair.js';
import type { Cause, Result, State, Store } from '../../state/state.js';
import { namesAndColours } from './carried.js';
import type { Solving } from './solving.js';

export class Masks {
  readonly #store: Store;
  readonly #solving: Solving;
  /** Ends the stroke that is being drawn. Set by the brush. */
  finishStroke: () => void = () => undefined;

  constructor(store: Store, solving: Solving) {
    this.#store = store;
    this.#solving = solving;
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

  /** Begins a stroke with the selected mask. Returns what takes its path, or `null`, with a notice, if it would have no effect. */
  beginStroke(tool: Stroke['tool']): ((path: Path) => void) | null {
    const { result, found, look, live, tool: { exact: isExact } } = this.#store.get();
    if (live !== null) return null;
    const { noMasks, chooseMask, nothingElse, notPainted } = strings.notices;
    const refuse = (sentence: string): null => (this.#store.say(sentence), null);
    if (result === null || found === null) return refuse(noMasks);
    if (look.selected === null) return refuse(chooseMask);
    const mask = { of: labellingOf(found), labels: labelSet(result.segmentation, look.kind, look.selected) };
    if (allowedLabels({ tool, mask }, found) === 0) return refuse(tool === 'eraser' ? nothingElse : notPainted);
    return (path) => {
      const { result: shown, found: now } = this.#store.get();
      if (!isExact) this.#act({ stroke: { ...path, tool, mask } }, 'solved');
      else if (shown !== null && now !== null) this.#act({ exact: drawnExactly(path, { tool, mask }, shown.segmentation.labels, now) }, 'drawn');
    };
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

  /** Leaves the open pair: its edits are kept, and work on it ends. */
  leave(): void {
    this.keep();
    this.#solving.stop();
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
    const solved = this.#solving.known(last, found);
    const segmentation = withEdits(solved ?? found, edits, found);
    return { found, edits, result: { segmentation, pair, waited: known.waited, under: solved === undefined ? null : last } };
  }

  #go(by: 1 | -1, cause: Cause): void {
    const { edits } = this.#store.get();
    const done = edits.done + by;
    if (done < 0 || done > edits.actions.length) return;
    this.#store.set({ edits: { ...edits, done } });
    this.#solving.settle(cause);
  }

  #regroup({ motions }: Segmentation, cause: Cause): void {
    const { found } = this.#store.get();
    if (found !== null) this.#act({ grouping: { of: labellingOf(found), groups: motions.map(({ group }) => group) } }, cause);
  }

  #act(action: Action, cause: Cause): void {
    this.#store.set({ edits: withAction(this.#store.get().edits, action) });
    this.#solving.settle(cause);
  }
}
