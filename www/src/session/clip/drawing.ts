//! Drawing objects of a clip: strokes, boxes and clicks, masks copied to other frames. It becomes annotations of objects in frames, in pixels of
//! the masks. Loaded when something is drawn.

import type { ClipAnnotation, ClipClick } from 'veronese';
import { strings } from '../../common/strings.js';
import { type Runs, packed, resized, unpacked } from '../../result/runs.js';
import { type Path, type StrokeTool, eachPixel } from '../../result/strokes.js';
import { UNLABELLED } from '../../result/masks.js';
import { painted, prompted } from '../../state/said.js';
import type { Pointing, Store } from '../../state/state.js';
import { type Box, type Prompt, acceptedIn, lockedIn, objectsOf, promptOf, takesCorrections } from '../../state/tracked.js';
import type { Objects } from './objects.js';

/** A box with both sides below this share of the frame's width is a click. */
const STILL = 0.01;

export class Drawing {
  readonly #store: Store;
  readonly #objects: Objects;

  constructor(store: Store, objects: Objects) {
    this.#store = store;
    this.#objects = objects;
  }

  /**
   * Begins a stroke over the frame on screen, with the selected object. Returns what takes its path, or `null`, with a notice, if nothing
   * can be painted.
   */
  beginStroke(tool: StrokeTool): ((path: Path) => void) | null {
    const at = this.#objects.frameToCorrect();
    const own = this.#store.get().look.selected;
    if (at === null) return null;
    if (own === null) return this.#objects.refuse(strings.notices.chooseMask);
    if (own === UNLABELLED) return this.#objects.refuse(strings.notices.notPainted);
    if (own === 0 && tool === 'eraser') return this.#objects.refuse(strings.notices.nothingElse);
    if (this.#objects.areLocked(own)) return null;
    const { index, frame } = at;
    return (drawn) => {
      const { tracked: now } = this.#store.get();
      const masks = now?.frames[index]?.runs;
      if (!now || masks === undefined) return;
      const scale = masks.width / frame.width;
      const path = { ...drawn, points: drawn.points.map((value) => (value + 0.5) * scale - 0.5), radius: drawn.radius * scale };
      // A polygon is the object: around it there is none. What is drawn exactly changes nothing around it.
      const isOutline = drawn.filled === true && tool === 'brush' && own !== 0 && this.#propagate() !== 'exact';
      const [shown, labels] = [unpacked(masks), nothing(masks)];
      if (isOutline) labels.fill(0);
      // An object with a name is changed by its own strokes alone.
      const [locked, objects] = [lockedIn(now), objectsOf(now)];
      const stays = (id: number): boolean => locked.has(id) || (id !== own && (objects.get(id)?.name ?? '') !== '');
      const is = tool === 'eraser' || own === 0 ? 0 : 1;
      let isAny = false;
      eachPixel(path, masks.width, masks.height, (p) => {
        if (stays(shown[p]!)) return;
        labels[p] = is;
        isAny = true;
      });
      if (tool === 'brush' && !isAny) return void this.#objects.refuse(strings.notices.locked);
      this.#paint(index, own, labels);
    };
  }

  /**
   * Begins a box or a click in the frame on screen: around or on a new object, or one more for the object that is selected, which has some
   * here. Returns what takes its corners, or `null`, with a notice.
   */
  beginPrompt(pointing: Pointing): ((path: Pick<Path, 'points'>) => void) | null {
    const at = this.#objects.frameToCorrect();
    if (at === null) return null;
    const { index, frame } = at;
    const known = (): Prompt | null => promptOf(this.#store.get().tracked!, index, this.#store.get().look.selected);
    if (pointing !== 'new' && known() === null) return this.#objects.refuse(strings.notices.noPrompt);
    if (pointing !== 'new' && this.#objects.areLocked(this.#store.get().look.selected!)) return null;
    return ({ points: [x = 0, y = 0, right = x, bottom = y] }) => {
      const masks = this.#store.get().tracked?.frames[index]?.runs;
      const before = pointing === 'new' ? null : known();
      const object = before?.object ?? this.#objects.newNumber();
      if (masks === undefined || object === null) return;
      const place = (value: number, side: number): number => Math.min(Math.max(Math.round((value + 0.5) * (masks.width / frame.width) - 0.5), 0), side - 1);
      const [columns, rows] = [[x, right].map((at) => place(at, masks.width)), [y, bottom].map((at) => place(at, masks.height))];
      const [left, top] = [Math.min(...columns), Math.min(...rows)];
      const [width, height] = [Math.max(...columns) + 1 - left, Math.max(...rows) + 1 - top];
      const isClick = pointing === 'remove' || Math.max(width, height) <= Math.max(STILL * masks.width, 1);
      const isBeside = Math.min(x, y) < -0.5 || x >= frame.width - 0.5 || y >= frame.height - 0.5;
      if (isClick && isBeside) return;
      const now = refined(before ?? { object, clicks: [], box: null }, isClick ? [columns[0]!, rows[0]!, pointing === 'remove' ? -1 : 1] : [left, top, width, height]);
      if (now.box === null && !now.clicks.some(([, , sign]) => sign > 0)) return void this.#objects.refuse(strings.notices.nothingThere);
      if (before === null) {
        this.#store.look({ selected: object });
        this.#store.set({ tool: { ...this.#store.get().tool, pointing: 'new' } });
      }
      void this.#point(index, now);
    };
  }

  /** Gives the selected object the mask of the frame on screen in the next frame, or the one before. Returns the index of that frame. */
  copyMask(by: 1 | -1): number | null {
    const { tracked, look } = this.#store.get();
    const at = this.#objects.frameToCorrect();
    const own = look.selected;
    if (at === null || tracked === null) return null;
    if (own === null || own === 0 || own === UNLABELLED) return this.#objects.refuse(strings.notices.chooseMask);
    if (this.#objects.areLocked(own)) return null;
    const to = at.index + by;
    const [here, there] = [tracked.frames[at.index]?.runs, tracked.frames[to]?.runs];
    if (here === undefined || there === undefined || !takesCorrections(tracked, to)) return this.#objects.refuse(strings.notices.noFrameThere);
    const [mask, before, locked] = [unpacked(here), unpacked(there), lockedIn(tracked)];
    this.#paint(to, own, before.map((label, p) => (mask[p] !== own ? 0 : locked.has(label) ? UNLABELLED : 1)));
    return to;
  }

  /** Makes a new object of a motion of the frame on screen, which is inspected; the other frames follow. Returns its number. */
  take(motion: number): number | null {
    const at = this.#objects.frameToCorrect();
    const number = at === null ? null : this.#objects.newNumber();
    const { tracked, inspected } = this.#store.get();
    const [masks, found] = [tracked?.frames[at?.index ?? -1]?.runs, inspected?.segmentation];
    if (at === null || number === null || !found || inspected?.first !== at.frame || masks === undefined) return null;
    const labels = unpacked(resized(packed(found.labels, found.width, found.height), masks));
    this.#paint(at.index, number, labels.map((label) => (label === motion ? 1 : 0)));
    return number;
  }

  /** Paints an object in a frame: 1 where it is, 0 where it is not, 255 where that is left open. Of 0: there is no object where the labels are 0. */
  #paint(frame: number, object: number, labels: Uint8Array): void {
    const propagate = this.#propagate();
    const annotation: ClipAnnotation = object === 0 ? { frame, propagate, labels } : { frame, propagate, object, strokes: labels };
    void this.#objects.living.say((clip) => clip.annotate(annotation), painted(frame, object, labels), { cause: 'corrected', frames: [frame], ...this.#reach(frame) });
  }

  async #point(frame: number, prompt: Prompt): Promise<void> {
    const { object, clicks, box } = prompt;
    const spread = this.#propagate();
    const annotation: ClipAnnotation = { frame, propagate: spread === 'exact' ? 'none' : spread, object, clicks, ...(box && { box }) };
    const { living } = this.#objects;
    const said = living.say((clip) => clip.annotate(annotation), prompted(frame, prompt), { cause: 'corrected', frames: [frame], ...this.#reach(frame) });
    const { count } = living;
    if ((await said) && (await living.withoutNothing(frame, object, count))) this.#store.say(strings.notices.nothingThere);
  }

  #propagate(): ClipAnnotation['propagate'] & string {
    const { exact, spread } = this.#store.get().tool;
    return exact ? 'exact' : spread;
  }

  /** The number of frames that an annotation of a frame may reach, and of those that are accepted. */
  #reach(frame: number): { readonly reach: number; readonly kept: number } {
    const { tracked } = this.#store.get();
    const spread = this.#propagate();
    const reaches = (index: number): boolean => index === frame || spread === 'both' || spread === (index < frame ? 'backward' : 'forward');
    const count = (indices: readonly number[]): number => indices.filter(reaches).length;
    if (tracked === null) return { reach: 1, kept: 0 };
    return { reach: count([...tracked.status.keys()].filter((index) => takesCorrections(tracked, index))), kept: count(acceptedIn(tracked).filter((index) => index !== frame)) };
  }
}

/** A prompt with another click, or with a box. A box has all clicks that are the object's. */
export function refined(prompt: Prompt, more: ClipClick | Box): Prompt {
  const clicks = more.length === 3 ? [...prompt.clicks.filter(([x, y]) => x !== more[0] || y !== more[1]), more] : prompt.clicks;
  const box = more.length === 4 ? more : prompt.box;
  const inside = clicks.filter(([, , sign]) => sign > 0);
  return { ...prompt, clicks, box: box && inside.reduce(grown, box) };
}

function grown([left, top, width, height]: Box, [x, y]: ClipClick): Box {
  const [x0, y0] = [Math.min(left, x), Math.min(top, y)];
  return [x0, y0, Math.max(left + width, x + 1) - x0, Math.max(top + height, y + 1) - y0];
}

/** Labels that say nothing of any pixel. */
function nothing({ width, height }: Runs): Uint8Array<ArrayBuffer> {
  return new Uint8Array(width * height).fill(UNLABELLED);
}
