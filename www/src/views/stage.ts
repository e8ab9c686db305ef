//! The picture: the frame on screen, the one beside it in the split view, and the caption.

import { strings } from '../common/strings.js';
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
    const { pair, result, look, opening, tracked, timeline, live } = now;
    const slot = shownSlot(now);
    invitation.hidden = slot !== null || opening;
    if (look.motions !== before.look.motions || live !== before.live) caption.textContent = captionOf(now);
    if (pair === before.pair && result === before.result && look.view === before.look.view) return;
    layers.hidden = slot === null;
    caption.textContent = captionOf(now);
    draft.textContent = isDraft(tracked, timeline?.[slot ?? 'first'] ?? -1) ? strings.draft : '';
    const frame = slot === null ? null : pair[slot];
    if (slot === null || frame === null) return;
    stage.style.setProperty('--ratio', String(frame.width / frame.height));
    draw(canvas, frame);
    other.hidden = look.view !== 'split' || pair.second === null;
    if (!other.hidden && pair.second !== null) draw(other, pair.second);
  });
}

/** Which of the two frames is seen, alone or on the left; `null` if none is open. */
function shownSlot({ pair, look }: State): Slot | null {
  if (look.view === 'second' && pair.second !== null) return 'second';
  return pair.first === null ? null : 'first';
}

function captionOf(state: State): string {
  const { look, timeline, live } = state;
  const slot = shownSlot(state);
  if (slot === null) return '';
  if (live !== null) return strings.camera;
  const name = (of: Slot): string => (timeline === null ? strings.oneFrame : strings.frameNumber(timeline[of]));
  const seen = look.view === 'split' ? `${name('first')} | ${name('second')}` : name(slot);
  return look.motions ? strings.motionsOf(seen) : seen;
}

function draw(canvas: HTMLCanvasElement, { bitmap, width, height }: LoadedFrame): void {
  // Setting the size clears the canvas, even if it does not change.
  canvas.width = width;
  canvas.height = height;
  contextOf(canvas).drawImage(bitmap, 0, 0);
}
