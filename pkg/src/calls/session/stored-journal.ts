// A journal in IndexedDB: each append is a row, which is written in one transaction and asked to be on the disk when that ends. A lock makes sure
// that one clip alone writes to it.

import type { ClipJournal } from '../../../types/index.js';
import { joined } from '../../common/bytes.js';
import { VeroneseError } from '../../common/errors.js';

const DATABASE = 'veronese-journals';
const ROWS = 'rows';

export async function openStored(name: string): Promise<ClipJournal> {
  const unlock = await lock(name);
  try {
    return new StoredJournal(name, await opened(), unlock);
  } catch (cause) {
    await unlock();
    throw failed(name, cause);
  }
}

class StoredJournal implements ClipJournal {
  readonly #name: string;
  readonly #database: IDBDatabase;
  readonly #unlock: () => Promise<void>;
  /** The number of the next row. */
  #next: number | undefined;

  constructor(name: string, database: IDBDatabase, unlock: () => Promise<void>) {
    this.#name = name;
    this.#database = database;
    this.#unlock = unlock;
  }

  async read(): Promise<Uint8Array | undefined> {
    const rows = await this.#run('readonly', (store) => store.getAll(rangeOf(this.#name)));
    return rows.length > 0 ? joined(rows as Uint8Array[]) : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    if (this.#next === undefined) {
      const keys = await this.#run('readonly', (store) => store.getAllKeys(rangeOf(this.#name)));
      this.#next = ((keys.at(-1) as [string, number] | undefined)?.[1] ?? -1) + 1;
    }
    const at = this.#next;
    await this.#run('readwrite', (store) => store.put(records, [this.#name, at]));
    this.#next = at + 1;
  }

  async replace(saved: Uint8Array): Promise<void> {
    await this.#run('readwrite', (store) => {
      store.delete(rangeOf(this.#name));
      return store.put(saved, [this.#name, 0]);
    });
    this.#next = 1;
  }

  /** Under a name of its own. */
  async keepDamaged(content: Uint8Array): Promise<void> {
    await this.#run('readwrite', (store) => store.put(content, [`${this.#name}.damaged`, 0]));
  }

  close(): Promise<void> {
    this.#database.close();
    return this.#unlock();
  }

  #run<T>(mode: 'readonly' | 'readwrite', work: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      const transaction = this.#database.transaction(ROWS, mode, { durability: 'strict' });
      const request = work(transaction.objectStore(ROWS));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onabort = () => reject(transaction.error);
    }).catch((cause: unknown) => {
      throw failed(this.#name, cause);
    });
  }
}

/** All rows of a journal, in order. */
function rangeOf(name: string): IDBKeyRange {
  return IDBKeyRange.bound([name, 0], [name, Infinity]);
}

function opened(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open(DATABASE, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(ROWS);
    request.onsuccess = () => {
      // Whoever deletes the database need not wait for this page.
      request.result.onversionchange = () => request.result.close();
      resolve(request.result);
    };
    request.onerror = () => reject(request.error);
  });
}

/** Holds the lock of a journal until the returned function is called, or the page is closed. */
async function lock(name: string): Promise<() => Promise<void>> {
  const { locks } = globalThis.navigator ?? {};
  if (!locks || !globalThis.indexedDB)
    throw new VeroneseError(
      'invalid-option',
      "option 'journal': there is no storage for names here: give an object with read, append and replace",
    );
  return new Promise((resolve, reject) => {
    const held = locks.request(`veronese journal ${name}`, { ifAvailable: true }, (lock) => {
      if (!lock) throw new VeroneseError('invalid-option', `option 'journal': another clip has '${name}' open: close it first`);
      return new Promise<void>((release) => {
        resolve(() => {
          release();
          return held;
        });
      });
    });
    held.catch(reject);
  });
}

function failed(name: string, cause: unknown): VeroneseError {
  const reason = cause instanceof Error ? cause.message : String(cause);
  return new VeroneseError('write-failed', `the journal '${name}' cannot be kept: ${reason}`, { cause });
}
