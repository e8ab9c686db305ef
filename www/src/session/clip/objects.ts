//! The edits of a clip's objects: merging and deleting, locks, names, classes and colours; and with `drawing.ts` strokes, boxes
//! and clicks. Each becomes an annotation of objects, which is then carried through the clip.

import type { ClipOptions } from '../../segmented.js';
import { nameOf } from '../../common/naming.js';
import { strings } from '../../common/strings.js';
import type { Colour } from '../../drawing/palette.js';
import { keyOf } from '../../result/masks.js';
import type { LoadedFrame } from '../../state/pair.js';
import { MOST_OBJECTS, spanAt } from '../../state/spans.js';
import { type Store, seenIn } from '../../state/state.js';
import { type Notes, isDrafting, toReview } from '../../state/tracked.js';
import type { Carrying } from './carrying.js';

/** The edits that draw: {@link Objects.copyMask}, {@link Objects.split}, {@link Objects.take}, {@link Objects.point}. */
interface Drawing {
  take(mask: number): number | null;
  copyMask(by: 1 | -1): number | null;
  split(id: number): void;
  beginPrompt(pointing: 'new'): ((path: { readonly points: readonly number[] }) => void) | null;
}

export class Objects {
  readonly #store: Store;
  readonly carrying: Carrying;
  /** Draws; loaded when it is used, and `null`, with a notice, if it cannot be. Set by the brush. */
  drawing: () => Promise<Drawing | null> = () => Promise.resolve(null);
  /** Ends the stroke that is being drawn, before other frames are shown. Set by the brush. */
  finishStroke: () => void = () => undefined;
  /** Ends when nothing is being drawn. Set by the brush. */
  drawn: () => Promise<void> = () => Promise.resolve();

  constructor(store: Store, carrying: Carrying) {
    this.#store = store;
    this.carrying = carrying;
  }

  /** Objects become one, under the smallest of their numbers and with the class of the first that has one. */
  merge(...ids: readonly number[]): void {
    const group = this.#known(ids).sort((one, other) => one - other);
    const { tracked } = this.#store.get();
    if (group.length < 2 || tracked === null || this.areLocked(...group)) return;
    const [name] = group.flatMap((id) => tracked.classes[keyOf('objects', id)] ?? []);
    this.#edit({ merge: [group] }, name === undefined ? {} : this.withClasses(new Map([[group[0]!, name]])));
  }

  /** The objects become background in the whole clip. */
  remove(...ids: readonly number[]): void {
    const known = this.#known(ids);
    if (known.length > 0 && !this.areLocked(...known)) this.#edit({ delete: known });
  }

  /** Gives the selected object the mask of the frame on screen in the next frame, or the one before. Returns the index of that frame. */
  async copyMask(by: 1 | -1): Promise<number | null> {
    return (await this.drawing())?.copyMask(by) ?? null;
  }

