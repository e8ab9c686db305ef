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
  if (timeline !== null) session.tracking.setRange(edge, currentFrame(timeline));
}

function mountHandle(handle: HTMLElement, edge: keyof Range, track: HTMLElement, store: Store, session: Session): void {
  const indexAt = ({ clientX }: PointerEvent): number => {
    const { left, width } = track.getBoundingClientRect();
    return Math.floor(((clientX - left) / width) * (store.get().timeline?.clip.count ?? 1));
  };
  let from: number | null = null;
  handle.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    handle.setPointerCapture(event.pointerId);
    from = event.clientX;
  });
  handle.addEventListener('pointermove', (event) => {
    if (!handle.hasPointerCapture(event.pointerId) || (from !== null && Math.abs(event.clientX - from) < STILL)) return;
    from = null;
    session.tracking.setRange(edge, indexAt(event));
  });
  handle.addEventListener('pointerup', (event) => {
    if (from !== null) void session.goTo(Math.min(Math.max(indexAt(event), 0), (store.get().timeline?.clip.count ?? 1) - 1));
    from = null;
  });
  handle.addEventListener('keydown', (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    const { tracked } = store.get();
    if (by === undefined || tracked === null || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    session.tracking.setRange(edge, tracked.range[edge] + by);
  });
}
