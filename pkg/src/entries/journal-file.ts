// Node: a journal in a file. What is appended is on the disk when the call ends; what replaces it is written beside it and renamed. A file beside
// it, with the number of the process, makes sure that one clip alone writes to it.

import { closeSync, openSync, readFileSync, unlinkSync, writeSync } from 'node:fs';
import { type FileHandle, open, readFile, rename, writeFile } from 'node:fs/promises';
import { resolve } from 'node:path';
import type { ClipJournal } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';

/** The locks of this process. */
const held = new Set<string>();

export async function openFile(name: string): Promise<ClipJournal> {
  // The process may go to another folder.
  const path = resolve(name);
  lock(name, `${path}.lock`);
  try {
    // Made where it is not there yet, so that a folder that is not there is an error now.
    return new FileJournal(path, await open(path, 'a+'));
  } catch (thrown) {
    unlock(`${path}.lock`);
    throw failed(path, thrown);
  }
}

class FileJournal implements ClipJournal {
  readonly #path: string;
  #file: FileHandle;
  /** Number of bytes that are written completely. */
  #length: number | undefined;

  constructor(path: string, file: FileHandle) {
    this.#path = path;
    this.#file = file;
  }

  async read(): Promise<Uint8Array | undefined> {
    const content = new Uint8Array(await this.#done(readFile(this.#path)));
    this.#length = content.length;
    return content.length > 0 ? content : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    const length = (this.#length ??= (await this.#done(this.#file.stat())).size);
    try {
      await this.#file.appendFile(records);
      await this.#file.datasync();
      this.#length = length + records.length;
    } catch (thrown) {
      // A part may have been written.
      await this.#file.truncate(length).catch(() => undefined);
      throw failed(this.#path, thrown);
    }
  }

  async replace(saved: Uint8Array): Promise<void> {
    const beside = `${this.#path}.new`;
    await this.#done(writeFile(beside, saved, { flush: true }));
    await this.#done(rename(beside, this.#path));
    const before = this.#file;
    this.#file = await this.#done(open(this.#path, 'a+'));
    this.#length = saved.length;
    await before.close();
  }

  async keepDamaged(content: Uint8Array): Promise<void> {
    await this.#done(writeFile(`${this.#path}.damaged`, content, { flush: true }));
  }

  async close(): Promise<void> {
    unlock(`${this.#path}.lock`);
    await this.#file.close();
  }

  async #done<T>(work: Promise<T>): Promise<T> {
    try {
      return await work;
    } catch (thrown) {
      throw failed(this.#path, thrown);
    }
  }
}

/** Makes the file of a lock. One that a process has left that is no more is taken over. */
function lock(name: string, path: string): void {
  for (let attempt = 0; ; attempt++) {
    try {
      const file = openSync(path, 'wx');
      writeSync(file, String(process.pid));
      closeSync(file);
      held.add(path);
      return;
    } catch (thrown) {
      const isThere = (thrown as NodeJS.ErrnoException).code === 'EEXIST';
      if (!isThere) throw failed(name, thrown);
      if (attempt > 0 || isHeld(path)) throw new VeroneseError('invalid-option', `option 'journal': another clip has '${name}' open: close it first`);
      unlock(path);
    }
  }
}

function isHeld(path: string): boolean {
  try {
    const owner = Number(readFileSync(path, 'utf8'));
    if (owner === process.pid) return held.has(path);
    process.kill(owner, 0);
    return true;
  } catch (thrown) {
    // A process of somebody else is there.
    return (thrown as NodeJS.ErrnoException).code === 'EPERM';
  }
}

function unlock(path: string): void {
  held.delete(path);
  try {
    unlinkSync(path);
  } catch {
    // Somebody has removed it.
  }
}

function failed(path: string, cause: unknown): VeroneseError {
  const { code, message } = cause as NodeJS.ErrnoException;
  if (cause instanceof VeroneseError) return cause;
  if (code === 'ENOENT') return new VeroneseError('file-not-found', `there is no folder for the journal '${path}'`);
  return new VeroneseError('write-failed', `the journal '${path}' cannot be written: ${message}`, { cause });
}
