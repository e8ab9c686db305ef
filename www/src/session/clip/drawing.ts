//! Drawing objects of a clip: strokes, boxes and clicks, masks copied to other frames, objects split. It becomes annotations of objects in
//! frames, in pixels of the masks. Loaded when something is drawn.

import type { ClipPropagation } from '../../segmented.js';
import { strings } from '../../common/strings.js';
import { smallerPieces } from '../../correction/pieces.js';
import { type Runs, packed, resized, unpacked } from '../../correction/runs.js';
import { type Path, type StrokeTool, eachPixel } from '../../correction/strokes.js';
import { UNLABELLED, keyOf, maskOf } from '../../result/masks.js';
import { type Spread, seenOf } from '../../state/correction.js';
import { spanAt } from '../../state/spans.js';
import { type Pointing, type Store, seenIn } from '../../state/state.js';
import { type Box, type Click, type Painted, type Prompt, isPrompt, namesObjects, paintedOf, points } from '../../state/annotation.js';
import type { Version } from '../../state/tracked.js';
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
      const isOutline = drawn.filled === true && tool === 'brush' && own !== 0 && this.#spread() !== 'exact';
      const [shown, labels] = [unpacked(masks), nothing(masks)];
      if (isOutline) labels.fill(0);
      // An object with a name is changed by its own strokes alone.
      const stays = (id: number): boolean => now.locked.has(id) || (id !== own && keyOf('objects', id) in now.names);
      eachPixel(path, masks.width, masks.height, (p) => {
        if (!stays(shown[p]!)) labels[p] = tool === 'eraser' ? 0 : own;
      });
      if (tool === 'brush' && !labels.includes(own)) return void this.#objects.refuse(strings.notices.locked);
      this.#paint(index, [[own, labels]]);
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
      const spread = this.#spread();
      const prompt: Prompt = { clicks: [], box: null, ...before, frame: index, object, propagate: spread === 'exact' ? 'none' : spread };
      const now = refined(prompt, isClick ? [columns[0]!, rows[0]!, pointing === 'remove' ? -1 : 1] : [left, top, width, height]);
      if (!points(now)) return void this.#objects.refuse(strings.notices.nothingThere);
      if (before === null) {
        this.#store.look({ selected: object });
        this.#store.set({ tool: { ...this.#store.get().tool, pointing: 'new' } });
      }
      void this.#objects.carrying.correct({ annotations: [now] });
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
    if (here === undefined || there === undefined || spanAt(tracked.spans, to) === null) return this.#objects.refuse(strings.notices.noFrameThere);
    const [mask, before] = [unpacked(here), unpacked(there)];
    const labels = before.map((label, p) => (mask[p] !== own ? 0 : tracked.locked.has(label) ? UNLABELLED : own));
    this.#paint(to, [[own, labels]]);
    return to;
  }

  /** Makes a new object of a mask of the pair on screen; the other frames follow. Returns its number. */
  take(mask: number): number | null {
    const at = this.#objects.frameToCorrect();
    const number = at === null ? null : this.#objects.newNumber();
    const { tracked, result, look } = this.#store.get();
    const masks = tracked?.frames[at?.index ?? -1]?.runs;
    if (at === null || number === null || result === null || masks === undefined) return null;
    const { segmentation } = result;
    const found = unpacked(resized(packed(segmentation.labels, segmentation.width, segmentation.height), masks));
    this.#paint(at.index, [[number, found.map((label) => (maskOf(label, segmentation, look.kind) === mask ? number : 0))]]);
    return number;
  }

  /** Makes a new object of all pieces of an object but the largest, in the frame on screen; the others follow. */
  split(id: number): void {
    const { tracked } = this.#store.get();
    const frame = seenIn(this.#store.get())?.index ?? null;
    const masks = frame === null ? undefined : tracked?.frames[frame]?.runs;
    if (!this.#objects.takesCorrections() || masks === undefined || !tracked || frame === null || this.#objects.areLocked(id)) return;
    const pieces = smallerPieces(unpacked(masks), masks.width, id);
    const number = this.#objects.newNumber();
    if (pieces.length === 0) return void this.#objects.refuse(strings.notices.onePiece);
    if (number === null) return;
    const [is, isNot] = [nothing(masks), nothing(masks)];
    for (const p of pieces) [is[p], isNot[p]] = [number, 0];
    // An automatic object gives way by itself.
    const isOwn = keyOf('objects', id) in tracked.names || tracked.annotations.some((one) => one.object === id || (!isPrompt(one) && one.labels.labels.includes(id)));
    this.#paint(frame, [...(isOwn ? [[id, isNot] as const] : []), [number, is]]);
  }

  /** Paints objects in a frame, each by its number: where it is, where it is not, and 255 where that is left open. */
  #paint(frame: number, all: readonly (readonly [number, Uint8Array])[]): void {
    const { tracked } = this.#store.get();
    const spread = this.#spread();
    if (tracked === null) return;
    if (spread !== 'exact') return void this.#objects.carrying.correct({ annotations: all.flatMap(([object, labels]) => painted(tracked, frame, object, labels, spread)) });
    const seen = all.map(([object, labels]) => seenOf(tracked, frame, object, labels));
    this.#objects.carrying.draw(new Map([[frame, seen[0]!.map((label, p) => seen.findLast((labels) => labels[p] !== UNLABELLED)?.[p] ?? label)]]));
  }

  #spread(): Spread {
    const { exact, spread } = this.#store.get().tool;
    return exact ? 'exact' : spread;
  }
}

