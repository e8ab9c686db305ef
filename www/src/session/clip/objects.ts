//! The edits of a clip's objects: merging and deleting, locks, names, classes and colours; and with `drawing.ts` strokes, boxes
//! and clicks. Each becomes a command of the clip.

import type { ClipEntry, Clip as PackageClip } from 'veronese';
import { nameOf } from '../../common/naming.js';
import { strings } from '../../common/strings.js';
import type { Colour } from '../../drawing/palette.js';
import type { LoadedFrame } from '../../state/pair.js';
import { about, accepted, becoming } from '../../state/said.js';
import { type Store, seenIn } from '../../state/state.js';
import { type Tracked, isDrafting, isReady, lockedIn, objectsOf, takesCorrections, toReview } from '../../state/tracked.js';
import type { Living } from './living.js';
import type { ClipSegmenting } from './segmenting.js';

/** The edits that draw: {@link Objects.copyMask}, {@link Objects.split}, {@link Objects.take}, {@link Objects.point}. */
interface Drawing {
  take(motion: number): number | null;
  copyMask(by: 1 | -1): number | null;
  beginPrompt(pointing: 'new'): ((path: { readonly points: readonly number[] }) => void) | null;
}

export class Objects {
  readonly #store: Store;
  readonly #clip: ClipSegmenting;
  /** Draws; loaded when it is used, and `null`, with a notice, if it cannot be. Set by the brush. */
  drawing: () => Promise<Drawing | null> = () => Promise.resolve(null);
  /** Ends the stroke that is being drawn, before other frames are shown. Set by the brush. */
  finishStroke: () => void = () => undefined;
  /** Ends when nothing is being drawn. Set by the brush. */
  drawn: () => Promise<void> = () => Promise.resolve();

  constructor(store: Store, clip: ClipSegmenting) {
    this.#store = store;
    this.#clip = clip;
  }

  /** The clip that takes corrections. There is one whenever the state says that it does. */
  get living(): Living {
    return this.#clip.living!;
  }

  /** Objects become one, under the smallest of their numbers and with the class of the first that has one. */
  merge(...ids: readonly number[]): void {
    const [into, ...others] = this.#known(ids).sort((one, other) => one - other);
    const tracked = this.#corrected();
    if (into === undefined || others.length === 0 || tracked === null || this.areLocked(into, ...others)) return;
    const objects = objectsOf(tracked);
    const [name] = [into, ...others].flatMap((id) => objects.get(id)?.class || []);
    const became = new Map(others.map((id) => [id, into]));
    void this.living.say((clip) => clip.merge(into, ...others), becoming(became), { cause: 'corrected', reach: 1 });
    if (name !== undefined && objects.get(into)?.class === '') this.#describe([into], () => ({ class: name }), true);
  }

