// The ledger of an output folder, `.veronese`: which files in it this program wrote, and a hash of each. What is not in it, or was changed
// since, is not replaced or deleted by any command. Paths are relative, so the ledger of a copied folder holds there too.

import { createHash } from 'node:crypto';
import { appendFileSync, type BigIntStats, createReadStream, existsSync, lstatSync, readdirSync, readFileSync, renameSync, rmdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { hostname } from 'node:os';
import { dirname, join } from 'node:path';
import { setImmediate } from 'node:timers/promises';
import { isObject, keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { HIDDEN, TRACKS, tracksOf } from './clip-folder.js';
import { makeFolder, readWritten, sha256, writeFailed } from './files.js';
import { filesOfPair, RESULT, resultOf } from './pair-folder.js';

const NAME = '.veronese';
const HEADER = '# What veronese wrote here: SHA-256 and path. It replaces and deletes no other files, and none that were changed since.\n';
/** In place of a hash: a folder of files that are recognised otherwise. */
const ANY = '*';
const ENTRY = /^([0-9a-f]{64}|\*) {2}(.+)$/;
/** Files up to this size are hashed at once, bytes. */
const SMALL = 4 * 1024 * 1024;

/** A mark of this machine, so that two of them may write into one shared folder. */
export const HOST = sha256(hostname()).slice(0, 8);

/** What something is called while it is written. */
export const temporary = (name: string): string => `.${name}.${HOST}-${process.pid}.part`;

interface Entry {
  path: string;
  /** All that it may have: while a file is replaced, the old one and the new one. */
  hashes: Set<string>;
}

export class Ledger {
  readonly #folder: string;
  readonly #entries: Map<string, Entry>;
  /** What was written by this object, with its hashes. */
  readonly #written = new Map<string, string>();
  /** Marks of files that were found to be our own, by which a change is noticed without another look at the content. */
  readonly #own = new Map<string, string>();

  private constructor(folder: string, entries: Map<string, Entry>) {
    this.#folder = folder;
    this.#entries = entries;
  }

  /** Where there is no ledger, a complete record of version 0.1.0 stands for one. Throws `file-exists` if its place is taken. */
  static async open(folder: string): Promise<Ledger> {
    return new Ledger(folder, read(folder) ?? (await earlier(folder)));
  }

  /**
   * Throws `file-exists` unless in each of the places is nothing or a file of our own that is not among the `inputs` ({@link idsOf}), and
   * `write-failed` where a folder is in the way.
   */
  async check(paths: Iterable<string>, inputs: ReadonlySet<string> = new Set()): Promise<void> {
    for (const path of paths) {
      const status = this.#statusOf(path);
      if (!status) continue;
      if (inputs.has(idOf(status))) throw taken(join(this.#folder, path), 'is an input, and would be overwritten');
      if (!(await this.#isOwn(path, status))) throw foreign(join(this.#folder, path));
    }
  }

  /** Throws `file-exists` unless a folder below is our own as a whole, or has no file of these names. */
  checkFolder(path: string, names: RegExp): void {
    const place = join(this.#folder, path);
    if (this.#entries.get(keyOf(path))?.hashes.has(ANY) || !existsSync(place)) return;
    const name = readdirSync(place).find((name) => names.test(name));
    if (name !== undefined) throw foreign(join(place, name));
  }

  /** Makes a folder below, in which files of these names are our own whatever is in them. */
  claimFolder(path: string, names: RegExp): void {
    this.checkFolder(path, names);
    if (!this.#entries.has(keyOf(path))) this.#append(path, ANY);
    makeFolder(join(this.#folder, path));
  }

  /** Writes a file: it is there as a whole or not at all. */
  async write(path: string, content: Uint8Array | string): Promise<void> {
    await this.check([path]);
    const folder = dirname(join(this.#folder, path));
    const part = join(folder, temporary(path.slice(path.lastIndexOf('/') + 1)));
    try {
      makeFolder(folder);
      writeFileSync(part, content);
      this.put(part, path, sha256(content));
    } catch (thrown) {
      rmSync(part, { force: true });
      throw thrown;
    }
  }

  /** Gives a complete file its place, which was checked. The entry comes first: whenever the process ends, the file is known. */
  put(part: string, path: string, hash: string): void {
    const place = join(this.#folder, path);
    const there = this.#statusOf(path);
    if (there && this.#own.get(keyOf(path)) !== markOf(there)) throw foreign(place);
    makeFolder(dirname(place));
    this.#append(path, hash);
    renameSync(part, place);
    this.#written.set(keyOf(path), hash);
    this.#own.set(keyOf(path), markOf(lstatSync(place, { bigint: true })));
  }

  /**
   * Checks the places of files, and returns what gives them to those of a folder, by their hashes and in their order. Files of an earlier
   * run that are old go. The second step has no pause, so that no signal is handled in between.
   */
  async replacing(paths: Iterable<string>, isOld: (path: string) => boolean): Promise<(part: string, hashes: ReadonlyMap<string, string>) => void> {
    const all = [...paths];
    await this.check(all);
    const old = await this.old(isOld, all);
    return (part, hashes) => {
      this.remove(old);
      for (const [path, hash] of hashes) this.put(join(part, path), path, hash);
      this.settle();
    };
  }

  /** Finds files of an earlier run that are neither changed nor written by this one nor among `kept`. */
  async old(isOld: (path: string) => boolean, kept: Iterable<string> = []): Promise<string[]> {
    const keys = new Set([...kept].map(keyOf));
    const found: string[] = [];
    for (const [key, { path }] of this.#entries) {
      if (!isOld(path) || keys.has(key) || this.#written.has(key) || this.#entries.get(key)?.hashes.has(ANY)) continue;
      const status = this.#lookAt(path);
      if (status?.isFile() && (await this.#isOwn(path, status))) found.push(path);
    }
    return found;
  }

  /** Deletes files that were checked, and folders that are empty then. */
  remove(paths: Iterable<string>): void {
    for (const path of paths) {
      const status = this.#lookAt(path);
      if (!status || this.#own.get(keyOf(path)) !== markOf(status)) continue;
      this.#begin();
      rmSync(join(this.#folder, path));
      const parts = path.split('/');
      try {
        while (parts.pop() && parts.length > 0) rmdirSync(join(this.#folder, ...parts));
      } catch {
        // It is not empty.
      }
    }
  }

  /** Writes the ledger without what is no longer true. Other processes may have added to it. */
  settle(): void {
    const entries = [...(read(this.#folder) ?? this.#entries)].flatMap(([key, entry]): [string, Entry][] => {
      if (!existsSync(join(this.#folder, entry.path))) return [];
      const hash = this.#written.get(key);
      return [[key, hash === undefined ? entry : { ...entry, hashes: new Set([hash]) }]];
    });
    this.#entries.clear();
    for (const [key, entry] of entries) this.#entries.set(key, entry);
    this.#save();
  }

  #append(path: string, hash: string): void {
    this.#begin();
    appendFileSync(join(this.#folder, NAME), line(path, hash));
    const entry = this.#entries.get(keyOf(path)) ?? { path, hashes: new Set() };
    this.#entries.set(keyOf(path), { path, hashes: entry.hashes.add(hash) });
  }

  /** From here on there is a ledger. */
  #begin(): void {
    if (lstatSync(join(this.#folder, NAME), { throwIfNoEntry: false })) return;
    makeFolder(this.#folder);
    this.#save();
  }

  #save(): void {
    const part = join(this.#folder, temporary('ledger'));
    writeFileSync(part, textOf(this.#entries));
    renameSync(part, join(this.#folder, NAME));
  }

  /** What is in the place of a file, if anything. Throws `write-failed` where a folder is, or where no file can be. */
  #statusOf(path: string): BigIntStats | undefined {
    const status = this.#lookAt(path);
    if (status?.isDirectory()) throw writeFailed(this.#folder, `'${join(this.#folder, path)}' is a folder`);
    return status;
  }

  #lookAt(path: string): BigIntStats | undefined {
    try {
      return lstatSync(join(this.#folder, path), { bigint: true, throwIfNoEntry: false });
    } catch (thrown) {
      throw writeFailed(this.#folder, thrown);
    }
  }

  async #isOwn(path: string, status: BigIntStats): Promise<boolean> {
    const hashes = this.#entries.get(keyOf(path))?.hashes;
    if (!hashes || !status.isFile()) return false;
    if (this.#own.get(keyOf(path)) === markOf(status)) return true;
    if (!hashes.has(await hashOf(join(this.#folder, path), status.size))) return false;
    this.#own.set(keyOf(path), markOf(status));
    return true;
  }
}

/** Begins the ledger of a folder whose files are there. */
export function enter(folder: string, hashes: ReadonlyMap<string, string>): void {
  writeFileSync(join(folder, NAME), textOf(entriesOf([...hashes])));
}

/** Whether a file has the content of this hash. */
export async function isUnchanged(path: string, hash: unknown): Promise<boolean> {
  const status = lstatSync(path, { bigint: true, throwIfNoEntry: false });
  return status?.isFile() === true && (await hashOf(path, status.size)) === hash;
}

/** Between two files a signal is heeded. */
async function hashOf(path: string, size: bigint): Promise<string> {
  await setImmediate();
  if (size <= SMALL) return sha256(readFileSync(path));
  const hash = createHash('sha256');
  for await (const chunk of createReadStream(path)) hash.update(chunk as Uint8Array);
  return hash.digest('hex');
}

function read(folder: string): Map<string, Entry> | undefined {
  const place = join(folder, NAME);
  if (!lstatSync(place, { throwIfNoEntry: false })) return undefined;
  const text = readWritten(place)?.toString();
  if (!text?.startsWith(HEADER)) throw taken(place, 'is no list of files of this program');
  // An end without its line break was cut off: the file did not come.
  return entriesOf(text.split('\n').slice(0, -1).flatMap((line) => {
    const [, hash, path] = ENTRY.exec(line) ?? [];
    return hash !== undefined && path !== undefined && isBelow(path) ? [[path, hash] as const] : [];
  }));
}

/** What a complete record of version 0.1.0, which had no ledger, says that its command wrote. */
async function earlier(folder: string): Promise<Map<string, Entry>> {
  const found: [path: string, hash: string][] = [];
  for (const [name, files] of [[RESULT, hashesOfPair], [TRACKS, hashesOfClip]] as const) {
    try {
      const text = readWritten(join(folder, name));
      if (!text) continue;
      const hashes = files(JSON.parse(text.toString()));
      for (const [path, hash] of Object.entries(hashes)) {
        const known = hash ?? (await contentHash(join(folder, path)));
        if (known !== undefined && isBelow(path)) found.push([path, known]);
      }
      found.push([name, sha256(text)]);
    } catch {
      // It is no such record.
    }
  }
  return entriesOf(found);
}

async function contentHash(place: string): Promise<string | undefined> {
  const status = lstatSync(place, { bigint: true, throwIfNoEntry: false });
  return status?.isFile() ? hashOf(place, status.size) : undefined;
}

/** By path the hash, where the record has it. Throws unless the value is that of a complete result.json. */
function hashesOfPair(value: unknown): { [path: string]: string | undefined } {
  const { motions } = resultOf(value, RESULT);
  const { settings, files } = value as { settings?: { software?: unknown }; files?: unknown };
  if (!String(settings?.software).startsWith('veronese ')) throw new Error('it is of another program');
  if (isObject(files)) return files as { [path: string]: string };
  const numbers = motions.flatMap(({ label, group }) => [label, group]);
  return Object.fromEntries(filesOfPair(numbers, { overlay: true, confidence: true }).map((name) => [name, undefined]));
}

/** As {@link hashesOfPair}, of tracks.json. */
function hashesOfClip(value: unknown): { [path: string]: string } {
  tracksOf(value, TRACKS);
  const { settings, images, job } = value as { settings?: { software?: unknown }; images?: unknown; job?: unknown };
  if (!String(settings?.software).startsWith('veronese ') || typeof job !== 'string' || !isObject(images)) throw new Error('it is of another program');
  return { ...(images as { [path: string]: string }), [HIDDEN]: ANY };
}

function entriesOf(list: readonly (readonly [path: string, hash: string])[]): Map<string, Entry> {
  const entries = new Map<string, Entry>();
  for (const [path, hash] of list) {
    const entry = entries.get(keyOf(path)) ?? { path, hashes: new Set() };
    entries.set(keyOf(path), { path, hashes: entry.hashes.add(hash) });
  }
  return entries;
}

/** Whether a path leads to something in the folder. */
function isBelow(path: string): boolean {
  return path.split('/').every((part) => !/^\.{0,2}$|\\/.test(part));
}

function textOf(entries: ReadonlyMap<string, Entry>): string {
  const sorted = [...entries.values()].sort((one, other) => (one.path < other.path ? -1 : Number(one.path > other.path)));
  return HEADER + sorted.flatMap(({ path, hashes }) => [...hashes].sort().map((hash) => line(path, hash))).join('');
}

function line(path: string, hash: string): string {
  return `${hash}  ${path}\n`;
}

/** What files are recognised by, whatever path leads to them. */
export function idsOf(paths: readonly string[]): Set<string> {
  return new Set(paths.flatMap((path) => {
    try {
      return idOf(statSync(path, { bigint: true }));
    } catch {
      return []; // Whoever reads it says what is wrong.
    }
  }));
}

function idOf({ dev, ino }: BigIntStats): string {
  return `${dev}:${ino}`;
}

function markOf({ ino, size, mtimeNs, ctimeNs }: BigIntStats): string {
  return [ino, size, mtimeNs, ctimeNs].join(' ');
}

function foreign(place: string): VeroneseError {
  return taken(place, 'is not of this program, or was changed since, and is not overwritten');
}

function taken(place: string, reason: string): VeroneseError {
  return new VeroneseError('file-exists', `'${place}' ${reason}: move it, delete it, or choose another folder with '--out'`);
}
