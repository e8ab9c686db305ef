//! A failure ends as a notice in the state, and the page stays usable.

import { codeOf, sentenceOf } from '../common/errors.js';
import type { Store } from '../state/state.js';

export function report(store: Store, error: unknown): void {
  store.say(sentenceOf(error), codeOf(error));
}
