//! The files of a drop or a paste, those in folders included.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { withPath } from './files.js';

/**
 * The files of a drop or a paste. Files of a folder have their path in `webkitRelativePath`, as from a folder picker. Call this while the
 * event is being handled: the browser clears the transfer afterwards.
 */
export function filesOf({ items }: DataTransfer): Promise<File[]> {
  const given = [...items].filter(({ kind }) => kind === 'file').map((item): Promise<File | File[] | null> => {
    const entry = item.webkitGetAsEntry();
    return entry?.isDirectory ? filesIn(entry as FileSystemDirectoryEntry) : Promise.resolve(item.getAsFile());
  });
  return Promise.all(given).then((found) => found.flat().filter((file) => file !== null));
}

async function filesIn(folder: FileSystemDirectoryEntry): Promise<File[]> {
  try {
    const entries = await entriesOf(folder);
    return (await Promise.all(entries.map((entry) => (entry.isDirectory ? filesIn(entry as FileSystemDirectoryEntry) : fileOf(entry as FileSystemFileEntry))))).flat();
  } catch (error) {
    if (error instanceof PageError) throw error;
    throw new PageError('unreadable-folder', strings.errors.unreadableFolder(folder.name));
  }
}

/** Reads all entries: browsers return them in batches, and an empty batch at the end. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const entries: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return entries;
    entries.push(...some);
  }
}

async function fileOf(entry: FileSystemFileEntry): Promise<File> {
  const file = await new Promise<File>((resolve, reject) => entry.file(resolve, reject));
  return withPath(file, entry.fullPath.replace(/^\//, ''));
}
