//! What the list of a clip's objects has beside its rows, loaded when it is first shown.

import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { mountClasses } from './classes.js';
import { mountSeveral } from './several.js';

export function mountListTools(root: ParentNode, store: Store, session: Session): void {
  mountClasses(root, store, session);
  mountSeveral(root, store, session);
}