  /** The objects become background in the whole clip. */
  remove(...ids: readonly number[]): void {
    const known = this.#known(ids);
    if (known.length === 0 || this.#corrected() === null || this.areLocked(...known)) return;
    void this.living.say((clip) => clip.delete(...known), becoming(new Map(known.map((id) => [id, 0]))), { cause: 'corrected', reach: 1 });
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

  /** Makes a new object of a motion of the frame on screen, which is inspected; the other frames follow. Returns its number. */
  async take(motion: number): Promise<number | null> {
    return (await this.drawing())?.take(motion) ?? null;
  }

  /** Makes a new object of all pieces of an object but the largest, in the frame on screen; the others follow. */
  split(id: number): void {
    const at = this.frameToCorrect();
    if (at === null || this.areLocked(id) || this.newNumber() === null) return;
    const { index } = at;
    void this.living.say((clip) => clip.split(id, index), (clip) => clip, { cause: 'corrected', frames: [index], reach: this.#length(), refusal: strings.notices.onePiece });
  }

  /** Selects the number of a new object, to be painted. Returns whether there can be one. */
  addObject(): boolean {
    const number = this.#corrected() === null ? null : this.newNumber();
    if (number !== null) this.#store.look({ selected: number });
    return number !== null;
  }

  /** Locks the objects, or unlocks them if all are locked: nothing changes what is locked. */
  toggleLock(...ids: readonly number[]): void {
    const known = this.#known(ids);
    const tracked = this.#corrected();
    if (known.length === 0 || tracked === null) return;
    const locked = !known.every((id) => lockedIn(tracked).has(id));
    void this.living.say((clip) => clip.lock(known, locked), about(known, () => ({ locked })), { cause: locked ? 'locked' : 'unlocked' });
  }

  /**
   * Accepts the masks of the frame on screen, or those of all frames. Returns the frame that most needs a look then; `null` if none is left or
   * nothing could be accepted.
   */
  accept(which: 'shown' | 'all'): number | null {
    const tracked = this.#corrected();
    if (tracked === null) return null;
    const at = seenIn(this.#store.get())?.index ?? -1;
    const frames = (which === 'all' ? [...tracked.status.keys()] : [at]).filter((index) => takesCorrections(tracked, index));
    if (frames.length === 0) return this.refuse(strings.notTracked);
    if (frames.some((index) => !tracked.status[index]!.accepted)) {
      void this.living.say((clip) => clip.accept(frames), accepted(frames), { cause: 'accepted' });
    }
    return toReview(accepted(frames)(tracked), at);
  }

  /** Sets the name or colour of an object. An empty name restores the default. `goesOn`: in the same step of undo as the last one. */
  setAppearance(id: number, what: { name: string } | { colour: Colour }, goesOn = false): void {
    const { tracked } = this.#store.get();
    const before = tracked === null ? undefined : objectsOf(tracked).get(id);
    if (before !== undefined && !('name' in what && what.name === before.name)) this.#describe([id], () => ('name' in what ? what : { colour: [...what.colour] }), goesOn);
  }

  /** Those that are objects: the unlabelled pixels are none, nor is what is about to be painted. */
  #known(ids: readonly number[]): number[] {
    const { tracked } = this.#store.get();
    const objects = tracked === null ? new Map() : objectsOf(tracked);
    return [...new Set(ids)].filter((id) => objects.has(id));
  }

  /** Gives objects a class, which is in the list from then on; an empty text takes it away. `goesOn`: in the same step of undo as the last one. */
  setClasses(given: ReadonlyMap<number, string>, goesOn = false): void {
    const { tracked, classList } = this.#store.get();
    const objects = tracked === null ? new Map() : objectsOf(tracked);
    const others = this.#known([...given.keys()]).filter((id) => objects.get(id)!.class !== given.get(id));
    const added = others.map((id) => given.get(id)!).filter((name) => name !== '' && !classList.includes(name));
    if (added.length > 0) this.#store.set({ classList: [...new Set([...classList, ...added])] });
    this.#describe(others, (id) => ({ class: given.get(id)! }), goesOn);
  }

  /** One step of undo, or part of the one before. */
  #describe(ids: readonly number[], what: (id: number) => Partial<Pick<ClipEntry, 'name' | 'class' | 'colour'>>, goesOn: boolean): void {
    ids.forEach((id, k) => {
      const { tracked } = this.#store.get();
      const before = tracked === null ? undefined : objectsOf(tracked).get(id);
      if (before === undefined) return;
      const { name, class: named, colour } = before;
      const now = { name, class: named, ...(colour && { colour }), ...what(id) };
      const command = (clip: PackageClip) => clip.describe(id, now, { coalesce: goesOn || k > 0 });
      void this.living.say(command, about([id], () => now), { cause: 'described' });
    });
  }

  /** Whether one of the objects is locked, with a notice. */
  areLocked(...ids: readonly number[]): boolean {
    const { tracked, look } = this.#store.get();
    const locked = tracked === null ? new Set() : lockedIn(tracked);
    const id = ids.find((one) => locked.has(one));
    if (id !== undefined) this.refuse(strings.notices.isLocked(nameOf(look, id)));
    return id !== undefined;
  }

  /** The frame on screen and its index; `null`, with a notice, if it takes no corrections. */
  frameToCorrect(): { readonly index: number; readonly frame: LoadedFrame } | null {
    const tracked = this.#corrected();
    const seen = seenIn(this.#store.get());
    if (tracked === null || seen === null) return null;
    return takesCorrections(tracked, seen.index) ? seen : this.refuse(strings.notTracked);
  }

  /** The clip that takes corrections; `null`, with a notice, if it does not. */
  #corrected(): Tracked | null {
    const { tracked } = this.#store.get();
    if (isReady(tracked) && !isDrafting(tracked)) return tracked;
    return this.refuse(isDrafting(tracked) ? strings.notices.drafts : strings.notices.notReady);
  }

  newNumber(): number | null {
    const { nextObject = 0 } = this.#store.get().tracked ?? {};
    return nextObject === 0 ? this.refuse(strings.notices.tooMany) : nextObject;
  }

  /** Number of frames that a correction may reach. */
  #length(): number {
    return this.#store.get().tracked?.status.filter(({ hasMasks }) => hasMasks).length ?? 0;
  }

  refuse(sentence: string): null {
    this.#store.say(sentence);
    return null;
  }
}
