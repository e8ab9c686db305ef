//! What this browser keeps of projects, in one database: a header of each, which lists show, its journal in rows, and masks that are known. The
//! masks can be made again from the journal; the journal is the work.

import type { Header } from './file.js';
import type { KnownMasks } from './work.js';

const NAME = 'veronese-projects';
const [HEADERS, ROWS, MASKS] = ['headers', 'rows', 'masks'] as const;

let database: Promise<IDBDatabase> | null = null;

function opened(): Promise<IDBDatabase> {
  database ??= new Promise<IDBDatabase>((resolve, reject) => {
    const request = indexedDB.open(NAME, 1);
    request.onupgradeneeded = () => [HEADERS, ROWS, MASKS].forEach((store) => request.result.createObjectStore(store));
    request.onsuccess = () => {
      // Whoever deletes the database need not wait for this page.
      request.result.onversionchange = () => {
        request.result.close();
        database = null;
      };
      resolve(request.result);
    };
    request.onerror = () => reject(request.error);
  }).catch((error: unknown) => {
    database = null;
    throw error;
  });
  return database;
}

/** Does work on a store in one transaction. It is done when it is on the disk: a full one shows only then. */
async function run<T>(name: (typeof HEADERS) | (typeof ROWS) | (typeof MASKS), mode: IDBTransactionMode, work: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const transaction = (await opened()).transaction(name, mode, { durability: 'strict' });
  const request = work(transaction.objectStore(name));
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve(request.result);
    transaction.onabort = () => reject(transaction.error);
  });
}

/** Whether nothing was ever kept, so that a first visit need not look. */
export async function isNothingKept(): Promise<boolean> {
  try {
    return !(await indexedDB.databases()).some(({ name }) => name === NAME);
  } catch {
    return false; // a browser that does not say it is asked
  }
}

export async function headers(): Promise<Header[]> {
  return run(HEADERS, 'readonly', (store) => store.getAll());
}

export async function headerOf(of: string): Promise<Header | null> {
  return (await run<Header | undefined>(HEADERS, 'readonly', (store) => store.get(of))) ?? null;
}

export async function putHeader(header: Header): Promise<void> {
  await run(HEADERS, 'readwrite', (store) => store.put(header, header.of));
}

/** The rows of a journal, and the number of the next one. */
export async function rowsOf(of: string): Promise<{ readonly rows: Uint8Array[]; readonly next: number }> {
  const [rows, keys] = await Promise.all([run<Uint8Array[]>(ROWS, 'readonly', (store) => store.getAll(all(of))), keysOf(of)]);
  return { rows, next: keys };
}

/** The number of the next row of a journal. */
export async function keysOf(of: string): Promise<number> {
  const keys = await run(ROWS, 'readonly', (store) => store.getAllKeys(all(of)));
  return ((keys.at(-1) as [string, number] | undefined)?.[1] ?? -1) + 1;
}

export async function putRow(of: string, number: number, row: Uint8Array): Promise<void> {
  await run(ROWS, 'readwrite', (store) => store.put(row, [of, number]));
}

/** Puts one row in the place of all before, under a number that none has had. */
export async function replaceRows(of: string, number: number, row: Uint8Array): Promise<void> {
  await run(ROWS, 'readwrite', (store) => {
    store.delete(all(of));
    return store.put(row, [of, number]);
  });
}

export async function masksOf(of: string): Promise<KnownMasks | null> {
  return (await run<KnownMasks | undefined>(MASKS, 'readonly', (store) => store.get(of))) ?? null;
}

export async function putMasks(of: string, masks: KnownMasks): Promise<void> {
  await run(MASKS, 'readwrite', (store) => store.put(masks, of));
}

/** Removes all that is kept of a project. */
export async function forget(of: string): Promise<void> {
  await run(HEADERS, 'readwrite', (store) => store.delete(of));
  await run(ROWS, 'readwrite', (store) => store.delete(all(of)));
  await run(MASKS, 'readwrite', (store) => store.delete(of));
}

/** All rows of a journal, in order. */
function all(of: string): IDBKeyRange {
  return IDBKeyRange.bound([of, 0], [of, Infinity]);
}
