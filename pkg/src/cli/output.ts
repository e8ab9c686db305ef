// Files that appear as a set: all are written in a folder of their own, then take their places.

import { createHash, type Hash } from 'node:crypto';
import { rmSync } from 'node:fs';
import { writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { keyOf } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { makeFolder, type OutputFile, writing } from './files.js';
import { Ledger, temporary } from './ledger.js';

/** What goes into a file, at once or piece by piece. */
export type Content = Uint8Array | string | AsyncIterable<string>;

/** Writes a file. Folders in its path, which is divided by `/`, are made. */
export type Write = (path: string, content: Content) => Promise<void>;

export class Output {
  #part: string | undefined;

  /** As {@link stage}; the last file is the last to take its place. */
  async write(folder: string, files: readonly OutputFile[], isOld?: (path: string) => boolean): Promise<void> {
    await this.stage(folder, async (write) => {
      for (const { name, bytes } of files) await write(name, bytes);
    }, isOld);
  }

  /**
   * Writes what `work` writes: all of it, and nothing before that is done. Files of an earlier run go if `isOld` says so, otherwise those
   * in folders that are written. Returns names, those of folders with a `/`. Rejects with what `work` rejects with, with `file-exists`
   * where another's file is in a place, or with `write-failed`, leaving nothing half-written.
   */
  async stage(folder: string, work: (write: Write) => Promise<void>, isOld?: (path: string) => boolean): Promise<string[]> {
    const part = join(folder, temporary('output'));
    const hashes = new Map<string, string>();
    const taken = new Map<string, string>();
    const tops = new Set<string>();
    const ledger = await Ledger.open(folder);
    try {
      await work((path, content) =>
        writing(folder, async () => {
          const other = taken.get(keyOf(path));
          if (other !== undefined) throw new VeroneseError('invalid-input', `'${other}' and '${path}' would be one file`);
          taken.set(keyOf(path), path);
          await ledger.check([path]);
          this.#begin(part);
          makeFolder(dirname(join(part, path)));
          const hash = createHash('sha256');
          await writeFile(join(part, path), hashed(content, hash));
          hashes.set(path, hash.digest('hex'));
          tops.add(path.includes('/') ? path.slice(0, path.indexOf('/') + 1) : path);
        }),
      );
      await writing(folder, async () => {
        const replace = await ledger.replacing(hashes.keys(), isOld ?? ((path) => tops.has(path.slice(0, path.indexOf('/') + 1))));
        replace(part, hashes);
      });
      return [...tops];
    } finally {
      this.discard();
    }
  }

  #begin(part: string): void {
    if (this.#part !== undefined) return;
    rmSync(part, { recursive: true, force: true });
    this.#part = part;
    makeFolder(part);
  }

  /** Removes what is half-written. */
  discard(): void {
    // A file that is still being written can come into the folder while it is emptied.
    if (this.#part !== undefined) rmSync(this.#part, { recursive: true, force: true, maxRetries: 10 });
    this.#part = undefined;
  }
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
