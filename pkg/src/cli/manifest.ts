// The manifest of an output folder, `.veronese`: a line of hash and path for each file that this program wrote there. A file that it does not
// list, or that was changed since, is somebody else's. Paths are relative, so the manifest of a copied folder holds there too.

import { createHash } from 'node:crypto';
import { appendFileSync, closeSync, openSync, readSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { hostname } from 'node:os';
import { join } from 'node:path';
import { keyOf } from '../common/checks.js';
import { lookAt, makeFolder, readWritten, sha256, taken } from './files.js';

const NAME = '.veronese';
/** A mark of this machine, so that two of them may write into one shared folder. */
export const HOST = sha256(hostname()).slice(0, 8);
/** The name of this run for files that are not complete. */
export const RUN = `${NAME}-${HOST}-${process.pid}`;
const HEADER = '# What veronese wrote here: SHA-256 and path. It replaces and deletes no other files, and none that were changed since.\n';
/** In place of a hash: a folder of files that are recognised otherwise. */
const ANY = '*';
const ENTRY = /^([0-9a-f]{64}|\*) {2}(.+)$/;
/** How much of a file is read at once, bytes. */
const CHUNK = 4 * 1024 * 1024;

export class Manifest {
  readonly #folder: string;
  /** By path the hashes of what this program wrote there, the newest last. While a file is replaced there are two. */
  readonly #hashes = new Map<string, string[]>();
  readonly #paths = new Map<string, string>();
  /** The text before the next line. */
  #start = HEADER;
  /** Whether something else is in its place. */
  #isTaken: boolean;

  /** Throws `file-exists` if its place is taken, unless files of others may be replaced. */
  constructor(folder: string, force: boolean) {
    this.#folder = folder;
    const text = textOf(folder);
    if (text?.startsWith(HEADER)) this.#enter(text);
    else if (text !== undefined && !force) throw taken(join(folder, NAME), "is no list of files of this program, and is replaced only with '--force'");
    this.#isTaken = text !== undefined && this.#start === HEADER;
  }

  /** All that was written, whether or not it is still there. */
  get paths(): string[] {
    return [...this.#paths.values()];
  }

  /** Whether what is there is what this program wrote, now or earlier. */
  owns(path: string): boolean {
    return this.#hashes.get(keyOf(path))?.includes(this.#hashIn(path)) === true;
  }

  /** Whether what is there is what this program wrote last. */
  isCurrent(path: string): boolean {
    return this.#hashes.get(keyOf(path))?.at(-1) === this.#hashIn(path);
  }

  ownsFolder(path: string): boolean {
    return this.#hashes.get(keyOf(path))?.includes(ANY) === true;
  }

  addFolder(path: string): void {
    this.add(new Map([[path, ANY]]));
  }

  /** Lists files, by their hashes. This comes before they take their places: whenever the process ends, what is there is known. */
  add(hashes: ReadonlyMap<string, string>): void {
    const fresh = [...hashes].filter(([path, hash]) => this.#hashes.get(keyOf(path))?.at(-1) !== hash);
    if (fresh.length === 0) return;
    makeFolder(this.#folder);
    const place = join(this.#folder, NAME);
    if (this.#isTaken) rmSync(place, { recursive: true, force: true });
    this.#isTaken = false;
    const lines = this.#start + textFor(fresh);
    appendFileSync(place, lines);
    this.#enter(lines);
  }

  /** Writes anew what is there, sorted. Other processes may have added to it. */
  settle(): void {
    this.#enter(textOf(this.#folder) ?? '');
    const listed = [...this.#paths].map(([key, path]) => [path, this.#hashes.get(key)?.at(-1) as string] as const);
    const part = join(this.#folder, `${RUN}.list`);
    writeFileSync(part, HEADER + textFor(listed.filter(([path]) => lookAt(join(this.#folder, path))).sort(([one], [other]) => (one < other ? -1 : 1))));
    renameSync(part, join(this.#folder, NAME));
  }

  #enter(text: string): void {
    this.#start = text.endsWith('\n') ? '' : '\n';
    for (const line of text.split('\n')) {
      const [, hash, path] = ENTRY.exec(line) ?? [];
      if (hash === undefined || path === undefined || !isBelow(path)) continue;
      const known = this.#hashes.get(keyOf(path)) ?? [];
      this.#hashes.set(keyOf(path), [...known.filter((other) => other !== hash), hash]);
      this.#paths.set(keyOf(path), path);
    }
  }

  /** The hash of a listed file as it is; empty where there is none. */
  #hashIn(path: string): string {
    const place = join(this.#folder, path);
    return this.#hashes.has(keyOf(path)) && lookAt(place)?.isFile() ? hashOf(place) : '';
  }
}

/** The text of the manifest; empty if it is no file. */
function textOf(folder: string): string | undefined {
  const place = join(folder, NAME);
  return lookAt(place) && (readWritten(place)?.toString() ?? '');
}

function textFor(entries: readonly (readonly [path: string, hash: string])[]): string {
  return entries.map(([path, hash]) => `${hash}  ${path}\n`).join('');
}

/** Whether a path leads to something in the folder. */
function isBelow(path: string): boolean {
  return path.split('/').every((part) => !/^\.{0,2}$|\\/.test(part));
}

/** Piece by piece: a file may be larger than what can be read at once. */
export function hashOf(path: string): string {
  const [hash, chunk, file] = [createHash('sha256'), Buffer.allocUnsafe(CHUNK), openSync(path, 'r')];
  try {
    for (let length = -1; length !== 0; ) hash.update(chunk.subarray(0, (length = readSync(file, chunk))));
  } finally {
    closeSync(file);
  }
  return hash.digest('hex');
}
