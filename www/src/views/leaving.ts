//! Asks before the page is left with unsaved corrections. Without them there is no listener, because it would keep the page out of the
//! back/forward cache.

import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';

export function mountLeaving(page: Window, store: Store, session: Session): void {
  const ask = (event: BeforeUnloadEvent): void => event.preventDefault();
  store.subscribe(() => {
    if (session.projects.isUnsaved) page.addEventListener('beforeunload', ask);
    else page.removeEventListener('beforeunload', ask);
  });
}
