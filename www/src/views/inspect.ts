//! What is measured of the pair on screen, under *Inspect*: loaded when that is unfolded.

import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { mountEvidence } from './evidence.js';
import { find } from './markup.js';
import { mountTimings } from './timings.js';

export function mountInspect(root: HTMLElement, store: Store, session: Session): void {
  mountEvidence(find(root, '#evidence', HTMLElement), store, session);
  mountTimings(find(root, '#timings', HTMLElement), store);
}
