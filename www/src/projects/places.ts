//! Where a browser keeps files of a page: its origin private file system, else a database.

/** Files by name. A file is replaced as a whole, or stays as it was. None is empty. */
export interface Place {
  /** A larger file should not be written, bytes. */
  readonly largest: number;
  /** The sizes of all files by name, bytes; 0 if it is not known. */
  sizes(): Promise<ReadonlyMap<string, number>>;
  /** `null` if there is no such file. */
  read(name: string): Promise<Blob | null>;
  write(name: string, content: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<void>;
  remove(name: string): Promise<void>;
}

/** Opens the folder or the database of that name once. It throws if the browser keeps nothing for the page, and tries again when asked again. */
export function placeOf(name: string): () => Promise<Place> {
  let place: Promise<Place> | null = null;
  return () =>
    (place ??= openedPlace(name).catch((error: unknown) => {
      place = null;
      throw error;
    }));
}

async function openedPlace(name: string): Promise<Place> {
  const folder = await privateFolder(name).catch(() => null);
  return folder === null ? new Database(await opened(indexedDB.open(name, 1))) : new Folder(folder);
}

async function privateFolder(name: string): Promise<FileSystemDirectoryHandle | null> {
  // Some browsers have the file system, but cannot write it outside a worker.
  if (!('createWritable' in FileSystemFileHandle.prototype)) return null;
  return (await navigator.storage.getDirectory()).getDirectoryHandle(name, { create: true });
}

class Folder implements Place {
  readonly largest = 500e6;

  constructor(readonly folder: FileSystemDirectoryHandle) {}

  async sizes(): Promise<ReadonlyMap<string, number>> {
    const sizes = new Map<string, number>();
    for await (const name of this.folder.keys()) {
      if (isLeft(name)) continue;
      const file = await this.read(name);
      if (file !== null) sizes.set(name, file.size);
    }
    return sizes;
  }

  async read(name: string): Promise<Blob | null> {
    const handle = await this.folder.getFileHandle(name).catch(() => null);
    const file = await handle?.getFile().catch(() => null);
    // A file is empty until it is written for the first time, and stays so if the page is closed before.
    return file && file.size > 0 ? file : null;
  }

  async write(name: string, content: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<void> {
    const handle = await this.folder.getFileHandle(name, { create: true });
    try {
      // The file changes when the stream is closed; a stream that fails is aborted.
      await content.pipeTo(await handle.createWritable());
    } catch (error) {
      if ((await this.read(name)) === null) await this.remove(name);
      throw error;
    }
  }

  async remove(name: string): Promise<void> {
    await this.folder.removeEntry(name);
    for await (const other of this.folder.keys()) if (other.startsWith(name) && isLeft(other)) await this.folder.removeEntry(other).catch(() => undefined);
  }
}

/** Whether it is what a browser writes until it is the file: it stays where the browser is ended meanwhile. */
function isLeft(name: string): boolean {
  return name.endsWith('.crswap');
}

const FILES = 'files';

/** Files are under their names; the size of each is under a list of its name, to be read without the file. */
class Database implements Place {
  /** A file is in memory while it is written or read. */
  readonly largest = 50e6;

  constructor(readonly database: IDBDatabase) {}

  async sizes(): Promise<ReadonlyMap<string, number>> {
    const files = this.#files('readonly');
    const lists = IDBKeyRange.lowerBound([]); // all lists come after all texts
    const [keys, sizes] = await Promise.all([settled(files.getAllKeys()), settled<number[]>(files.getAll(lists))]);
    const names = keys.filter((key) => typeof key === 'string');
    const sized = keys.filter((key) => Array.isArray(key)).map(([name]) => name);
    return new Map(names.map((name) => [name, sizes[sized.indexOf(name)] ?? 0]));
  }

  async read(name: string): Promise<Blob | null> {
    const file = await settled<ArrayBuffer | undefined>(this.#files('readonly').get(name));
    return file === undefined ? null : new Blob([file]);
  }

  async write(name: string, content: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<void> {
    // WebKit's private windows store bytes, but no blobs.
    const bytes = await new Response(content).arrayBuffer();
    const files = this.#files('readwrite');
    files.put(bytes, name);
    files.put(bytes.byteLength, [name]);
    await completed(files.transaction);
  }

  async remove(name: string): Promise<void> {
    const files = this.#files('readwrite');
    files.delete(name);
    files.delete([name]);
    await completed(files.transaction);
  }

  #files(mode: IDBTransactionMode): IDBObjectStore {
    return this.database.transaction(FILES, mode).objectStore(FILES);
  }
}

function opened(request: IDBOpenDBRequest): Promise<IDBDatabase> {
  request.addEventListener('upgradeneeded', () => void request.result.createObjectStore(FILES));
  return settled(request);
}

function settled<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.addEventListener('success', () => resolve(request.result));
    request.addEventListener('error', () => reject(request.error));
  });
}

/** A full disk shows only when a transaction completes. */
function completed(transaction: IDBTransaction): Promise<void> {
  return new Promise((resolve, reject) => {
    transaction.addEventListener('complete', () => resolve());
    transaction.addEventListener('abort', () => reject(transaction.error));
  });
}
