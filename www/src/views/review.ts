//! The review of a clip: accepting the masks of a frame or of all frames, how far that is, and what the last correction changed.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type Store, seenIn } from '../state/state.js';
import { acceptedIn, changedIn, isReady, isTracked, masksIn } from '../state/tracked.js';
import { contextOf, find } from './markup.js';

/** The colours of frames in the bar. */
const [ACCEPTED, CHANGED] = ['#3fbf6f', '#f06cd8'];

export function mountReview(root: HTMLElement, store: Store, session: Session): void {
  const box = find(root, '#review', HTMLElement);
  const status = find(root, '#reviewed', HTMLElement);
  const one = find(root, '#accept', HTMLButtonElement);
  const all = find(root, '#accept-all', HTMLButtonElement);
  const next = find(root, '#next-change', HTMLButtonElement);
  const bar = find(root, '#review-bar', HTMLCanvasElement);
  one.addEventListener('click', () => accept(session, 'shown'));
  all.addEventListener('click', () => accept(session, 'all'));
  next.addEventListener('click', () => session.frames.goToChanged());

  store.subscribe((now, before) => {
    const { tracked, look, pair } = now;
    if (tracked === before.tracked && look === before.look && pair === before.pair) return;
    box.hidden = bar.hidden = !isTracked(tracked) || !isReady(tracked);
    if (box.hidden || tracked === null) return;
    const { frames, clip } = tracked;
    const accepted = acceptedIn(tracked);
    status.textContent = strings.accepted(accepted.length, masksIn(frames, { first: 0, last: clip.count - 1 }));
    all.disabled = accepted.length === masksIn(frames, { first: 0, last: clip.count - 1 });
    one.disabled = all.disabled && accepted.includes(seenIn(now)?.index ?? -1);
    bar.width = clip.count;
    const context = contextOf(bar);
    const changed = [...changedIn(tracked).keys()];
    next.hidden = changed.length === 0;
    next.textContent = strings.changedFrames(changed.length);
    for (const [indices, colour] of [[accepted, ACCEPTED], [changed, CHANGED]] as const) {
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
