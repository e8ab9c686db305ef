//! Asks before the page is left with unsaved corrections. Without them there is no listener, because it would keep the page out of the
//! back/forward cache.

import type { Store } from '../state/state.js';
import { isUnsavedClip } from '../state/tracked.js';

export function mountLeaving(page: Window, store: Store): void {
  const ask = (event: BeforeUnloadEvent): void => event.preventDefault();
  store.subscribe((now, before) => {
    if (now.tracked === before.tracked && now.keptClips === before.keptClips) return;
    if ([now.tracked, ...now.keptClips.values()].some((clip) => clip !== null && isUnsavedClip(clip))) page.addEventListener('beforeunload', ask);
    else page.removeEventListener('beforeunload', ask);
  });
}
