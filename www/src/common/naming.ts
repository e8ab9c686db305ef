//! The name of a mask: the user's, or its kind and number.

import { UNLABELLED, type Kind, keyOf } from '../result/masks.js';
import { strings } from './strings.js';

/** Which masks are meant, and the names that the user gave them, by {@link keyOf}. */
interface Naming {
  readonly kind: Kind;
  readonly names: Readonly<Record<string, string>>;
}

export function nameOf({ kind, names }: Naming, id: number): string {
  return names[keyOf(kind, id)] ?? (id === UNLABELLED ? strings.unknownName : strings.maskName(kind, id));
}
