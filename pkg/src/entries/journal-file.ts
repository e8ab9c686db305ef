// Node: a journal in a file. What is appended is on the disk when the call ends; what replaces it is written beside it and renamed. A file beside
// it, with the process and machine that has it open, makes sure that one clip alone writes to it.

import { closeSync, openSync, readFileSync, realpathSync, renameSync, statSync, unlinkSync, writeSync } from 'node:fs';
import { type FileHandle, open, readFile, rename, writeFile } from 'node:fs/promises';
import { hostname } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import type { ClipJournal } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';

/** Beside the journal. */
export const LOCK = '.veronese-lock';

export async function openFile(name: string): Promise<ClipJournal> {
  let path: string;
  try {
    path = placeOf(name);
  } catch (thrown) {
    throw failed(name, thrown);
  }
  lock(name, `${path}${LOCK}`);
  const journal = new FileJournal(path);
  try {
    await journal.open();
    return journal;
  } catch (thrown) {
    await journal.close();
    throw thrown;
  }
}

/** The one spelling of a path. The file itself need not be there. */
function placeOf(name: string): string {
  const path = resolve(name);
  try {
    return realpathSync(path);
  } catch {
    return join(realpathSync(dirname(path)), basename(path));
  }
}

class FileJournal implements ClipJournal {
  readonly #path: string;
  #file: FileHandle | undefined;
  /** Number of bytes that are written completely. */
  #length = 0;
  /** Whether more than these may have been written. */
  #isTorn = false;

  constructor(path: string) {
    this.#path = path;
  }

  /** Makes the file if it is not there. */
  async open(): Promise<void> {
    await this.#try(async () => {
      const file = await this.#opened();
      this.#length = (await file.stat()).size;
      await syncFolder(this.#path);
    });
  }

  async read(): Promise<Uint8Array | undefined> {
    const content = await this.#try(() => readFile(this.#path));
    return content.length > 0 ? new Uint8Array(content) : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    await this.#try(async () => {
      const file = await this.#opened();
      if (this.#isTorn) await file.truncate(this.#length);
      this.#isTorn = true;
      await file.appendFile(records);
      await file.datasync();
      this.#isTorn = false;
      this.#length += records.length;
    });
  }

  async replace(saved: Uint8Array): Promise<void> {
    const beside = `${this.#path}.new`;
    await this.#try(async () => {
      await writeFile(beside, saved, { flush: true });
      // Some systems rename nothing over a file that is open.
      await this.#file?.close();
      this.#file = undefined;
      await rename(beside, this.#path);
      await syncFolder(this.#path);
      [this.#length, this.#isTorn] = [saved.length, false];
    });
  }

  async keepDamaged(content: Uint8Array): Promise<void> {
    await this.#try(() => writeFile(`${this.#path}.damaged`, content, { flush: true }));
  }

  async close(): Promise<void> {
    unlock(`${this.#path}${LOCK}`);
    await this.#file?.close();
    this.#file = undefined;
  }

  async #opened(): Promise<FileHandle> {
    return (this.#file ??= await open(this.#path, 'a+'));
  }

  async #try<T>(work: () => Promise<T>): Promise<T> {
    try {
      return await work();
    } catch (thrown) {
      throw failed(this.#path, thrown);
    }
  }
}

/** Waits until the names in the folder of a file are on the disk, where a system can. */
async function syncFolder(path: string): Promise<void> {
  try {
    const folder = await open(dirname(path));
    await folder.sync().finally(() => folder.close());
  } catch {
    // Not on Windows.
  }
}

/** Makes the file of a lock. One that a process has left that is no more is taken over. */
function lock(name: string, path: string): void {
  for (let attempt = 0; ; attempt++) {
    try {
      const file = openSync(path, 'wx');
      try {
        writeSync(file, `${process.pid} ${hostname()}\n`);
      } catch (thrown) {
        unlock(path);
        throw thrown;
      } finally {
        closeSync(file);
      }
      return;
    } catch (thrown) {
      const { code } = thrown as NodeJS.ErrnoException;
      if (code !== 'EEXIST') throw failed(name, thrown);
      if (attempt === 2 || !takenOver(path)) {
        throw new VeroneseError(
          'invalid-option',
          `option 'journal': another clip has '${name}' open: close it first; if there is none, delete '${path}'`,
        );
      }
    }
  }
}

/** Removes a lock whose owner is no more. */
function takenOver(path: string): boolean {
  try {
    if (isHeld(path)) return false;
    // Renamed first: somebody else may do the same, and has a new lock by now.
    const own = `${path}.${process.pid}`;
    renameSync(path, own);
    const isStale = !isHeld(own);
    if (isStale) unlinkSync(own);
    else renameSync(own, path);
    return isStale;
  } catch {
    // It is gone already.
    return true;
  }
}

function isHeld(path: string): boolean {
  const [, owner, host] = readFileSync(path, 'utf8').match(/^(\d+) (.*)\n$/) ?? [];
  // Not one of ours, not written yet, or of another machine.
  if (owner === undefined || host !== hostname()) return true;
  // A process that had the same number ended before this one began.
  if (Number(owner) === process.pid) return statSync(path).mtimeMs > Date.now() - 1000 * process.uptime();
  try {
    process.kill(Number(owner), 0);
    return true;
  } catch (thrown) {
    // A process of somebody else is there.
    return (thrown as NodeJS.ErrnoException).code === 'EPERM';
  }
}

function unlock(path: string): void {
  try {
    unlinkSync(path);
  } catch {
    // Somebody has removed it.
  }
}

function failed(path: string, cause: unknown): VeroneseError {
  const { code, message } = cause as NodeJS.ErrnoException;
  if (cause instanceof VeroneseError) return cause;
  if (code === 'ENOENT') return new VeroneseError('file-not-found', `the journal '${path}' or its folder is not there`);
  return new VeroneseError('write-failed', `the journal '${path}' cannot be kept: ${message}`, { cause });
}
