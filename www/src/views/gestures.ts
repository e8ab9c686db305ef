//! Pointers on the picture. View tool: a tap selects a mask, or offers a new object where none was found, holding shows the other frame, dragging pans the enlarged picture. Brush and
//! eraser: dragging paints. Polygon: each press sets a corner where it ends. Box: dragging draws one, a tap points; with Shift to more of the
//! selected object, with Alt or the right button to what does not belong to it. With Shift the wheel changes the size of the brush. All tools:
//! the wheel and two fingers zoom.

import { imported } from '../common/loaded.js';
import { inPicture } from '../drawing/viewport.js';
import { UNLABELLED } from '../result/masks.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { Peek } from './blink.js';
import type { LateBrush } from './late-brush.js';
import { isReached, takesText } from './focused.js';
import { isDialogueOpen } from './markup.js';
import type { Offer } from './offer.js';
import { changeRadius } from './tools.js';
import type { Zoom } from './zoom.js';

/** A press that moves further is a drag, screen pixels. */
const STILL = 5;
/** A press that lasts longer is not a tap, milliseconds. */
const TAP = 220;
/** A press as near to the first corner of a polygon closes it, screen pixels. */
const REACH = { mouse: 9, finger: 24 };
/** Zoom per pixel of the wheel, and what a notch makes of the brush. */
const WHEEL = 0.0025;
const NOTCH = 1.15;

interface Press {
  x: number;
  y: number;
  readonly began: readonly [number, number];
  /** When it began, milliseconds: events may be handled later. */
  readonly since: number;
  /** Whether it ever moved further from there than {@link STILL}. */
  moved: boolean;
}

