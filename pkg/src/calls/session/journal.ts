// What a clip has told its journal, in order. Records that could not be written are written with the next ones.

import type { ClipJournal } from '../../../types/index.js';
import { joined } from '../../common/bytes.js';

/** A journal in memory: a clip outlives its worker with it. */
export class MemoryJournal implements ClipJournal {
  #records: Uint8Array[] = [];

  async read(): Promise<Uint8Array | undefined> {
    return this.#records.length > 0 ? joined(this.#records) : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    this.#records.push(records);
  }

  async replace(saved: Uint8Array): Promise<void> {
    this.#records = [saved];
  }
}

export class JournalWriter {
  readonly #journal: ClipJournal;
  #unwritten: Uint8Array[] = [];
  /** Whether the unwritten records take the place of all before. */
  #replaces = false;
  #written: Promise<void> = Promise.resolve();

  constructor(journal: ClipJournal) {
    this.#journal = journal;
  }

  /** The content of the journal, and what could not be written. */
  async content(): Promise<Uint8Array | undefined> {
    await this.#written;
    const before = this.#replaces ? undefined : await this.#journal.read();
    const all = [...(before ? [before] : []), ...this.#unwritten];
    return all.length > 0 ? joined(all) : undefined;
  }

  /** Adds records, or puts them in the place of all before. Resolves to the number of bytes when they are kept; rejects if the journal fails. */
  write(records: Uint8Array, replaces: boolean): Promise<number> {
    if (replaces) {
      this.#unwritten = [];
      this.#replaces = true;
    }
    this.#unwritten.push(records);
    const writing = this.#written.then(() => this.#write());
    this.#written = writing.then(
      () => undefined,
      () => undefined,
    );
    return writing;
  }

  /** Tries once more to write what could not be written. */
  flush(): Promise<number> {
    return this.write(new Uint8Array(), false);
  }

  /** Cuts off what could not be read of the content. If that is damaged, the journal may keep all of it elsewhere. */
  async cut(content: Uint8Array, used: number, isDamaged: boolean): Promise<void> {
    if (isDamaged) await this.#journal.keepDamaged?.(content);
    await this.write(content.subarray(0, used), true);
  }

  /** Waits until all that was given is written, or could not be. */
  settled(): Promise<void> {
    return this.#written;
  }

  async #write(): Promise<number> {
    const records = this.#unwritten;
    const replaces = this.#replaces;
    if (!records.some(({ length }) => length > 0) && !replaces) return 0;
    [this.#unwritten, this.#replaces] = [[], false];
    const bytes = joined(records);
    try {
      await (replaces ? this.#journal.replace(bytes) : this.#journal.append(bytes));
      return bytes.length;
    } catch (thrown) {
      // Records that replace all have come since: these are in them.
      if (!this.#replaces) [this.#unwritten, this.#replaces] = [[bytes, ...this.#unwritten], replaces];
      throw thrown;
    }
  }
}
