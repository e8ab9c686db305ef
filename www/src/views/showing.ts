//! The clip that opens the page plays once its objects are found, so that a visitor sees what follows them. Whoever touches anything first
//! is not interrupted.

import type { SampleClip } from '../frames/samples.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { prefersStillness } from './markup.js';

/** How often it plays. */
const TIMES = 2;
const TOUCHES = ['pointerdown', 'keydown', 'wheel', 'dragover'] as const;

export function mountShowing(root: Window, store: Store, session: Session, { start }: SampleClip): void {
  if (prefersStillness()) return;
  let touched = false;
  const touch = (): void => {
    touched = true;
    for (const kind of TOUCHES) root.removeEventListener(kind, touch, true);
    leave();
    if (store.get().playing) void session.play.toggle();
  };
  for (const kind of TOUCHES) root.addEventListener(kind, touch, { capture: true, passive: true });

  const show = async (): Promise<void> => {
    for (let time = 0; time < TIMES && !touched; time++) {
      await session.frames.goTo(0);
      if (!touched) await session.play.toggle();
    }
    if (!touched) await session.frames.goTo(start);
  };
  const leave = store.subscribe(({ tracked }) => {
    if (tracked?.run.phase !== 'done') return;
    leave();
    if (tracked.run.cause === 'found') void show();
  });
}
