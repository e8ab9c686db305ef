//! What a person does to the objects of a clip: strokes, boxes and clicks, merging, splitting and deleting, locks, names, classes and colours.
//! Each becomes something that is said of objects in frames, in pixels of the masks, which is then carried through the clip.

import type { ClipOptions } from 'veronese';
import { nameOf } from '../../common/naming.js';
import { strings } from '../../common/strings.js';
import { smallerPieces } from '../../correction/pieces.js';
import { type Runs, packed, unpacked } from '../../correction/runs.js';
import { type Path, type Stroke, eachPixel } from '../../correction/strokes.js';
import type { Colour } from '../../drawing/palette.js';
import { UNLABELLED, keyOf } from '../../result/masks.js';
import type { LoadedFrame } from '../../state/pair.js';
import { type Spread, painted, promptOf, seenOf } from '../../state/said.js';
import { MOST_OBJECTS, spanAt } from '../../state/spans.js';
import type { Pointing, Store } from '../../state/state.js';
import { type Prompt, type Said, isPrompt, points, refined } from '../../state/statement.js';
import { type Notes, toReview } from '../../state/tracked.js';
import type { Carrying } from './carrying.js';

/** A box with both sides below this share of the frame's width is a click. */
const STILL = 0.01;

export class Objects {
  readonly #store: Store;
  readonly #carrying: Carrying;

  constructor(store: Store, carrying: Carrying) {
    this.#store = store;
    this.#carrying = carrying;
  }

