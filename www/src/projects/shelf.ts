//! The projects that this browser keeps, each as the file that a person could save. Loaded when there is one to keep or to look for.

import { isStorageFull } from '../common/errors.js';
import { fingerprintOfText } from '../frames/fingerprints.js';
import { copies, keepFrames, removeAllFrames, removeFrames } from './copies.js';
import { type Header, headerOf, projectFromFile, streamOf } from './file.js';
import { placeOf } from './places.js';
import type { Project } from './project.js';

export { framesOf } from './copies.js';
export { fileOf, projectFromFile } from './file.js';
export { isOwned, owns } from './owner.js';
export { projectFrom, withProject, withSaved, withoutSaved } from './project.js';
export { thumbnailOf } from './thumbnail.js';

/** A project in the list. `header` is `null` if the file is damaged. */
export interface Listed {
  readonly file: string;
  readonly header: Header | null;
  /** Of the project and the copy of its frames. */
  readonly bytes: number;
  /** Whether there is a copy of its frames. */
  readonly hasFrames: boolean;
}

const projects = placeOf('projects');
const watching: (() => void)[] = [];

/** Calls `listener` when the list has changed. */
export function watch(listener: () => void): void {
  watching.push(listener);
}

function changed(): void {
  for (const listener of watching) listener();
}

/** Fingerprints may be too long for names of files. */
function fileNameOf(of: string): string {
  return `${fingerprintOfText(of)}.veronese`;
}

export async function put(project: Project): Promise<void> {
  const write = async (): Promise<void> => (await projects()).write(fileNameOf(project.of), streamOf(project, new Date()));
  try {
    await write();
  } catch (error) {
    if (!isStorageFull(error) || !(await removeAllFrames().catch(() => false))) throw error;
    await write();
  }
  changed();
}

/** Keeps a copy of the frames of this clip. Returns whether there is one. */
export async function putFrames(of: string, files: readonly File[]): Promise<boolean> {
  const kept = await keepFrames(fileNameOf(of), files);
  changed();
  return kept;
}

/** The project of this clip; `null` if none is kept. */
export async function get(of: string, name: string): Promise<Project | null> {
  const file = await (await projects()).read(fileNameOf(of));
  const project = file === null ? null : await projectFromFile(file, name);
  return project?.of === of ? project : null;
}

/** When the project of this clip was last written, as an ISO 8601 date; empty if none is kept, or a damaged one. */
export async function savedAt(of: string): Promise<string> {
  const file = await (await projects()).read(fileNameOf(of));
  const header = file === null ? null : await headerOf(file, of).catch(() => null);
  return header?.saved ?? '';
}

/** The latest first. */
export async function list(): Promise<Listed[]> {
  const folder = await projects();
  const copied = await copies().catch((): Awaited<ReturnType<typeof copies>> => new Map());
  const files = [...(await folder.sizes()).keys()];
  // A copy that was in use when its project was forgotten goes now. Copies are made after projects, and so were looked for before them.
  for (const name of copied.keys()) if (!files.includes(name)) await removeFrames(name);
  const listed = files.map(async (file): Promise<Listed[]> => {
    const content = await folder.read(file);
    return content === null ? [] : [{ file, header: await headerOf(content, file).catch(() => null), bytes: content.size + (copied.get(file) ?? 0), hasFrames: copied.has(file) }];
  });
  return (await Promise.all(listed)).flat().sort((one, other) => (other.header?.saved ?? '').localeCompare(one.header?.saved ?? ''));
}

export async function remove(file: string): Promise<void> {
  await (await projects()).remove(file);
  // Its frames may be on screen: `list` removes the copy later.
  await removeFrames(file).catch(() => false);
  changed();
}
