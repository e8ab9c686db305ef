//! The in point and the out point on the timeline: handles to drag, and what is outside them shaded.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import type { Range } from '../state/tracked.js';
import { find } from './markup.js';
import { currentFrame } from './timeline.js';

/** A press that moves less goes to the frame, like any other on the track, screen pixels. */
const STILL = 3;

export function mountRange(root: HTMLElement, store: Store, session: Session): void {
  const track = find(root, '#track', HTMLElement);
  const handles = (['first', 'last'] as const).map((edge) => {
    const handle = find(root, `[data-edge=${edge}]`, HTMLElement);
    mountHandle(handle, edge, track, store, session);
    return { edge, handle };
  });
  store.subscribe(({ tracked }, before) => {
    if (tracked === null || (tracked.range === before.tracked?.range && tracked.clip === before.tracked.clip)) return;
    const { clip, range } = tracked;
    root.style.setProperty('--in', String(range.first / clip.count));
    root.style.setProperty('--out', String((range.last + 1) / clip.count));
    for (const { edge, handle } of handles) {
      handle.setAttribute('aria-valuemax', String(clip.count - 1));
      handle.setAttribute('aria-valuenow', String(range[edge]));
      handle.setAttribute('aria-valuetext', strings.frameNumber(range[edge]));
    }
  });
}

/** The frame on screen becomes the in point or the out point. */
export function setEdge(store: Store, session: Session, edge: keyof Range): void {
  const { timeline } = store.get();
  if (timeline !== null) session.clip.setRange(edge, currentFrame(timeline));
}

function mountHandle(handle: HTMLElement, edge: keyof Range, track: HTMLElement, store: Store, session: Session): void {
  /** Where a place on the screen lies on the track, frames. */
  const placeAt = (x: number): number => {
    const { left, width } = track.getBoundingClientRect();
    return ((x - left) / width) * (store.get().timeline?.clip.count ?? 1);
  };
  /** Where the pointer went down, and how far from the point that it drags, screen pixels. */
  let from: number | null = null;
  let off = 0;
  handle.addEventListener('pointerdown', (event) => {
    const range = store.get().tracked?.range;
    if (event.button !== 0 || range === undefined) return;
    handle.setPointerCapture(event.pointerId);
    from = event.clientX;
    const { left, width } = track.getBoundingClientRect();
    const point = edge === 'first' ? range.first : range.last + 1;
    off = event.clientX - left - (point / (store.get().timeline?.clip.count ?? 1)) * width;
  });
  handle.addEventListener('pointermove', (event) => {
    if (!handle.hasPointerCapture(event.pointerId) || (from !== null && Math.abs(event.clientX - from) < STILL)) return;
    from = null;
    session.clip.setRange(edge, Math.round(placeAt(event.clientX - off)) - (edge === 'first' ? 0 : 1));
  });
  handle.addEventListener('pointerup', (event) => {
    if (from !== null) void session.frames.goTo(Math.min(Math.max(Math.floor(placeAt(event.clientX)), 0), (store.get().timeline?.clip.count ?? 1) - 1));
    from = null;
  });
  handle.addEventListener('keydown', (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    const { tracked } = store.get();
    if (by === undefined || tracked === null || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    session.clip.setRange(edge, tracked.range[edge] + by);
  });
}
