// Files of the command line: what it reads, and the folders it writes to.

import { createHash } from 'node:crypto';
import { type Dirent, existsSync, lstatSync, mkdirSync, readdirSync, readFileSync, type Stats, statSync } from 'node:fs';
import { open, readFile } from 'node:fs/promises';
import { dirname, extname, resolve } from 'node:path';
import { VeroneseError } from '../common/errors.js';

/** Largest input, bytes: more than the largest frame needs in the most wasteful of the formats. */
const LARGEST = 512 * 1024 * 1024;

/**
 * Throws `file-not-found` or `unreadable-file`. Only whole files are read: a read that waits for a pipe would keep the
 * process from ending when it is told to. With `most`, of a larger one the beginning alone.
 */
export async function readInput(path: string, most = Infinity): Promise<Uint8Array> {
  const { size } = checkedFile(path);
  if (Math.min(size, most) > LARGEST) throw new VeroneseError('unreadable-file', `'${path}' is larger than ${LARGEST / 1024 / 1024} MB`);
  try {
    if (size <= most) return new Uint8Array(await readFile(path));
    const file = await open(path);
    const { buffer, bytesRead } = await file.read(new Uint8Array(most), 0, most, 0).finally(() => file.close());
    return buffer.subarray(0, bytesRead);
  } catch (thrown) {
    throw unreadable(path, thrown);
  }
}

/** The status of a file. Throws as {@link readInput}. */
export function checkedFile(path: string): Stats {
  let status: Stats;
  try {
    status = statSync(path);
  } catch (thrown) {
    throw unreadable(path, thrown);
  }
  if (status.isFile()) return status;
  const kind = status.isDirectory() ? 'a folder' : 'a pipe or a device, not a file';
  throw new VeroneseError('unreadable-file', `'${path}' is ${kind}`);
}

/** What is in a folder, by name. Throws as {@link readInput}. */
export function entriesOf(folder: string): Dirent[] {
  try {
    return readdirSync(folder, { withFileTypes: true }).sort((one, other) => (one.name < other.name ? -1 : 1));
  } catch (thrown) {
    throw unreadable(folder, thrown);
  }
}

/** The error of a place that cannot be read. */
export function unreadable(path: string, thrown: unknown): VeroneseError {
  const { code, message } = thrown as NodeJS.ErrnoException;
  if (code === 'ENOENT' || (code === 'ENOTDIR' && !existsSync(path))) return notFound(path);
  return new VeroneseError('unreadable-file', `'${path}' cannot be read: ${message}`);
}

/** Names the first folder on the way that is missing. */
export function notFound(path: string): VeroneseError {
  let [missing, above] = [path, dirname(path)];
  for (; above !== dirname(above) && !existsSync(above); above = dirname(above)) missing = above;
  const kind = missing !== path ? 'folder' : extname(path) === '' ? 'file or folder' : 'file';
  return new VeroneseError('file-not-found', `there is no ${kind} '${missing}'${missing === path ? '' : `, and so no '${path}'`}`);
}

/** Throws `write-failed` early, before the work, where the output folder cannot be one. */
export function checkFolder(folder: string): void {
  let problem: string | undefined;
  try {
    if (statSync(folder, { throwIfNoEntry: false })?.isDirectory() === false) problem = 'it is a file';
  } catch (thrown) {
    problem = thrown instanceof Error ? thrown.message : String(thrown);
  }
  if (problem) throw writeFailed(folder, problem);
}

/** `reason`: a sentence, or what was thrown. A {@link VeroneseError} stays what it is. */
export function writeFailed(folder: string, reason: unknown): VeroneseError {
  if (reason instanceof VeroneseError) return reason;
  const sentence = reason instanceof Error ? reason.message : String(reason);
  return new VeroneseError('write-failed', `the results cannot be written into '${folder}': ${sentence}`);
}

/** Rejects with `write-failed` where `write` fails. */
export async function writing<T>(folder: string, write: () => T | Promise<T>): Promise<T> {
  try {
    return await write();
  } catch (thrown) {
    throw writeFailed(folder, thrown);
  }
}

/**
 * Makes a folder and those above it, one after another. Node's own recursive call never ends where the file system says of a folder that
 * the one above it is missing, as /proc does.
 */
export function makeFolder(folder: string): void {
  const missing: string[] = [];
  for (let place = resolve(folder); !isFolder(place); place = dirname(place)) {
    if (place === dirname(place)) break;
    missing.push(place);
  }
  for (const place of missing.reverse()) {
    try {
      mkdirSync(place);
    } catch (thrown) {
      // Another process may have made it.
      if ((thrown as NodeJS.ErrnoException).code !== 'EEXIST' || !isFolder(place)) throw thrown;
    }
  }
}

export function isFolder(place: string): boolean {
  return statSync(place, { throwIfNoEntry: false })?.isDirectory() === true;
}

/** The status of a place, of a link itself. Throws `write-failed` where nothing can be. */
export function lookAt(path: string): Stats | undefined {
  try {
    return lstatSync(path, { throwIfNoEntry: false });
  } catch (thrown) {
    throw writeFailed(dirname(path), thrown);
  }
}

/** The error of a place that is taken. */
export function taken(place: string, reason: string): VeroneseError {
  return new VeroneseError('file-exists', `'${place}' ${reason}: move it, delete it, or choose another folder with '--out'`);
}

/** The content of a file that the program may have written. Undefined where there is none, or something else, which may keep a reader waiting. */
export function readWritten(path: string): string | undefined {
  return lstatSync(path, { throwIfNoEntry: false })?.isFile() ? readFileSync(path, 'utf8') : undefined;
}

/** The value in such a file of JSON. Undefined where it is missing, damaged or not ours. */
export function parsedJson(path: string): unknown {
  try {
    return JSON.parse(readWritten(path) ?? '');
  } catch {
    return undefined;
  }
}

export const sha256 = (bytes: Uint8Array | string): string => createHash('sha256').update(bytes).digest('hex');

export interface OutputFile {
  name: string;
  bytes: Uint8Array;
}
