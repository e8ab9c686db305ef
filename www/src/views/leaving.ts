//! Leaving the page with corrections that were not saved is asked about. There is no listener otherwise: it would keep the browser
//! from holding the page ready for the way back.

import { hasUnsaved } from '../state/kept.js';
import type { Store } from '../state/state.js';

export function mountLeaving(page: Window, store: Store): void {
  const ask = (event: BeforeUnloadEvent): void => event.preventDefault();
  store.subscribe((now, before) => {
    if (now.edits === before.edits && now.kept === before.kept) return;
    if (hasUnsaved(now)) page.addEventListener('beforeunload', ask);
    else page.removeEventListener('beforeunload', ask);
  });
}
