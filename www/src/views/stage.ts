//! The picture: which frame is drawn, and seeing the other one for as long as a key or the picture is pressed.

import type { LoadedFrame } from '../frames.js';
import type { State, Store } from '../state.js';
import { strings } from '../strings.js';
import { drawHeldStill } from '../warp.js';
import { contextOf, find, takesText } from './markup.js';

export function mountStage(stage: HTMLElement, store: Store): void {
  const layers = find(stage, '.layers', HTMLElement);
  const canvas = find(stage, '#frame', HTMLCanvasElement);
  const caption = find(stage, '#caption', HTMLElement);
  const invitation = find(stage, '#invitation', HTMLElement);
  const context = contextOf(canvas);

  store.subscribe((now, before) => {
    const { pair, result, look, run } = now;
    invitation.hidden = shownFrame(now) !== null || run.phase === 'opening';
    const same = pair === before.pair && result === before.result && look.frame === before.look.frame && look.still === before.look.still;
    if (same) return;
    const frame = shownFrame(now);
    layers.hidden = frame === null;
    caption.textContent = frame === null ? '' : captionOf(now, frame);
    if (frame === null) return;
    fit(canvas, frame);
    stage.style.setProperty('--ratio', String(frame.width / frame.height));
    const held = heldMotion(now);
    if (held === null) context.drawImage(frame.bitmap, 0, 0);
    else drawHeldStill(context, frame.bitmap, held);
  });

  mountBlink(layers, store);
}

/** The frame that is shown; the other one while it is the only one. */
function shownFrame({ pair, look }: State): LoadedFrame | null {
  return pair[look.frame] ?? pair.first ?? pair.second;
}

/** The matrix by which the second frame is warped, if it is to be. */
function heldMotion({ look, result }: State): readonly number[] | null {
  if (look.frame !== 'second' || look.still === null) return null;
  return result?.segmentation.motions[look.still]?.matrix ?? null;
}

function captionOf(state: State, frame: LoadedFrame): string {
  const slot = frame === state.pair.first ? 'first' : 'second';
  const held = heldMotion(state) === null ? '' : strings.heldStill(strings.motionName(state.look.still ?? 0));
  return `${strings.slot[slot]}${held}`;
}

/** Sets the canvas to the frame's size; setting it clears it, also where the size is the same. */
function fit(canvas: HTMLCanvasElement, { width, height }: LoadedFrame): void {
  canvas.width = width;
  canvas.height = height;
}

/** While B or the picture is pressed, the other frame is shown. */
function mountBlink(picture: HTMLElement, store: Store): void {
  let held = false;
  const flip = (): void => store.look({ frame: store.get().look.frame === 'first' ? 'second' : 'first' });
  const press = (): void => {
    const { first, second } = store.get().pair;
    if (held || first === null || second === null) return;
    held = true;
    flip();
  };
  const release = (): void => {
    if (held) flip();
    held = false;
  };
  document.addEventListener('keydown', (event) => {
    if (event.key.toLowerCase() !== 'b' || event.ctrlKey || event.metaKey || event.altKey || takesText(event.target)) return;
    press();
  });
  document.addEventListener('keyup', (event) => {
    if (event.key.toLowerCase() === 'b') release();
  });
  picture.addEventListener('pointerdown', (event) => {
    if (event.button === 0) press();
  });
  for (const end of ['pointerup', 'pointercancel', 'blur'] as const) window.addEventListener(end, release);
}
