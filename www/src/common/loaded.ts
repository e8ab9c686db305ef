//! Parts of the page that are loaded when they are used.

import { PageError } from './errors.js';
import { strings } from './strings.js';

/** The part, or a {@link PageError} if it cannot be loaded. */
export function loaded<T>(part: Promise<T>): Promise<T> {
  return part.catch(() => {
    throw new PageError('not-loaded', strings.errors.notLoaded);
  });
}
