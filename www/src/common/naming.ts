//! The name of an object: the user's, or its class and its number. And what a clip's name is in names of files.

import { UNLABELLED } from '../result/masks.js';
import { strings } from './strings.js';

/** The names and classes that the user gave to objects, by number. */
interface Naming {
  readonly names: Readonly<Record<number, string>>;
  readonly classes: Readonly<Record<number, string>>;
}

export function nameOf({ names, classes }: Naming, id: number): string {
  return names[id] ?? (id in classes ? `${classes[id]} ${id}` : id === UNLABELLED ? strings.unknownName : strings.objectName(id));
}

/** A clip's name without the extension of a video, as part of a file's name on any system and in any shell. */
export function inFileNames(name: string): string {
  return name.replace(/\.(?=\w*[a-z])\w{2,5}$/i, '').replace(/[\\/:*?"<>|#\s]+/g, '_');
}
