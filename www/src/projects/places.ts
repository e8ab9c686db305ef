//! Where a browser keeps files of a page: its origin private file system, else a database.

/** Files by name. A file is replaced as a whole, or stays as it was. */
export interface Place {
  list(): Promise<ReadonlyMap<string, Blob>>;
  /** `null` if there is no such file. */
  read(name: string): Promise<Blob | null>;
  write(name: string, content: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<void>;
  remove(name: string): Promise<void>;
}

/** The folder, and the name of the database. */
const PROJECTS = 'projects';

/** Throws if the browser keeps nothing for the page. */
export async function placeOfProjects(): Promise<Place> {
  const folder = await privateFolder().catch(() => null);
  return folder === null ? new Database(await opened(indexedDB.open(PROJECTS, 1))) : new Folder(folder);
}

async function privateFolder(): Promise<FileSystemDirectoryHandle | null> {
  // Some browsers have the file system, but cannot write it outside a worker.
  if (!('createWritable' in FileSystemFileHandle.prototype)) return null;
  return (await navigator.storage.getDirectory()).getDirectoryHandle(PROJECTS, { create: true });
}

class Folder implements Place {
  constructor(readonly folder: FileSystemDirectoryHandle) {}

  async list(): Promise<ReadonlyMap<string, Blob>> {
    const files = new Map<string, Blob>();
    for await (const name of this.folder.keys()) {
      const file = await this.read(name);
      if (file !== null) files.set(name, file);
    }
    return files;
  }

  async read(name: string): Promise<Blob | null> {
    const handle = await this.folder.getFileHandle(name).catch(() => null);
    return handle === null ? null : handle.getFile();
  }

  async write(name: string, content: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<void> {
    const handle = await this.folder.getFileHandle(name, { create: true });
    try {
      // The file changes when the stream is closed; a stream that fails is aborted.
      await content.pipeTo(await handle.createWritable());
    } catch (error) {
      if ((await handle.getFile()).size === 0) await this.remove(name);
      throw error;
    }
  }

  async remove(name: string): Promise<void> {
    await this.folder.removeEntry(name);
  }
}

const FILES = 'files';

class Database implements Place {
  constructor(readonly database: IDBDatabase) {}

  async list(): Promise<ReadonlyMap<string, Blob>> {
    const names = (await settled(this.#files('readonly').getAllKeys())) as string[];
    const files: ArrayBuffer[] = await settled(this.#files('readonly').getAll());
    return new Map(names.map((name, k) => [name, new Blob([files[k]!])]));
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
    await completed(files.transaction);
  }

  async remove(name: string): Promise<void> {
    const files = this.#files('readwrite');
    files.delete(name);
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
