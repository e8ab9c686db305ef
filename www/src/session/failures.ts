//! What fails ends as a notice in the state, and the page stays usable.

import { PageError, codeOf, sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { Store } from '../state/state.js';

export function report(store: Store, error: unknown): void {
  store.say(sentenceOf(error), codeOf(error));
}

/** Reports what ended the work on the pair. */
export function fail(store: Store, error: unknown): void {
  store.set({ run: { phase: 'failed' }, notice: { sentence: sentenceOf(error), code: codeOf(error) } });
}

/** A part of the page that is loaded when it is used. */
export function loaded<T>(part: Promise<T>): Promise<T> {
  return part.catch(() => {
    throw new PageError('not-loaded', strings.errors.notLoaded);
  });
}
