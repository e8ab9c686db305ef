//! What masks are called: as somebody named them, or by kind and number.

import { UNLABELLED } from './masks.js';
import { type Look, keyOf } from './state.js';
import { strings } from './strings.js';

export function nameOf({ kind, names }: Pick<Look, 'kind' | 'names'>, id: number): string {
  return names[keyOf(kind, id)] ?? (id === UNLABELLED ? strings.unknownName : strings.maskName(kind, id));
}
