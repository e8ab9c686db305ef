//! The clip that opens the page shows what is found while it is found: its frames come one after another with their masks, as its pairs are
//! solved. Then it plays.
//! Whoever touches or opens anything first is not interrupted.

import type { Sample } from '../frames/samples.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { prefersStillness } from './markup.js';

/** How often it plays when all is found. */
const TIMES = 2;
const TOUCHES = ['pointerdown', 'keydown', 'wheel', 'dragover'] as const;

export function mountShowing(root: Window, store: Store, session: Session, sample: Sample): void {
  if (prefersStillness()) return;
  let touched = false;
  const touch = (): void => {
    touched = true;
    for (const kind of TOUCHES) root.removeEventListener(kind, touch, true);
    leave();
    if (store.get().playing) void session.play.toggle();
  };
  for (const kind of TOUCHES) root.addEventListener(kind, touch, { capture: true, passive: true });

  const mayGoOn = (): boolean => !touched && store.get().timeline?.clip.sample === sample;
  const play = async (): Promise<void> => {
    for (let time = 0; time < TIMES && mayGoOn(); time++) {
      await session.frames.goTo(0);
      if (mayGoOn()) await session.play.toggle();
    }
    if (mayGoOn()) await session.frames.goTo(sample.start);
  };
  /** On the way to the frame that was solved last. */
  let isGoing = false;
  let going = Promise.resolve();
  const follow = async (index: number): Promise<void> => {
    isGoing = true;
    await session.frames.goTo(index);
    isGoing = false;
  };
  const leave = store.subscribe(({ tracked }, before) => {
    if (tracked === null) return;
    if (!isGoing && !mayGoOn()) return leave();
    const { previews, run, range, solved } = tracked;
    const goesOn = previews !== before.tracked?.previews || solved !== before.tracked?.solved;
    if (goesOn && run.phase === 'working' && !isGoing) {
      const newest = Math.min(previews.findLastIndex((frame) => frame !== null), range.first + solved - 1);
      if (newest >= 0) going = follow(newest);
    }
    if (run.phase !== 'done') return;
    leave();
    if (run.cause === 'found') void going.then(play);
  });
}
