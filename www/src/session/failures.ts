//! A failure ends as a notice in the state, and the page stays usable.

import { codeOf, sentenceOf } from '../common/errors.js';
import type { Store } from '../state/state.js';

export function report(store: Store, error: unknown): void {
  store.say(sentenceOf(error), codeOf(error));
}

/** Reports what ended the work on the pair. */
export function fail(store: Store, error: unknown): void {
  store.set({ run: { phase: 'failed' }, notice: { sentence: sentenceOf(error), code: codeOf(error), choices: [] } });
}