export function mountGestures(layers: HTMLElement, store: Store, session: Session, zoom: Zoom, brush: LateBrush): void {
  const presses = new Map<number, Press>();
  const peek = new Peek(store);
  let holding = 0;
  let dragged = false;
  /** Loaded when something is first pressed that was not found. */
  let offering: Promise<Offer> | null = null;

  const inView = ({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] => {
    const box = layers.getBoundingClientRect();
    return [(clientX - box.left) / box.width, (clientY - box.top) / box.height];
  };
  const paints = (): boolean => store.get().tool.name !== 'look';

  // What is drawn may begin beside the picture.
  const stage = layers.parentElement!;
  stage.addEventListener('pointerdown', (event) => {
    if (event.target === stage ? !paints() : !layers.contains(event.target as Node)) return;
    const points = store.get().tool.name === 'box';
    const removes = points && (event.button === 2 || event.altKey);
    if ((event.button !== 0 && !removes) || event.target instanceof HTMLInputElement || event.target instanceof HTMLButtonElement) return;
    presses.set(event.pointerId, { x: event.clientX, y: event.clientY, began: [event.clientX, event.clientY], since: event.timeStamp, moved: false });
    layers.setPointerCapture(event.pointerId);
    clearTimeout(holding);
    if (presses.size > 1) {
      dragged = true;
      peek.release();
      const drawn = [...presses.values()].some(({ moved }) => moved);
      brush.do((brush) => brush.interrupt(drawn));
      return;
    }
    dragged = false;
    if (paints()) {
      const at = pixelAt(store.get(), inView(event));
      const pointing = removes ? 'remove' : points && event.shiftKey ? 'add' : null;
      brush.do((brush) => brush.begin(at, pointing));
    } else holding = window.setTimeout(() => peek.press(), TAP);
  });

  layers.addEventListener('pointermove', (event) => {
    const press = presses.get(event.pointerId);
    if (press === undefined) {
      if (paints()) brush.now?.hover(pixelAt(store.get(), inView(event)));
      return;
    }
    const [dx, dy] = [event.clientX - press.x, event.clientY - press.y];
    press.moved ||= Math.hypot(event.clientX - press.began[0], event.clientY - press.began[1]) > STILL;
    const box = layers.getBoundingClientRect();
    if (presses.size === 2) {
      const [other] = [...presses].filter(([id]) => id !== event.pointerId).map(([, value]) => value);
      if (other !== undefined) {
        const distance = (p: { x: number; y: number }): number => Math.hypot(p.x - other.x, p.y - other.y);
        const now = { x: event.clientX, y: event.clientY };
        zoom.pan(dx / 2 / box.width, dy / 2 / box.height);
        const middle = { clientX: (now.x + other.x) / 2, clientY: (now.y + other.y) / 2 };
        if (distance(press) > 0) zoom.by(distance(now) / distance(press), inView(middle));
      }
    } else if (paints()) {
      const path = coalesced(event).map((point) => pixelAt(store.get(), inView(point)));
      if (!dragged || brush.now?.painting) brush.do((brush) => path.forEach((point) => brush.move(point)));
    } else if (dragged || press.moved) {
      if (!dragged && store.get().viewport.zoom > 1) clearTimeout(holding);
      dragged = true;
      zoom.pan(dx / box.width, dy / box.height);
    }
    press.x = event.clientX;
    press.y = event.clientY;
  });

  const end = (event: PointerEvent): void => {
    const press = presses.get(event.pointerId);
    if (press === undefined) return;
    presses.delete(event.pointerId);
    clearTimeout(holding);
    if (paints()) {
      const reach = event.pointerType === 'mouse' ? REACH.mouse : REACH.finger;
      return brush.do((brush) => (event.type === 'pointerup' ? brush.end(reach, event.shiftKey) : brush.interrupt(press.moved)));
    }
    const wasHeld = peek.held && event.timeStamp - press.since >= TAP;
    const tapped = !dragged && event.type === 'pointerup' && !wasHeld;
    peek.release();
    if (!tapped) return;
    const at = pixelAt(store.get(), inView(event));
    choose(store, session, at);
    const { look } = store.get();
    if (look.selected !== 0) return;
    const view = inView(event);
    offering ??= imported(() => import('./offer.js')).then(({ Offer }) => new Offer(layers, store, session));
    // Without it there is the box, which does the same.
    offering.then((offer) => offer.at(at, view), () => (offering = null));
  };
  layers.addEventListener('pointerup', end);
  layers.addEventListener('pointercancel', end);
  layers.addEventListener('pointerleave', () => brush.now?.leave());
  window.addEventListener('blur', () => peek.release());
  document.addEventListener('keydown', (event) => {
    const { key, target } = event;
    // Wherever the focus is, these are first about what is being drawn.
    const takesBack = brush.painting && !isDialogueOpen() && (key === 'Escape' || key === 'Backspace') && !takesText(target);
    const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
    // After a press on the picture these are about the clip, unless they go on with what was begun by them.
    const ofClip = (key === ' ' || key.startsWith('Arrow')) && !brush.painting && !isReached(target, '.layers');
    if (plain && ((target === layers && !ofClip) || takesBack) && brush.key(event)) event.preventDefault();
  });
  // A long press on a touch screen opens a menu otherwise, and so does the right button.
  layers.addEventListener('contextmenu', (event) => {
    if (presses.size > 0 || store.get().tool.name === 'box') event.preventDefault();
  });

  layers.addEventListener(
    'wheel',
    (event) => {
      if (event.shiftKey && paints()) {
        event.preventDefault();
        return changeRadius(store, (event.deltaY || event.deltaX) < 0 ? NOTCH : 1 / NOTCH);
      }
      // The whole picture is visible already: let the page scroll.
      if (event.deltaY > 0 && store.get().viewport.zoom <= 1 && !event.ctrlKey) return;
      event.preventDefault();
      const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY : event.deltaY * 33;
      zoom.by(Math.exp(-pixels * WHEEL * (event.ctrlKey ? 4 : 1)), inView(event));
    },
    { passive: false },
  );
}

function coalesced(event: PointerEvent): PointerEvent[] {
  const events = event.getCoalescedEvents?.() ?? [];
  return events.length > 0 ? events : [event];
}

/** The position in the frame; pixel centres have integer coordinates. */
function pixelAt({ pair, viewport }: State, view: readonly [number, number]): [number, number] {
  const frame = pair.first;
  const [x, y] = inPicture(viewport, view);
  return [x * (frame?.width ?? 1) - 0.5, y * (frame?.height ?? 1) - 0.5];
}

/** Selects the object at a position of the frame, or deselects it. */
function choose(store: Store, session: Session, [x, y]: readonly [number, number]): void {
  const { result, look } = store.get();
  if (result === null) return;
  const { labels, width, height } = result.masks;
  const [px, py] = [Math.min(Math.max(Math.round(x), 0), width - 1), Math.min(Math.max(Math.round(y), 0), height - 1)];
  const mask = labels[py * width + px] ?? UNLABELLED;
  session.shown.select(look.selected === mask ? null : mask);
}