  /** Makes a new object of what is at a pixel of the frame on screen, unless that has changed meanwhile. */
  async point(pixel: readonly [number, number]): Promise<void> {
    const { pair } = this.#store.get();
    const drawing = await this.drawing();
    if (this.#store.get().pair === pair) drawing?.beginPrompt('new')?.({ points: pixel });
  }

  /** Makes a new object of a mask of the pair on screen; the other frames follow. Returns its number. */
  async take(mask: number): Promise<number | null> {
    return (await this.drawing())?.take(mask) ?? null;
  }

  /** Makes a new object of all pieces of an object but the largest, in the frame on screen; the others follow. */
  async split(id: number): Promise<void> {
    (await this.drawing())?.split(id);
  }

  /** Selects the number of a new object, to be painted. Returns whether there can be one. */
  addObject(): boolean {
    const number = this.takesCorrections() ? this.newNumber() : null;
    if (number !== null) this.#store.look({ selected: number });
    return number !== null;
  }

  /** Locks the objects, or unlocks them if all are locked: nothing changes what is locked. */
  toggleLock(...ids: readonly number[]): void {
    const { tracked } = this.#store.get();
    const known = this.#known(ids);
    if (tracked === null || known.length === 0 || !this.takesCorrections()) return;
    const { locked } = tracked;
    const unlocks = known.every((id) => locked.has(id));
    this.carrying.note({ locked: new Set(unlocks ? [...locked].filter((id) => !known.includes(id)) : [...locked, ...known]) }, unlocks ? 'unlocked' : 'locked');
  }

  /**
   * Accepts the masks of the frame on screen, or those of all frames. Returns the frame that most needs a look then; `null` if none is left or
   * nothing could be accepted.
   */
  accept(which: 'shown' | 'all'): number | null {
    const { tracked } = this.#store.get();
    if (!this.takesCorrections() || tracked === null) return null;
    const { frames, accepted } = tracked;
    const at = seenIn(this.#store.get())?.index ?? -1;
    const masks = (which === 'all' ? frames : [frames[at] ?? null]).filter((frame) => frame !== null);
    if (masks.length === 0) return this.refuse(strings.notTracked);
    const now = new Set([...frames.filter((frame) => frame !== null && accepted.has(frame)), ...masks].filter((frame) => frame !== null));
    if (masks.some((frame) => !accepted.has(frame))) this.carrying.note({ accepted: now }, 'accepted');
    return toReview({ frames, accepted: now }, at);
  }

  /** Sets the name or colour of an object. An empty name restores the default. `goesOn`: in the same step of undo as the last one. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }, goesOn = false): void {
    const { tracked } = this.#store.get();
    if (tracked === null) return;
    const key = keyOf('objects', id);
    if ('colour' in what) return this.carrying.note({ colours: { ...tracked.colours, [key]: what.colour } }, 'described', goesOn);
    const { [key]: given = '', ...others } = tracked.names;
    if (what.name !== given) this.carrying.note({ names: what.name === '' ? others : { ...others, [key]: what.name } }, 'described');
  }

  /** Those that are objects: the unlabelled pixels are none, nor is what is about to be painted. */
  #known(ids: readonly number[]): number[] {
    const { largest = 0 } = this.#store.get().tracked ?? {};
    return [...new Set(ids)].filter((id) => id > 0 && id <= largest);
  }

  /** Gives objects a class, which is in the list from then on; an empty text takes it away. */
  setClass(ids: readonly number[], name: string): void {
    const { tracked } = this.#store.get();
    const others = ids.filter((id) => (tracked?.classes[keyOf('objects', id)] ?? '') !== name);
    if (others.length > 0) this.carrying.note(this.withClasses(new Map(others.map((id) => [id, name]))), 'described');
  }

  withClasses(given: ReadonlyMap<number, string>): Partial<Notes> {
    const { tracked, classList } = this.#store.get();
    const added = [...given.values()].filter((name) => name !== '');
    if (added.some((name) => !classList.includes(name))) this.#store.set({ classList: [...new Set([...classList, ...added])] });
    const all = [...Object.entries(tracked?.classes ?? {}), ...[...given].map(([id, name]) => [keyOf('objects', id), name] as const)];
    return { classes: Object.fromEntries([...new Map(all)].filter(([, name]) => name !== '')) };
  }

  #edit(edits: NonNullable<ClipOptions['edits']>, notes: Partial<Notes> = {}): void {
    if (this.takesCorrections()) void this.carrying.correct({ edits, notes });
  }

  /** Whether one of the objects is locked, with a notice. */
  areLocked(...ids: readonly number[]): boolean {
    const { tracked, look } = this.#store.get();
    const id = ids.find((one) => tracked?.locked.has(one));
    if (id !== undefined) this.refuse(strings.notices.isLocked(nameOf(look, id)));
    return id !== undefined;
  }

  /** The frame on screen and its index; `null`, with a notice, if it takes no corrections. */
  frameToCorrect(): { readonly index: number; readonly frame: LoadedFrame } | null {
    const { tracked } = this.#store.get();
    const seen = seenIn(this.#store.get());
    if (!this.takesCorrections() || tracked === null || seen === null) return null;
    return spanAt(tracked.spans, seen.index) === null ? this.refuse(strings.notTracked) : seen;
  }

  takesCorrections(): boolean {
    const { tracked } = this.#store.get();
    const ready = tracked !== null && tracked.spans.length > 0;
    if (!ready) this.refuse(isDrafting(tracked) ? strings.notices.drafts : strings.notices.notReady);
    return ready;
  }

  newNumber(): number | null {
    const { tracked } = this.#store.get();
    const number = (tracked?.largest ?? 0) + 1;
    return number > MOST_OBJECTS ? this.refuse(strings.notices.tooMany) : number;
  }

  refuse(sentence: string): null {
    this.#store.say(sentence);
    return null;
  }
}
