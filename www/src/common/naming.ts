//! The name of a mask: the user's, or its class or kind and its number. And what a clip's name is in names of files.

import { UNLABELLED, type Kind, keyOf } from '../result/masks.js';
import { strings } from './strings.js';

/** Which masks are meant, and the names and classes that the user gave them, by {@link keyOf}. */
interface Naming {
  readonly kind: Kind;
  readonly names: Readonly<Record<string, string>>;
  readonly classes: Readonly<Record<string, string>>;
}

export function nameOf({ kind, names, classes }: Naming, id: number): string {
  const key = keyOf(kind, id);
  return names[key] ?? (key in classes ? `${classes[key]} ${id}` : id === UNLABELLED ? strings.unknownName : strings.maskName(kind, id));
}

/** A clip's name without the extension of a video, as part of a file's name on any system and in any shell. */
export function inFileNames(name: string): string {
  return name.replace(/\.(?=\w*[a-z])\w{2,5}$/i, '').replace(/[\\/:*?"<>|#\s]+/g, '_');
}