/**
 * The annotations of an object painted in a frame: its number, 0 where it is not, 255 where that is left open. What was merged into the object
 * is part of it. Of the background: that all unlocked objects there are not.
 */
export function painted(version: Version, frame: number, object: number, labels: Uint8Array, propagate: ClipPropagation): Painted[] {
  const masks = version.frames[frame]?.runs;
  if (masks === undefined) return [];
  const runsOf = (all: Uint8Array): Runs => packed(all, masks.width, masks.height);
  const isNot = runsOf(labels.map((label) => (label === 0 ? 0 : UNLABELLED)));
  const not = (other: number): Painted => ({ frame, object: other, propagate, labels: isNot });
  if (object !== 0) {
    const merged = labels.includes(0) ? [...version.became].filter(([, into]) => into === object).map(([other]) => not(other)) : [];
    return [...merged, { frame, object, propagate, labels: runsOf(labels) }];
  }
  const map = paintedOf(version.annotations, frame, 0);
  const isOfMasks = map !== null && namesObjects(map);
  const under = isOfMasks ? unpacked(masks).filter((_, p) => labels[p] === 0) : [];
  const stroked = version.annotations.filter((one) => one.frame === frame && !isPrompt(one)).map(({ object: other }) => other);
  const others = [...new Set([...under, ...stroked])].filter((other) => other !== 0 && other !== UNLABELLED && !version.locked.has(other));
  return [...(isOfMasks ? [] : [not(0)]), ...others.map(not)];
}

/** The prompt of an object in a frame, which may have been merged into this one; `null` if there is none. */
export function promptOf({ annotations, became }: Pick<Version, 'annotations' | 'became'>, frame: number | null, id: number | null): Prompt | null {
  return annotations.findLast((one): one is Prompt => isPrompt(one) && one.frame === frame && (became.get(one.object) ?? one.object) === id) ?? null;
}

/** A prompt with another click, or with a box. A box has all clicks that are the object's. */
export function refined(prompt: Prompt, more: Click | Box): Prompt {
  const clicks = more.length === 3 ? [...prompt.clicks.filter(([x, y]) => x !== more[0] || y !== more[1]), more] : prompt.clicks;
  const box = more.length === 4 ? more : prompt.box;
  const inside = clicks.filter(([, , sign]) => sign > 0);
  return { ...prompt, clicks, box: box && inside.reduce(grown, box) };
}

function grown([left, top, width, height]: Box, [x, y]: Click): Box {
  const [x0, y0] = [Math.min(left, x), Math.min(top, y)];
  return [x0, y0, Math.max(left + width, x + 1) - x0, Math.max(top + height, y + 1) - y0];
}

/** Labels that say nothing of any pixel. */
function nothing({ width, height }: Runs): Uint8Array<ArrayBuffer> {
  return new Uint8Array(width * height).fill(UNLABELLED);
}
