//! The projects that this browser keeps. Loaded when there is one to keep or to look for.

import { fingerprintOfText } from '../frames/fingerprints.js';
import { copies, framesOf as filesOf, keepFrames, removeFrames } from './copies.js';
import { forget, headers, putHeader } from './database.js';
import type { Header } from './file.js';

export { headerOf, masksOf, putMasks } from './database.js';
export { fileOf, headerFrom, projectFromFile } from './file.js';
export { PageJournal } from './journal.js';
export { isOwn, isOwned } from './owner.js';
export { thumbnailOf } from './thumbnail.js';

/** A project in the list. */
export interface Listed {
  readonly header: Header;
  /** Of the project and the copy of its frames. */
  readonly bytes: number;
  /** Whether there is a copy of its frames. */
  readonly hasFrames: boolean;
}

const watching: (() => void)[] = [];

/** Calls `listener` when the list has changed. */
export function watch(listener: () => void): void {
  watching.push(listener);
}

function changed(): void {
  for (const listener of watching) listener();
}

export async function put(header: Header): Promise<void> {
  await putHeader(header);
  changed();
}

/** Keeps a copy of the frames of this clip. Returns whether there is one. */
export async function putFrames(of: string, files: readonly File[]): Promise<boolean> {
  const kept = await keepFrames(copyOf(of), files);
  changed();
  return kept;
}

/** The copy of the frames of this clip. */
export function framesOf(of: string): Promise<File[]> {
  return filesOf(copyOf(of));
}

/** The latest first. */
export async function list(): Promise<Listed[]> {
  const copied = await copies().catch((): Awaited<ReturnType<typeof copies>> => new Map());
  const all = await headers();
  // A copy that was in use when its project was forgotten goes now. Copies are made after projects, and so were looked for before them.
  const own = new Set(all.map(({ of }) => copyOf(of)));
  for (const name of copied.keys()) if (!own.has(name)) await removeFrames(name);
  return all
    .map((header): Listed => ({ header, bytes: header.bytes + (copied.get(copyOf(header.of)) ?? 0), hasFrames: copied.has(copyOf(header.of)) }))
    .sort((one, other) => other.header.saved.localeCompare(one.header.saved));
}

export async function remove(of: string): Promise<void> {
  await forget(of);
  // Its frames may be on screen: `list` removes the copy later.
  await removeFrames(copyOf(of)).catch(() => false);
  changed();
}

/** The name of a copy. Fingerprints may be too long for names of files. */
function copyOf(of: string): string {
  return fingerprintOfText(of);
}
