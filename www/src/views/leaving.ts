//! Asks before the page is left with unsaved corrections. Without them there is no listener, because it would keep the page out of the
//! back/forward cache.

import { hasUnsaved } from '../state/kept.js';
import type { Store } from '../state/state.js';

export function mountLeaving(page: Window, store: Store): void {
  const ask = (event: BeforeUnloadEvent): void => event.preventDefault();
  store.subscribe((now, before) => {
    if ((['edits', 'kept', 'tracked', 'keptClips'] as const).every((part) => now[part] === before[part])) return;
    if (hasUnsaved(now)) page.addEventListener('beforeunload', ask);
    else page.removeEventListener('beforeunload', ask);
  });
}
