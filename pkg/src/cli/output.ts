// An output folder. Its list, `.veronese`, names the files that this program wrote there. Those are replaced and deleted by later runs; other
// files never are, unless that is asked for. New files are written into a folder of their own, and take their places when they are complete.

import { appendFileSync, readdirSync, renameSync, rmdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import { hostname } from 'node:os';
import { dirname, join } from 'node:path';
import { keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { checkFolder, lookAt, makeFolder, type OutputFile, readWritten, sha256, taken, writing } from './files.js';
import { isFileName } from './sequence.js';

/** The content of a file, at once or piece by piece. */
export type Content = Uint8Array | string | AsyncIterable<string>;

/** Writes a file. Folders in its path, which is divided by `/`, are made. */
export type Write = (path: string, content: Content) => Promise<void>;

const LIST = '.veronese';
const HEADER = '# Files that veronese wrote here. It replaces and deletes no others.';
/** A mark of this machine, so that two of them may write into one shared folder. */
const HOST = sha256(hostname()).slice(0, 8);
/** The name of this run for what is not complete. */
const RUN = `${LIST}-${HOST}-${process.pid}`;
const PART = `${RUN}.part`;
const PARTS = new RegExp(`^${LIST}-${HOST}-(\\d+)\\.(?:part|file)$`);

export class Output {
  readonly folder: string;
  readonly #force: boolean;
  readonly #isInput: boolean;
  /** Listed paths by their keys. */
  readonly #listed = new Map<string, string>();
  #hasList: boolean;

  /**
   * `force`: files of others may be replaced. `isInput`: the folder is also what is read, whoever wrote it. Throws `write-failed` where the
   * folder cannot be one, as all methods do.
   */
  constructor(folder: string, { force, isInput = false, signal }: { force: boolean; isInput?: boolean; signal?: AbortSignal }) {
    checkFolder(folder);
    this.folder = folder;
    this.#force = force;
    this.#isInput = isInput;
    this.#hasList = this.#readList();
    signal?.addEventListener('abort', () => this.discard());
  }

  /**
   * Throws `file-exists` where one of these places has a file that is not listed, or that is among the `inputs`, and where the folder has
   * files and no list.
   */
  check(paths: Iterable<string>, inputs: readonly string[] = []): void {
    const read = new Set(inputs.flatMap(idOf));
    for (const path of paths) {
      const place = join(this.folder, path);
      if (read.size > 0 && idOf(place).some((id) => read.has(id))) throw taken(place, 'is an input, and would be overwritten');
      this.#checkFree(path);
    }
    if (this.#hasList || this.#force || !lookAt(this.folder)) return;
    // Hidden files, such as those of file managers, are no content.
    const isContent = (name: string) => name === LIST || !(this.#isInput || /^\.|^Thumbs\.db$/.test(name));
    const other = readdirSync(this.folder).sort().find(isContent);
    if (other !== undefined) throw foreign(join(this.folder, other));
  }

  /** Lists paths. This comes before files take their places: whenever the process ends, what is there is known. */
  add(paths: readonly string[]): void {
    const fresh = paths.filter((path) => this.#listed.get(keyOf(path)) !== path);
    if (this.#hasList && fresh.length === 0) return;
    for (const path of fresh) this.#listed.set(keyOf(path), path);
    if (this.#hasList) appendFileSync(join(this.folder, LIST), fresh.map((path) => `\n${path}\n`).join(''));
    else this.#move(LIST, [HEADER, ...fresh, ''].join('\n'));
    this.#hasList = true;
  }

  /** Lists what is there, sorted. Other processes may have added to it. */
  settle(): void {
    this.#readList();
    const there = [...this.#listed.values()].filter((path) => lookAt(join(this.folder, path)));
    this.#move(LIST, [HEADER, ...there.sort(), ''].join('\n'));
  }

  /** Writes a file at once: no signal comes in between. `listed`: a folder that is listed as a whole, with the file in it. */
  write(path: string, content: Uint8Array | string, listed = path): void {
    this.#checkFree(listed);
    this.add([listed]);
    this.#move(path, content);
  }

  /** As {@link stage}; the last file is the last to take its place. */
  async writeAll(files: readonly OutputFile[], isOld?: (path: string) => boolean): Promise<void> {
    await this.stage(async (write) => {
      for (const { name, bytes } of files) await write(name, bytes);
    }, isOld);
  }

  /**
   * Writes what `work` writes: all of it, and nothing before that is done. Listed files of an earlier run go if `isOld` is true of them;
   * without `isOld`, those in folders that are written. Returns names, those of folders with a `/`. Rejects with what `work` rejects with,
   * leaving nothing half-written.
   */
  async stage(work: (write: Write) => Promise<void>, isOld?: (path: string) => boolean): Promise<string[]> {
    const paths = new Map<string, string>();
    this.check([]);
    this.removeLeftovers();
    try {
      await work((path, content) =>
        writing(this.folder, async () => {
          const other = paths.get(keyOf(path));
          if (other !== undefined) throw new VeroneseError('invalid-input', `'${other}' and '${path}' would be one file`);
          paths.set(keyOf(path), path);
          this.#checkFree(path);
          const place = join(this.begin(), path);
          makeFolder(dirname(place));
          await writeFile(place, content);
        }),
      );
      const tops = new Set([...paths.values()].map(topOf));
      await writing(this.folder, () => this.place(this.begin(), [...paths.values()], isOld ?? ((path) => tops.has(topOf(path)))));
      return [...tops];
    } finally {
      this.discard();
    }
  }

  /** Moves files from another folder to their places, in one turn: a signal comes before or after. */
  place(part: string, paths: readonly string[], isOld: (path: string) => boolean): void {
    for (const path of paths) this.#checkFree(path);
    this.removeOld(isOld, paths);
    this.add(paths);
    for (const path of paths) {
      makeFolder(dirname(join(this.folder, path)));
      renameSync(join(part, path), join(this.folder, path));
    }
    this.settle();
  }

  /** Deletes listed files that are not among `kept`, and folders that are empty then. */
  removeOld(isOld: (path: string) => boolean, kept: Iterable<string> = []): void {
    const keys = new Set([...kept].map(keyOf));
    for (const path of this.#listed.values()) {
      if (!isOld(path) || keys.has(keyOf(path)) || !lookAt(join(this.folder, path))) continue;
      rmSync(join(this.folder, path));
      for (let folder = dirname(path); folder !== '.'; folder = dirname(folder)) removeIfEmpty(join(this.folder, folder));
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

  /** Removes what runs on this machine left behind when they were killed. */
  removeLeftovers(): void {
    for (const name of lookAt(this.folder) ? readdirSync(this.folder) : []) {
      const [, pid] = PARTS.exec(name) ?? [];
      if (pid !== undefined && !isAlive(Number(pid))) rmSync(join(this.folder, name), { recursive: true, force: true });
    }
  }

  #checkFree(path: string): void {
    const place = join(this.folder, path);
    if (!this.#force && !this.#listed.has(keyOf(path)) && lookAt(place)) throw foreign(place);
  }

  #move(path: string, content: Uint8Array | string): void {
    const [part, place] = [join(this.folder, `${RUN}.file`), join(this.folder, path)];
    makeFolder(dirname(place));
    writeFileSync(part, content);
    renameSync(part, place);
  }

  /** Reads the list; false where there is none, or something else in its place. */
  #readList(): boolean {
    const [header, ...paths] = readWritten(join(this.folder, LIST))?.split('\n') ?? [];
    if (header !== HEADER) return false;
    // A path may not lead out of the folder.
    for (const path of paths) if (path.split('/').every(isFileName)) this.#listed.set(keyOf(path), path);
    return true;
  }
}

export function removeIfEmpty(folder: string): void {
  try {
    rmdirSync(folder);
  } catch {
    // It is not empty, or does not exist.
  }
}

/** The file, or the folder that it is in, with a `/`. */
const topOf = (path: string): string => path.replace(/\/.*/s, '/');

function isAlive(pid: number): boolean {
  try {
    return process.kill(pid, 0);
  } catch (thrown) {
    return (thrown as NodeJS.ErrnoException).code === 'EPERM';
  }
}

/** The identity of a file, whatever path leads to it. None where nothing can be found: reading it gives the error. */
function idOf(path: string): string[] {
  try {
    const { dev, ino } = statSync(path, { bigint: true });
    return [`${dev}:${ino}`];
  } catch {
    return [];
  }
}

function foreign(place: string): VeroneseError {
  return taken(place, "was not written by veronese, which writes here only with '--force'");
}
