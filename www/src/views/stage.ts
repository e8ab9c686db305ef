//! The picture: the frame on screen, the other one in the split view, and the caption.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { drawStabilised } from '../drawing/warp.js';
import { mainMotion } from '../result/masks.js';
import type { LoadedFrame, Slot } from '../state/pair.js';
import type { State, Store } from '../state/state.js';
import { isDraft } from '../state/tracked.js';
import { contextOf, find } from './markup.js';

export function mountStage(stage: HTMLElement, store: Store): void {
  const layers = find(stage, '.layers', HTMLElement);
  const canvas = find(stage, '#frame', HTMLCanvasElement);
  const other = find(stage, '#other', HTMLCanvasElement);
  const caption = find(stage, '#caption', HTMLElement);
  const draft = find(stage, '#draft', HTMLElement);
  const invitation = find(stage, '#invitation', HTMLElement);

  store.subscribe((now, before) => {
    const { pair, result, look, opening, tracked, timeline } = now;
    const slot = shownSlot(now);
    invitation.hidden = slot !== null || opening;
    if (look.names !== before.look.names || look.kind !== before.look.kind) caption.textContent = captionOf(now);
    if (pair === before.pair && result === before.result && look.view === before.look.view && look.stabilised === before.look.stabilised) return;
    layers.hidden = slot === null;
    caption.textContent = captionOf(now);
    draft.textContent = look.kind === 'objects' && isDraft(tracked, timeline?.[slot ?? 'first'] ?? -1) ? strings.draft : '';
    const frame = slot === null ? null : pair[slot];
    if (slot === null || frame === null) return;
    stage.style.setProperty('--ratio', String(frame.width / frame.height));
    draw(canvas, frame, stabilisingMotion(now, slot));
    other.hidden = look.view !== 'split' || pair.second === null;
    if (!other.hidden && pair.second !== null) draw(other, pair.second, stabilisingMotion(now, 'second'));
  });
}

/** The frame to show; the other one if it is the only one. */
export function shownSlot({ pair, look }: State): Slot | null {
  const wanted: Slot = look.view === 'second' ? 'second' : 'first';
  const others: Slot[] = [wanted, 'first', 'second'];
  return others.find((slot) => pair[slot] !== null) ?? null;
}

/** The motion by which a frame is warped back, if any. */
function stabilisingMotion({ look, result }: State, slot: Slot): readonly number[] | null {
  if (slot !== 'second' || look.stabilised === null || result === null) return null;
  return mainMotion(result.segmentation, look.kind, look.stabilised)?.matrix ?? null;
}

function captionOf(state: State): string {
  const slot = shownSlot(state);
  if (slot === null) return '';
  if (state.live !== null) return strings.camera;
  const { look, timeline } = state;
  if (look.kind === 'objects' && look.view !== 'split' && timeline !== null) return strings.frameNumber(timeline[slot]);
  const held = look.stabilised === null || (look.view === 'first' && !look.blinking) ? '' : strings.stabilised(nameOf(look, look.stabilised));
  return `${look.view === 'split' ? strings.split : strings.slot[slot]}${held}`;
}

function draw(canvas: HTMLCanvasElement, { bitmap, width, height }: LoadedFrame, held: readonly number[] | null): void {
  // Setting the size clears the canvas, even if it does not change.
  canvas.width = width;
  canvas.height = height;
  const context = contextOf(canvas);
  if (held === null) context.drawImage(bitmap, 0, 0);
  else drawStabilised(context, bitmap, held);
}
