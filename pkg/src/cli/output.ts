// An output folder: files are written in a folder of their own in it and take their places when they are complete. Nothing is replaced or
// deleted that is not ours by the manifest, unless that is asked for.

import { createHash, type Hash } from 'node:crypto';
import { readdirSync, renameSync, rmdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { setImmediate } from 'node:timers/promises';
import { keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { checkFolder, lookAt, makeFolder, type OutputFile, sha256, taken, writeFailed, writing } from './files.js';
import { HOST, Manifest, RUN } from './manifest.js';

/** The content of a file, at once or piece by piece. */
export type Content = Uint8Array | string | AsyncIterable<string>;

/** Writes a file. Folders in its path, which is divided by `/`, are made. */
export type Write = (path: string, content: Content) => Promise<void>;

/** The folder of a run for what is not complete. */
const PART = `${RUN}.part`;
const PARTS = /^\.veronese-([0-9a-f]{8})-(\d+)\.(?:part|list)$/;
/** Age from which files of another machine were left behind, milliseconds. */
const LEFT = 86_400_000;

export class Output {
  readonly folder: string;
  readonly manifest: Manifest;
  readonly #force: boolean;

  /** `force`: files of others may be replaced. Throws `file-exists`, or `write-failed` where the folder cannot be one, as all methods do. */
  constructor(folder: string, { force, signal }: { force: boolean; signal?: AbortSignal }) {
    checkFolder(folder);
    this.folder = folder;
    this.manifest = new Manifest(folder, force);
    this.#force = force;
    signal?.addEventListener('abort', () => this.discard());
  }

  /** Throws unless each of the places may be taken: by nothing, or by a file of our own that is not among the `inputs` ({@link idsOf}). */
  async check(paths: Iterable<string>, inputs?: ReadonlySet<string>): Promise<void> {
    for (const path of paths) {
      // Between two files a signal is heeded.
      if (this.#isFree(path, inputs)) continue;
      await setImmediate();
      this.#checkOwn(path);
    }
  }

  /** As {@link check}, of files with these names in a folder below that {@link Manifest.ownsFolder | is ours} or not. */
  checkFolder(path: string, names: RegExp): void {
    const place = join(this.folder, path);
    if (this.#force || this.manifest.ownsFolder(path) || !lookAt(place)?.isDirectory()) return;
    const name = readdirSync(place).find((name) => names.test(name));
    if (name !== undefined) throw foreign(join(place, name));
  }

  /** Writes a file of our own, at once: no signal comes in between. */
  write(path: string, content: Uint8Array | string): void {
    if (!this.#isFree(path)) this.#checkOwn(path);
    this.manifest.add(new Map([[path, sha256(content)]]));
    this.keep(path, content);
  }

  /** As {@link write}, in a folder that is our own. */
  keep(path: string, content: Uint8Array | string): void {
    const [part, place] = [join(this.begin(), 'file'), join(this.folder, path)];
    writeFileSync(part, content);
    makeFolder(dirname(place));
    renameSync(part, place);
  }

  /** As {@link stage}; the last file is the last to take its place. */
  async writeAll(files: readonly OutputFile[], isOld: (path: string) => boolean = () => false): Promise<void> {
    await this.stage(async (write) => {
      for (const { name, bytes } of files) await write(name, bytes);
    }, isOld);
  }

  /**
   * Writes what `work` writes: all of it, and nothing before that is done. Files of an earlier run go if `isOld` is true of them, otherwise those
   * in folders that are written. Returns names, those of folders with a `/`. Rejects with what `work` rejects with, leaving nothing
   * half-written.
   */
  async stage(work: (write: Write) => Promise<void>, isOld?: (path: string) => boolean): Promise<string[]> {
    const hashes = new Map<string, string>();
    const known = new Map<string, string>();
    const tops = new Set<string>();
    this.removeLeftovers();
    try {
      await work((path, content) =>
        writing(this.folder, async () => {
          const other = known.get(keyOf(path));
          if (other !== undefined) throw new VeroneseError('invalid-input', `'${other}' and '${path}' would be one file`);
          known.set(keyOf(path), path);
          await this.check([path]);
          const place = join(this.begin(), path);
          makeFolder(dirname(place));
          const hash = createHash('sha256');
          await writeFile(place, hashed(content, hash));
          hashes.set(path, hash.digest('hex'));
          tops.add(topOf(path));
        }),
      );
      await writing(this.folder, () => this.place(this.begin(), hashes, isOld ?? ((path) => tops.has(topOf(path)))));
      return [...tops];
    } finally {
      this.discard();
    }
  }

  /** Moves files, whose hashes are given, from another folder to their places, in one turn: a signal comes before or after. */
  place(part: string, hashes: ReadonlyMap<string, string>, isOld: (path: string) => boolean): void {
    for (const path of hashes.keys()) if (!this.#isFree(path)) this.#checkOwn(path);
    this.removeOld(isOld, hashes.keys());
    this.manifest.add(hashes);
    for (const path of hashes.keys()) {
      makeFolder(dirname(join(this.folder, path)));
      renameSync(join(part, path), join(this.folder, path));
    }
    this.manifest.settle();
  }

  /** Deletes files of an earlier run that are neither changed since nor among `kept`, and folders that are empty then. */
  removeOld(isOld: (path: string) => boolean, kept: Iterable<string> = []): void {
    const keys = new Set([...kept].map(keyOf));
    for (const path of this.manifest.paths) {
      if (!isOld(path) || keys.has(keyOf(path)) || !this.manifest.owns(path)) continue;
      rmSync(join(this.folder, path));
      const parts = path.split('/');
      while (parts.pop() && parts.length > 0) removeIfEmpty(join(this.folder, ...parts));
    }
  }

  /** The folder of what is not complete. */
  begin(): string {
    const part = join(this.folder, PART);
    makeFolder(part);
    return part;
  }

  /** Removes what is half-written. */
  discard(): void {
    // A file that is still being written can come into the folder while it is emptied.
    rmSync(join(this.folder, PART), { recursive: true, force: true, maxRetries: 10 });
  }

  /** Removes what runs that were killed left behind, nothing of one that may still go on. */
  removeLeftovers(): void {
    for (const name of lookAt(this.folder) ? readdirSync(this.folder) : []) {
      const [, host, pid] = PARTS.exec(name) ?? [];
      if (host === undefined || (host === HOST && Number(pid) !== process.pid && isAlive(Number(pid)))) continue;
      const path = join(this.folder, name);
      if (host === HOST || Date.now() - (lookAt(path)?.mtimeMs ?? 0) > LEFT) rmSync(path, { recursive: true, force: true });
    }
  }

  #isFree(path: string, inputs?: ReadonlySet<string>): boolean {
    const place = join(this.folder, path);
    const status = lookAt(place);
    if (status?.isDirectory()) throw writeFailed(this.folder, `'${place}' is a folder`);
    const id = status && inputs && idOf(place);
    if (id !== undefined && inputs?.has(id)) throw taken(place, 'is an input, and would be overwritten');
    return !status || this.#force;
  }

  #checkOwn(path: string): void {
    if (!this.manifest.owns(path)) throw foreign(join(this.folder, path));
  }
}

export function removeIfEmpty(folder: string): void {
  try {
    rmdirSync(folder);
  } catch {
    // It is not empty, or does not exist.
  }
}

/** The file or folder that it is in. */
function topOf(path: string): string {
  return path.includes('/') ? path.slice(0, path.indexOf('/') + 1) : path;
}

function isAlive(pid: number): boolean {
  try {
    process.kill(pid, 0);
    return true;
  } catch (thrown) {
    return (thrown as NodeJS.ErrnoException).code === 'EPERM';
  }
}

/** The identity of a file, whatever path leads to it. */
export function idsOf(paths: readonly string[]): Set<string> {
  return new Set(paths.map(idOf).filter((id) => id !== undefined));
}

/** Undefined where nothing can be found: reading it gives the error. */
function idOf(path: string): string | undefined {
  try {
    const { dev, ino } = statSync(path, { bigint: true });
    return `${dev}:${ino}`;
  } catch {
    return undefined;
  }
}

function foreign(place: string): VeroneseError {
  return taken(place, "is not of this program, or was changed since, and is replaced only with '--force'");
}

/** The content as it is, while its hash is found. */
function hashed(content: Content, hash: Hash): Content {
  if (typeof content === 'string' || content instanceof Uint8Array) {
    hash.update(content);
    return content;
  }
  return (async function* pieces() {
    for await (const piece of content) {
      hash.update(piece);
      yield piece;
    }
  })();
}
