//! The journal of a clip: in memory until the work is worth keeping, then in this browser's database, a row for each of its writes. What cannot be
//! written stays in memory, also when the clip is left, and is written with what comes next.
//!
//! One tab keeps the work on a clip. Another one works on in memory, and keeps it when the first has gone and has written nothing meanwhile.

import type { ClipJournal } from 'veronese';
import { PageError, isStorageFull } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { removeAllFrames } from './copies.js';
import { keysOf, putRow, replaceRows, rowsOf } from './database.js';
import { owns } from './owner.js';

/** Called when all is written, and when something could not be. */
interface Heard {
  readonly kept: () => void;
  readonly refused: (error: unknown) => void;
}

export class PageJournal implements ClipJournal {
  readonly #of: string;
  readonly #name: string;
  readonly #heard: Heard;
  /** What the database has, once it is read. */
  #known: readonly Uint8Array[] | null = null;
  /** What it does not have; and whether that takes the place of what it has. */
  #unwritten: Uint8Array[];
  #replaces = false;
  #isKept = false;
  /** The number of the next row, as this tab knows it. */
  #next = 0;
  /** Rows are written one after another. */
  #turn: Promise<unknown> = Promise.resolve();

  /** `early`: what was written before this was loaded. */
  constructor(of: string, name: string, early: Uint8Array[], heard: Heard) {
    this.#of = of;
    this.#name = name;
    this.#unwritten = early;
    this.#heard = heard;
  }

  /** Of all that was written. */
  get bytes(): number {
    return sizeOf([...(this.#replaces ? [] : (this.#known ?? [])), ...this.#unwritten]);
  }

  /** Whether the database is to have it. */
  get isKept(): boolean {
    return this.#isKept;
  }

  /** Whether the database has all of it. */
  get isWritten(): boolean {
    return this.#isKept && this.#unwritten.length === 0;
  }

  async read(): Promise<Uint8Array | undefined> {
    const rows = await this.#inTurn(() => this.#rows());
    return sizeOf(rows) > 0 ? joined(rows) : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    await this.#inTurn(async () => void this.#unwritten.push(records));
    await this.#write();
  }

  async replace(saved: Uint8Array): Promise<void> {
    await this.#inTurn(async () => {
      await this.#rows();
      [this.#unwritten, this.#replaces] = [[saved], true];
    });
    await this.#write();
  }

  /** A damaged journal is kept beside its readable part. */
  async keepDamaged(content: Uint8Array): Promise<void> {
    await replaceRows(`${this.#of} damaged`, 0, content);
  }

  /** Writes all to the database, from now on at once. */
  async keep(): Promise<void> {
    if (!this.#isKept) await this.#inTurn(() => this.#rows());
    this.#isKept = true;
    await this.#write();
  }

  /** Removes what the database has, which is in memory from then on. */
  forgotten(remove: () => Promise<void>): Promise<void> {
    return this.#inTurn(async () => {
      const rows = await this.#rows();
      await remove();
      [this.#unwritten, this.#known, this.#replaces, this.#isKept, this.#next] = [[...rows], [], false, false, 0];
    });
  }

  /** Settled when what was given so far is written, or could not be. */
  async settled(): Promise<void> {
    await this.#turn;
  }

  /** All that was given. What cannot be read cannot be written either: that is said then. */
  async #rows(): Promise<readonly Uint8Array[]> {
    if (this.#known === null) {
      const { rows, next } = await rowsOf(this.#of).catch(() => ({ rows: [], next: 0 }));
      [this.#known, this.#next] = [rows, next];
      if (next > 0) this.#isKept = true;
    }
    return this.#replaces ? this.#unwritten : [...this.#known, ...this.#unwritten];
  }

  #write(): Promise<void> {
    return this.#inTurn(async () => {
      if (!this.#isKept) return;
      const rows = this.#unwritten;
      this.#unwritten = [];
      try {
        const isUpToDate = async (): Promise<boolean> => (await keysOf(this.#of)) === this.#next;
        if (!(await owns(this.#of, isUpToDate))) throw new PageError('open-elsewhere', strings.projects.elsewhere(this.#name));
        if (rows.length > 0) await this.#put(joined(rows));
      } catch (error) {
        this.#unwritten = rows;
        return this.#heard.refused(error);
      }
      this.#heard.kept();
    });
  }

  async #put(row: Uint8Array): Promise<void> {
    const [number, replaces] = [this.#next, this.#replaces];
    const put = (): Promise<void> => (replaces ? replaceRows : putRow)(this.#of, number, row);
    await put().catch(async (error: unknown) => {
      // Copies of frames give way to work.
      if (!isStorageFull(error) || !(await removeAllFrames().catch(() => false))) throw error;
      await put();
    });
    this.#next = number + 1;
    this.#known = replaces ? [row] : [...(this.#known ?? []), row];
    this.#replaces = false;
  }

  #inTurn<T>(work: () => Promise<T>): Promise<T> {
    const done = this.#turn.then(work);
    this.#turn = done.catch(() => undefined);
    return done;
  }
}

function sizeOf(rows: readonly Uint8Array[]): number {
  return rows.reduce((sum, { length }) => sum + length, 0);
}

function joined(rows: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(sizeOf(rows));
  let at = 0;
  for (const row of rows) {
    all.set(row, at);
    at += row.length;
  }
  return all;
}
