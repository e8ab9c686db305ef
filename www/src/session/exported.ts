//! A record of what was taken away. Loaded with the panel.

import type { Store } from '../state/state.js';
import { type Tracked, savedOf } from '../state/tracked.js';

/** Records that the masks of the clip were exported as they are. */
export function clipExported(store: Store, exported: Tracked): void {
  const { tracked } = store.get();
  if (tracked?.clip === exported.clip) store.clip({ saved: savedOf(exported) });
}
