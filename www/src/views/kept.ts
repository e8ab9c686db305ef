//! The work that is kept in this browser: the work to continue, and what became of the work on screen. Loaded once there is any.

import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { mountContinuing } from './continuing.js';
import { find } from './markup.js';
import { mountSaving } from './saving.js';

export function mountKept(root: ParentNode, store: Store, session: Session): void {
  mountContinuing(find(root, '#welcome', HTMLElement), store, session);
  mountSaving(find(root, '#saving', HTMLElement), store, session);
}
