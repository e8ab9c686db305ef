//! The projects that this browser keeps, each as the file that a person could save. Loaded when there is one to keep or to look for.

import { fingerprintOfText } from '../frames/fingerprints.js';
import { type Header, headerOf, projectFromFile, streamOf } from './file.js';
import { type Place, placeOfProjects } from './places.js';
import type { Project } from './project.js';

export { fileOf, projectFromFile } from './file.js';
export { owns } from './owner.js';
export { projectFrom, withProject, withSaved } from './project.js';

/** A project in the list. `header` is `null` if the file is damaged. */
export interface Listed {
  readonly file: string;
  readonly header: Header | null;
  readonly bytes: number;
}

let place: Promise<Place> | null = null;

function projects(): Promise<Place> {
  place ??= placeOfProjects().catch((error: unknown) => {
    place = null;
    throw error;
  });
  return place;
}

/** Fingerprints may be too long for names of files. */
function fileNameOf(of: string): string {
  return `${fingerprintOfText(of)}.veronese`;
}

export async function put(project: Project): Promise<void> {
  await (await projects()).write(fileNameOf(project.of), streamOf(project, new Date()));
}

/** The project of this clip or pair; `null` if none is kept. */
export async function get(of: string, name: string): Promise<Project | null> {
  const file = await (await projects()).read(fileNameOf(of));
  const project = file === null ? null : await projectFromFile(file, name);
  return project?.of === of ? project : null;
}

/** When the project of this clip or pair was last written, as an ISO 8601 date; empty if none is kept, or a damaged one. */
export async function savedAt(of: string): Promise<string> {
  const file = await (await projects()).read(fileNameOf(of));
  const header = file === null ? null : await headerOf(file, of).catch(() => null);
  return header?.saved ?? '';
}

/** The latest first. */
export async function list(): Promise<Listed[]> {
  const files = [...(await (await projects()).list())];
  const listed = files.map(async ([file, blob]) => ({ file, header: await headerOf(blob, file).catch(() => null), bytes: blob.size }));
  return (await Promise.all(listed)).sort((one, other) => (other.header?.saved ?? '').localeCompare(one.header?.saved ?? ''));
}

export async function remove(file: string): Promise<void> {
  await (await projects()).remove(file);
}
