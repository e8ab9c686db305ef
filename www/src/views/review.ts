//! The bar on the timeline that shows which frames are accepted, and which the last correction changed.

import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { acceptedIn, changedIn, isReady } from '../state/tracked.js';
import { contextOf, find } from './markup.js';

/** The colours of frames in the bar. */
const [ACCEPTED, CHANGED] = ['#3fbf6f', '#f06cd8'];

export function mountReview(root: HTMLElement, store: Store): void {
  const bar = find(root, '#review-bar', HTMLCanvasElement);
  store.subscribe(({ tracked }, before) => {
    if (tracked === before.tracked) return;
    bar.hidden = !isReady(tracked);
    if (!isReady(tracked)) return;
    bar.width = tracked.clip.count;
    const context = contextOf(bar);
    for (const [indices, colour] of [[acceptedIn(tracked), ACCEPTED], [changedIn(tracked).keys(), CHANGED]] as const) {
      context.fillStyle = colour;
      for (const index of indices) context.fillRect(index, 0, 1, 1);
    }
  });
}

/** Accepts masks, and goes to the frame that most needs a look. */
export function accept(session: Session, which: 'shown' | 'all'): void {
  const next = session.objects.accept(which);
  if (next !== null) void session.frames.goTo(next);
}
