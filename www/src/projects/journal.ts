//! The journal of the clip that is open: in memory until the work is worth keeping, then in this browser's database, a row for each of its writes.
//! One tab keeps the work on a clip. Another one works on in memory, and keeps it when the first has gone and has written nothing meanwhile.

import type { ClipJournal } from 'veronese';
import { PageError, isStorageFull } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { removeAllFrames } from './copies.js';
import { keysOf, putRow, replaceRows, rowsOf } from './database.js';
import { owns } from './owner.js';

export class PageJournal implements ClipJournal {
  readonly #of: string;
  readonly #name: string;
  /** What is in memory alone; `null` when all is in the database. */
  #memory: Uint8Array[] | null = [];
  /** The number of the next row, as this tab knows it. */
  #next = 0;
  #bytes = 0;
  /** Rows are written one after another. */
  #turn: Promise<unknown> = Promise.resolve();

  /** `early`: what was written before this was loaded. */
  constructor(of: string, name: string, early: Uint8Array[]) {
    this.#of = of;
    this.#name = name;
    this.#memory = early;
  }

  /** Of all that was written. */
  get bytes(): number {
    return this.#bytes;
  }

  get isKept(): boolean {
    return this.#memory === null;
  }

  async read(): Promise<Uint8Array | undefined> {
    const rows = await this.#inTurn(() => this.#rows());
    this.#bytes = rows.reduce((sum, { length }) => sum + length, 0);
    return this.#bytes > 0 ? new Uint8Array(await new Blob([...rows] as BlobPart[]).arrayBuffer()) : undefined;
  }

  /** All that was written. What cannot be read cannot be written either: that is said then. */
  async #rows(): Promise<readonly Uint8Array[]> {
    if (this.#memory !== null && this.#memory.length > 0) return this.#memory;
    const { rows, next } = await rowsOf(this.#of).catch(() => ({ rows: [], next: 0 }));
    this.#next = next;
    if (rows.length > 0) this.#memory = null;
    return rows;
  }

  append(records: Uint8Array): Promise<void> {
    return this.#inTurn(async () => {
      if (this.#memory === null) await this.#put((number) => putRow(this.#of, number, records));
      else this.#memory.push(records);
      this.#bytes += records.length;
    });
  }

  replace(saved: Uint8Array): Promise<void> {
    return this.#inTurn(async () => {
      if (this.#memory === null) await this.#put((number) => replaceRows(this.#of, number, saved));
      else this.#memory = [saved];
      this.#bytes = saved.length;
    });
  }

  /** A damaged journal is kept beside its readable part. */
  async keepDamaged(content: Uint8Array): Promise<void> {
    await replaceRows(`${this.#of} damaged`, 0, content);
  }

  /** Writes all to the database, from now on at once. */
  keep(): Promise<void> {
    return this.#inTurn(async () => {
      const rows = this.#memory === null ? [] : await this.#rows();
      if (this.#memory === null || rows.length === 0) await this.#own();
      else {
        const all = new Uint8Array(await new Blob([...rows] as BlobPart[]).arrayBuffer());
        await this.#put((number) => replaceRows(this.#of, number, all));
      }
      this.#memory = null;
    });
  }

  /** The database has nothing of it any more: it is in memory. */
  forgotten(content: Uint8Array): Promise<void> {
    return this.#inTurn(async () => void (this.#memory = [content]));
  }

  async #put(write: (number: number) => Promise<void>): Promise<void> {
    await this.#own();
    const number = this.#next;
    await write(number).catch(async (error: unknown) => {
      // Copies of frames give way to work.
      if (!isStorageFull(error) || !(await removeAllFrames().catch(() => false))) throw error;
      await write(number);
    });
    this.#next = number + 1;
  }

  /** Makes sure that no other tab keeps the work, and that none has kept more of it. */
  async #own(): Promise<void> {
    const isUpToDate = async (): Promise<boolean> => (await keysOf(this.#of)) === this.#next;
    if (!(await owns(this.#of, isUpToDate))) throw new PageError('open-elsewhere', strings.projects.elsewhere(this.#name));
  }

  #inTurn<T>(work: () => Promise<T>): Promise<T> {
    const done = this.#turn.then(work);
    this.#turn = done.catch(() => undefined);
    return done;
  }
}
