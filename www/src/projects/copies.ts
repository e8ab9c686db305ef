//! Copies of frames beside the projects, so that work goes on with one click. A copy is one file: the length of a list, the list of the
//! files, and their bytes. The work itself comes first: copies give way to it.

import { pathOf, withPath } from '../frames/files.js';
import { placeOf } from './places.js';

/** Nothing is copied that takes more than this share of the room that is left. */
const SHARE = 0.25;

interface Listed {
  readonly name: string;
  readonly path: string;
  readonly type: string;
  readonly size: number;
}

const place = placeOf('frames');
const copying = new Map<string, Promise<boolean>>();

/** Copies the files, unless they are there. Returns whether they are. */
export function keepFrames(name: string, files: readonly File[]): Promise<boolean> {
  const kept = copying.get(name) ?? copied(name, files).catch(() => false).finally(() => copying.delete(name));
  copying.set(name, kept);
  return kept;
}

async function copied(name: string, files: readonly File[]): Promise<boolean> {
  const folder = await place();
  if ((await folder.sizes()).has(name)) return true;
  const size = files.reduce((sum, file) => sum + file.size, 0);
  const { quota = 0, usage = 0 } = await navigator.storage.estimate();
  if (size > Math.min(folder.largest, SHARE * (quota - usage))) return false;
  const list = new TextEncoder().encode(JSON.stringify(files.map((file): Listed => ({ name: file.name, path: pathOf(file).join('/'), type: file.type, size: file.size }))));
  const length = new DataView(new ArrayBuffer(4));
  length.setUint32(0, list.length, true);
  await folder.write(name, new Blob([length, list, ...files]).stream());
  return true;
}

/** The sizes of all copies by name, bytes. */
export async function copies(): Promise<ReadonlyMap<string, number>> {
  return (await place()).sizes();
}

/** The files of a copy; none if there is no such copy. They are read while the clip is open, so the copy stays until this tab is closed. */
export async function framesOf(name: string): Promise<File[]> {
  await used(name);
  const copy = await (await place()).read(name);
  if (copy === null) return [];
  const length = new DataView(await copy.slice(0, 4).arrayBuffer()).getUint32(0, true);
  let at = 4 + length;
  return (JSON.parse(await copy.slice(4, at).text()) as Listed[]).map(({ name, path, type, size }) => {
    const file = new File([copy.slice(at, (at += size))], name, { type });
    return path === name ? file : withPath(file, path);
  });
}

/** Removes a copy, unless a tab reads frames from it, which would lose them, or writes it. Returns whether it did. */
export async function removeFrames(name: string): Promise<boolean> {
  const folder = await place();
  const remove = (): Promise<boolean> => folder.remove(name).then(() => true, () => false);
  if (!('locks' in navigator)) return remove();
  return navigator.locks.request(lockOf(name), { ifAvailable: true }, (lock) => lock !== null && remove());
}

/** Makes room for work. Returns whether any copy was removed. */
export async function removeAllFrames(): Promise<boolean> {
  const removed = await Promise.all([...(await copies()).keys()].map(removeFrames));
  return removed.includes(true);
}

/** Holds a copy until this tab is closed. Browsers without locks have copies in a database, which are in memory once they are read. */
async function used(name: string): Promise<void> {
  if (!('locks' in navigator)) return;
  await new Promise<void>((resolve, reject) => {
    const hold = (): Promise<never> => {
      resolve();
      return new Promise(() => undefined);
    };
    navigator.locks.request(lockOf(name), { mode: 'shared' }, hold).catch(reject);
  });
}

function lockOf(name: string): string {
  return `veronese frames ${name}`;
}