  /**
   * Begins a stroke over the frame on screen, with the selected object. Returns what takes its path, or `null`, and tells why, if nothing
   * can be painted.
   */
  beginStroke(tool: Stroke['tool']): ((path: Path) => void) | null {
    const at = this.#frameToCorrect();
    const own = this.#store.get().look.selected;
    if (at === null) return null;
    if (own === null) return this.#refuse(strings.notices.chooseMask);
    if (own === UNLABELLED) return this.#refuse(strings.notices.notPainted);
    if (own === 0 && tool === 'eraser') return this.#refuse(strings.notices.nothingElse);
    if (this.#areLocked(own)) return null;
    const { index, frame } = at;
    return (drawn) => {
      const { tracked: now } = this.#store.get();
      const masks = now?.frames[index]?.runs;
      if (!now || masks === undefined) return;
      const scale = masks.width / frame.width;
      const path = { ...drawn, points: drawn.points.map((value) => (value + 0.5) * scale - 0.5), radius: drawn.radius * scale };
      const [shown, labels] = [unpacked(masks), nothing(masks)];
      eachPixel(path, masks.width, masks.height, (p) => {
        if (!now.locked.has(shown[p]!)) labels[p] = tool === 'eraser' ? 0 : own;
      });
      if (tool === 'brush' && labels.every((label) => label === UNLABELLED)) return void this.#refuse(strings.notices.locked);
      this.#paint(index, [[own, labels]]);
    };
  }

  /**
   * Begins a box or a click in the frame on screen: around or on a new object, or one more for the object that is selected, which has some
   * here. Returns what takes its corners, or `null`, and tells why.
   */
  beginPrompt(pointing: Pointing): ((path: Pick<Path, 'points'>) => void) | null {
    const at = this.#frameToCorrect();
    if (at === null) return null;
    const { index, frame } = at;
    const known = (): Prompt | null => promptOf(this.#store.get().tracked!, index, this.#store.get().look.selected);
    if (pointing !== 'new' && known() === null) return this.#refuse(strings.notices.noPrompt);
    if (pointing !== 'new' && this.#areLocked(this.#store.get().look.selected!)) return null;
    return ({ points: [x = 0, y = 0, right = x, bottom = y] }) => {
      const masks = this.#store.get().tracked?.frames[index]?.runs;
      const before = pointing === 'new' ? null : known();
      const object = before?.object ?? this.#newNumber();
      if (masks === undefined || object === null) return;
      const place = (value: number, side: number): number => Math.min(Math.max(Math.round((value + 0.5) * (masks.width / frame.width) - 0.5), 0), side - 1);
      const [columns, rows] = [[x, right].map((at) => place(at, masks.width)), [y, bottom].map((at) => place(at, masks.height))];
      const [left, top] = [Math.min(...columns), Math.min(...rows)];
      const [width, height] = [Math.max(...columns) + 1 - left, Math.max(...rows) + 1 - top];
      const isClick = pointing === 'remove' || Math.max(width, height) <= Math.max(STILL * masks.width, 1);
      const spread = this.#spread();
      const prompt: Prompt = { clicks: [], box: null, ...before, frame: index, object, propagate: spread === 'exact' ? 'none' : spread };
      const now = refined(prompt, isClick ? [columns[0]!, rows[0]!, pointing === 'remove' ? -1 : 1] : [left, top, width, height]);
      if (!points(now)) return void this.#refuse(strings.notices.nothingThere);
      if (before === null) {
        this.#store.look({ selected: object });
        this.#store.set({ tool: { ...this.#store.get().tool, pointing: 'new' } });
      }
      void this.#carrying.correct({ said: [now] });
    };
  }

  /** Takes label maps of frames, by index: numbers of objects, 0, and 255 where nothing is said. `classes`: of the objects, by number. */
  import(maps: ReadonlyMap<number, Uint8Array>, classes: ReadonlyMap<number, string>): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const said = [...maps].flatMap(([frame, all]): Said[] => {
      const masks = tracked.frames[frame]?.runs;
      const labels = all.map((label) => (tracked.locked.has(label) ? UNLABELLED : label));
      return masks ? [{ frame, object: 0, propagate: 'both', labels: packed(labels, masks.width, masks.height) }] : [];
    });
    void this.#carrying.correct({ said, notes: this.#withClasses(classes) });
  }

  /** Paints objects in a frame, each by its number: where it is, where it is not, and 255 where nothing is said. */
  #paint(frame: number, all: readonly (readonly [number, Uint8Array])[]): void {
    const { tracked } = this.#store.get();
    const spread = this.#spread();
    if (tracked === null) return;
    if (spread !== 'exact') return void this.#carrying.correct({ said: all.flatMap(([object, labels]) => painted(tracked, frame, object, labels, spread)) });
    const seen = all.map(([object, labels]) => seenOf(tracked, frame, object, labels));
    this.#carrying.draw({ drawn: new Map([[frame, seen[0]!.map((label, p) => seen.findLast((labels) => labels[p] !== UNLABELLED)?.[p] ?? label)]]) });
  }

  /** Gives the selected object the mask of the frame on screen in the next frame, or the one before. Returns the index of that frame. */
  copyMask(by: 1 | -1): number | null {
    const { tracked, look } = this.#store.get();
    const at = this.#frameToCorrect();
    const own = look.selected;
    if (at === null || tracked === null) return null;
    if (own === null || own === 0 || own === UNLABELLED) return this.#refuse(strings.notices.chooseMask);
    if (this.#areLocked(own)) return null;
    const to = at.index + by;
    const [here, there] = [tracked.frames[at.index]?.runs, tracked.frames[to]?.runs];
    if (here === undefined || there === undefined || spanAt(tracked.spans, to) === null) return this.#refuse(strings.notices.noFrameThere);
    const [mask, before] = [unpacked(here), unpacked(there)];
    const labels = before.map((label, p) => (mask[p] !== own ? 0 : tracked.locked.has(label) ? UNLABELLED : own));
    this.#paint(to, [[own, labels]]);
    return to;
  }

  /** Objects become one, under the smallest of their numbers and with the class of the first that has one. */
  merge(...ids: readonly number[]): void {
    const group = this.#known(ids).sort((one, other) => one - other);
    const { tracked } = this.#store.get();
    if (group.length < 2 || tracked === null || this.#areLocked(...group)) return;
    const [name] = group.flatMap((id) => tracked.classes[keyOf('objects', id)] ?? []);
    this.#edit({ merge: [group] }, name === undefined ? {} : this.#withClasses(new Map([[group[0]!, name]])));
  }

  /** The objects become background in the whole clip. */
  remove(...ids: readonly number[]): void {
    const known = this.#known(ids);
    if (known.length > 0 && !this.#areLocked(...known)) this.#edit({ delete: known });
  }

  /** Makes a new object of all pieces of an object but the largest, in the frame on screen; the others follow. */
  split(id: number): void {
    const { tracked, timeline } = this.#store.get();
    const frame = timeline?.first ?? null;
    const masks = frame === null ? undefined : tracked?.frames[frame]?.runs;
    if (!this.#takesCorrections() || masks === undefined || !tracked || frame === null || this.#areLocked(id)) return;
    const pieces = smallerPieces(unpacked(masks), masks.width, id);
    const number = this.#newNumber();
    if (pieces.length === 0) return void this.#refuse(strings.notices.onePiece);
    if (number === null) return;
    const [is, isNot] = [nothing(masks), nothing(masks)];
    for (const p of pieces) [is[p], isNot[p]] = [number, 0];
    // What was found automatically gives way by itself.
    const isOwn = keyOf('objects', id) in tracked.names || tracked.said.some((one) => one.object === id || (!isPrompt(one) && one.labels.labels.includes(id)));
    this.#paint(frame, [...(isOwn ? [[id, isNot] as const] : []), [number, is]]);
  }

  /** Selects the number of a new object, to be painted. Returns whether there can be one. */
  addObject(): boolean {
    const number = this.#takesCorrections() ? this.#newNumber() : null;
    if (number !== null) this.#store.look({ selected: number });
    return number !== null;
  }

  undo(): void {
    this.#carrying.undo();
  }

  redo(): void {
    this.#carrying.redo();
  }

  /** Locks the objects, or unlocks them if all are locked: nothing changes what is locked. */
  toggleLock(...ids: readonly number[]): void {
    const { tracked } = this.#store.get();
    const known = this.#known(ids);
    if (tracked === null || known.length === 0 || !this.#takesCorrections()) return;
    const { locked } = tracked;
    const unlocks = known.every((id) => locked.has(id));
    this.#carrying.note({ locked: new Set(unlocks ? [...locked].filter((id) => !known.includes(id)) : [...locked, ...known]) }, unlocks ? 'unlocked' : 'locked');
  }

  /**
   * Accepts the masks of the frame on screen, or those of all frames. Returns the frame that most needs a look then; `null` if none is left or
   * nothing could be accepted.
   */
  accept(which: 'shown' | 'all'): number | null {
    const { tracked, timeline } = this.#store.get();
    if (!this.#takesCorrections() || tracked === null) return null;
    const { frames, accepted } = tracked;
    const masks = (which === 'all' ? frames : [frames[timeline?.first ?? -1] ?? null]).filter((frame) => frame !== null);
    if (masks.length === 0) return this.#refuse(strings.notTracked);
    const now = new Set([...frames.filter((frame) => frame !== null && accepted.has(frame)), ...masks].filter((frame) => frame !== null));
    if (masks.some((frame) => !accepted.has(frame))) this.#carrying.note({ accepted: now }, 'accepted');
    return toReview({ frames, accepted: now });
  }

  /** Sets the name or colour of an object. An empty name restores the default. `goesOn`: in the same step of undo as the last one. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }, goesOn = false): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const key = keyOf('objects', id);
    if ('colour' in what) return this.#carrying.note({ colours: { ...tracked.colours, [key]: what.colour } }, 'described', goesOn);
    const { [key]: given = '', ...others } = tracked.names;
    if (what.name !== given) this.#carrying.note({ names: what.name === '' ? others : { ...others, [key]: what.name } }, 'described');
  }

  /** Those that are objects: the unlabelled pixels are none, nor is what is about to be painted. */
  #known(ids: readonly number[]): number[] {
    const { largest = 0 } = this.#store.get().tracked ?? {};
    return [...new Set(ids)].filter((id) => id > 0 && id <= largest);
  }

  #spread(): Spread {
    const { exact, spread } = this.#store.get().tool;
    return exact ? 'exact' : spread;
  }

  /** Gives objects a class, which is in the list from then on; an empty text takes it away. */
  setClass(ids: readonly number[], name: string): void {
    const { tracked } = this.#store.get();
    const others = ids.filter((id) => (tracked?.classes[keyOf('objects', id)] ?? '') !== name);
    if (others.length > 0) this.#carrying.note(this.#withClasses(new Map(others.map((id) => [id, name]))), 'described');
  }

  #withClasses(given: ReadonlyMap<number, string>): Partial<Notes> {
    const { tracked, classList } = this.#store.get();
    const added = [...given.values()].filter((name) => name !== '');
    if (added.some((name) => !classList.includes(name))) this.#store.set({ classList: [...new Set([...classList, ...added])] });
    const all = [...Object.entries(tracked?.classes ?? {}), ...[...given].map(([id, name]) => [keyOf('objects', id), name] as const)];
    return { classes: Object.fromEntries([...new Map(all)].filter(([, name]) => name !== '')) };
  }

  #edit(edits: NonNullable<ClipOptions['edits']>, notes: Partial<Notes> = {}): void {
    if (this.#takesCorrections()) void this.#carrying.correct({ edits, notes });
  }

  /** Whether one of the objects is locked; tells so. */
  #areLocked(...ids: readonly number[]): boolean {
    const { tracked, look } = this.#store.get();
    const id = ids.find((one) => tracked?.locked.has(one));
    if (id !== undefined) this.#refuse(strings.notices.isLocked(nameOf(look, id)));
    return id !== undefined;
  }

  /** The frame on screen and its index; `null`, and tells why, if it takes no corrections. */
  #frameToCorrect(): { readonly index: number; readonly frame: LoadedFrame } | null {
    const { tracked, timeline, pair } = this.#store.get();
    const index = timeline?.first ?? null;
    if (!this.#takesCorrections() || tracked === null || index === null || pair.first === null) return null;
    return spanAt(tracked.spans, index) === null ? this.#refuse(strings.notTracked) : { index, frame: pair.first };
  }

  #takesCorrections(): boolean {
    const { tracked } = this.#store.get();
    const ready = tracked !== null && tracked.spans.length > 0;
    if (!ready) this.#refuse(strings.notices.notReady);
    return ready;
  }

  #newNumber(): number | null {
    const { tracked } = this.#store.get();
    const number = (tracked?.largest ?? 0) + 1;
    return number > MOST_OBJECTS ? this.#refuse(strings.notices.tooMany) : number;
  }

  #refuse(sentence: string): null {
    this.#store.say(sentence);
    return null;
  }
}

/** Labels that say nothing of any pixel. */
function nothing({ width, height }: Runs): Uint8Array<ArrayBuffer> {
  return new Uint8Array(width * height).fill(UNLABELLED);
}
