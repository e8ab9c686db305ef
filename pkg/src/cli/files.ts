// Files of the command line: read with a limit, written whole or not at all.

import { mkdirSync, readdirSync, renameSync, rmSync, statSync } from 'node:fs';
import { mkdir, readFile, stat, writeFile } from 'node:fs/promises';
import { dirname, extname, join } from 'node:path';
import { VeroneseError } from '../common/errors.js';

/** Largest input, bytes: more than the largest frame needs in the most wasteful of the formats. */
const LARGEST = 512 * 1024 * 1024;

/**
 * Throws `file-not-found` or `unreadable-file`. Only whole files are read: a read that waits for a pipe would keep the
 * process from ending when it is told to.
 */
export async function readInput(path: string): Promise<Uint8Array> {
  try {
    const status = await stat(path);
    if (status.isDirectory()) throw new VeroneseError('unreadable-file', `'${path}' is a folder`);
    if (!status.isFile()) throw new VeroneseError('unreadable-file', `'${path}' is a pipe or a device, not a file`);
    if (status.size > LARGEST) throw tooLarge(path);
    return new Uint8Array(await readFile(path));
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw thrown;
    const { code, message } = thrown as NodeJS.ErrnoException;
    if (code === 'ENOENT' || code === 'ENOTDIR') throw new VeroneseError('file-not-found', `there is no file '${path}'`);
    throw new VeroneseError('unreadable-file', `'${path}' cannot be read: ${message}`);
  }
}

function tooLarge(path: string): VeroneseError {
  return new VeroneseError('unreadable-file', `'${path}' is larger than ${LARGEST / 1024 / 1024} MB`);
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

export function writeFailed(folder: string, reason: string): VeroneseError {
  return new VeroneseError('write-failed', `the results cannot be written into '${folder}': ${reason}`);
}

export interface OutputFile {
  name: string;
  bytes: Uint8Array;
}

/** What goes into a file, at once or piece by piece. */
export type Content = Uint8Array | string | AsyncIterable<string>;

/** Writes a file. Folders in its path, which is divided by `/`, are made. */
export type Write = (path: string, content: Content) => Promise<void>;

/** What this program writes; files of an earlier run that this one did not make would be mistaken for its own. */
export const OURS = /^(mask-\d+|overlay|confidence)\.png$/;

/** A set of files that appears as a whole: all are written under temporary names, then renamed in one go. */
export class Output {
  readonly #temporary = new Set<string>();

  /**
   * Throws `write-failed`, leaving nothing behind but the folder. The last file is renamed last. `beside`: what an earlier run
   * made stays.
   */
  async write(folder: string, files: readonly OutputFile[], { beside = false } = {}): Promise<void> {
    try {
      await mkdir(folder, { recursive: true });
      const moves: { from: string; to: string }[] = [];
      for (const { name, bytes } of files) {
        const move = { from: join(folder, `.${name}.${process.pid}.part`), to: join(folder, name) };
        if (statSync(move.to, { throwIfNoEntry: false })?.isDirectory()) throw new Error(`'${move.to}' is a folder`);
        this.#temporary.add(move.from);
        await writeFile(move.from, bytes);
        moves.push(move);
      }
      if (!beside) this.#clear(folder, new Set(files.map(({ name }) => name)));
      this.#rename(moves);
    } catch (thrown) {
      const reason = thrown instanceof Error ? thrown.message : String(thrown);
      throw writeFailed(folder, reason);
    } finally {
      this.discard();
    }
  }

  /**
   * Files and folders of files, as many as `work` writes: they are in a folder of their own until it is done, then all take their
   * places. A folder that is there is replaced if it has nothing but what an earlier run can have written. Returns their names, those
   * of folders with a `/`. Rejects with what `work` rejects with, or with `write-failed`, leaving nothing behind.
   */
  async stage(folder: string, work: (write: Write) => Promise<void>): Promise<string[]> {
    const part = join(folder, `.convert.${process.pid}.part`);
    this.#temporary.add(part);
    const names = new Set<string>();
    const tried = async <T>(action: () => T | Promise<T>): Promise<T> => {
      try {
        return await action();
      } catch (thrown) {
        if (thrown instanceof VeroneseError) throw thrown;
        throw writeFailed(folder, thrown instanceof Error ? thrown.message : String(thrown));
      }
    };
    try {
      await tried(() => mkdir(part, { recursive: true }));
      await work((path, content) =>
        tried(async () => {
          const place = join(part, ...path.split('/'));
          names.add(path.split('/')[0] as string);
          await mkdir(dirname(place), { recursive: true });
          await writeFile(place, content);
        }),
      );
      return await tried(() => this.#publish(part, folder, [...names]));
    } finally {
      this.discard();
    }
  }

  // The rest without a pause, so that no signal is handled in between.

  #publish(part: string, folder: string, names: readonly string[]): string[] {
    const isFolder = (place: string) => statSync(place, { throwIfNoEntry: false })?.isDirectory() === true;
    for (const name of names) checkReplaceable(join(folder, name), join(part, name));
    const old = join(part, '.old');
    mkdirSync(old);
    for (const name of names) {
      if (isFolder(join(folder, name))) renameSync(join(folder, name), join(old, name));
      renameSync(join(part, name), join(folder, name));
    }
    return names.map((name) => (isFolder(join(folder, name)) ? `${name}/` : name));
  }

  #clear(folder: string, names: ReadonlySet<string>): void {
    for (const name of readdirSync(folder)) if (OURS.test(name) && !names.has(name)) rmSync(join(folder, name));
  }

  #rename(moves: readonly { from: string; to: string }[]): void {
    for (const { from, to } of moves) {
      renameSync(from, to);
      this.#temporary.delete(from);
    }
  }

  /** Removes what is half-written. */
  discard(): void {
    for (const path of this.#temporary) rmSync(path, { recursive: true, force: true });
    this.#temporary.clear();
  }
}

/** Throws unless what is at `place`, if anything, may give way to a new file or folder. */
function checkReplaceable(place: string, replacement: string): void {
  const there = statSync(place, { throwIfNoEntry: false });
  if (!there) return;
  const isFolder = statSync(replacement).isDirectory();
  if (there.isDirectory() !== isFolder) throw new Error(`'${place}' is ${isFolder ? 'no' : 'a'} folder`);
  if (!isFolder) return;
  const kinds = new Set(filesBelow(replacement).map((name) => extname(name)));
  const foreign = filesBelow(place).find((name) => !kinds.has(extname(name)));
  if (foreign !== undefined) throw new Error(`'${join(place, foreign)}' is not of an earlier conversion`);
}

function filesBelow(folder: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? filesBelow(join(folder, entry.name)).map((name) => join(entry.name, name)) : [entry.name],
  );
}
