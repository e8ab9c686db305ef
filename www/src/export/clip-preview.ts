//! A preview of a clip's export: the names of its files, and the content for one frame.

import type { State } from '../state/state.js';
import type { Tracked } from '../state/tracked.js';
import { type ClipFormat, exportOfClip, exportOfFrame } from './clip-export.js';

/** Files of one folder, in their order. */
export interface Folder {
  /** Ends with a slash; empty for files without a folder. */
  readonly path: string;
  readonly files: readonly string[];
}

export interface Preview {
  readonly folders: readonly Folder[];
  /**
   * The file that is shown: its size in bytes, and whether it is written for this frame or will have the other frames too. `null` if the
   * frame has no masks, or if the format has a picture of its own.
   */
  readonly file: { readonly name: string; readonly bytes: number; readonly ofFrame: boolean } | null;
  /** The content: a picture, or the beginning of a text. */
  readonly shown: Blob | string | null;
}

/** Characters of a text. */
const BEGINNING = 480;

/** `null` if no object is ticked. */
export async function previewOf(format: ClipFormat, tracked: Tracked, shown: Pick<State, 'look' | 'classList'>, index: number): Promise<Preview | null> {
  const whole = exportOfClip(tracked, shown);
  if (whole.objects.length === 0) return null;
  const folders = foldersOf(await format.names(whole));
  const one = exportOfFrame(tracked, shown, index);
  if (one === null) return { folders, file: null, shown: null };
  if (format.picture !== undefined) return { folders, file: null, shown: await format.picture(one) };
  const [[name, content]] = Object.entries(await format.make(one)) as [[string, string | Uint8Array<ArrayBuffer>]];
  const file = { name: name.replace(/^.*\//, ''), bytes: new Blob([content]).size, ofFrame: name.includes(one.stems[0]!) };
  if (typeof content !== 'string') return { folders, file, shown: new Blob([content], { type: 'image/png' }) };
  return { folders, file, shown: content.slice(0, BEGINNING) + (content.length > BEGINNING ? '…' : '') };
}

function foldersOf(names: readonly string[]): Folder[] {
  const folders = new Map<string, string[]>();
  for (const name of names) {
    const end = name.lastIndexOf('/') + 1;
    folders.set(name.slice(0, end), [...(folders.get(name.slice(0, end)) ?? []), name.slice(end)]);
  }
  return [...folders].map(([path, files]) => ({ path, files }));
}
