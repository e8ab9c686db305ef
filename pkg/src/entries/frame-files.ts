// Node: the pixels of an image file, named by a path or an address, or given as a `Blob` or a stream of bytes.

import type { BlobLike, FrameFile, Pixels } from '../../types/index.js';
import { invalidInput } from '../common/checks.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { decodeImage, isTooLarge } from './codecs.js';
import { read } from './reading.js';

/** Throws `file-not-found`, `unreadable-file` or `unreadable-image`, the file named. */
export async function decodeFile(place: FrameFile, maxSize: number | undefined): Promise<Pixels> {
  const bytes = isStream(place) ? await bytesFrom(place) : isBlob(place) ? await bytesIn(place) : await bytesOf(place);
  try {
    const { data, width, height } = await decodeImage(bytes, { maxSize });
    return { data, width, height };
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    const remedy = maxSize === undefined && isTooLarge(code, message) ? "; option 'maxSize' scales larger ones down" : '';
    throw new VeroneseError(code, `${nameOf(place)}: ${message}${remedy}`);
  }
}

function isStream(place: FrameFile): place is AsyncIterable<Uint8Array> {
  return typeof place === 'object' && Symbol.asyncIterator in place;
}

function isBlob(place: FrameFile): place is BlobLike {
  return typeof place === 'object' && 'arrayBuffer' in place;
}

/** How errors call it. */
function nameOf(place: FrameFile): string {
  if (isStream(place)) return 'the stream';
  return isBlob(place) ? `the file${'name' in place ? ` '${String(place.name)}'` : ' in memory'}` : `'${String(place)}'`;
}

async function bytesIn(file: BlobLike): Promise<Uint8Array> {
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch (thrown) {
    throw new VeroneseError('unreadable-file', `${nameOf(file)} cannot be read: ${(thrown as Error).message}`, { cause: thrown });
  }
}

async function bytesFrom(stream: AsyncIterable<unknown>): Promise<Uint8Array> {
  const pieces: Uint8Array[] = [];
  try {
    for await (const piece of stream) {
      if (!(piece instanceof Uint8Array)) throw invalidInput('a stream of a frame must give bytes, as Uint8Array');
      pieces.push(piece);
    }
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw thrown;
    throw new VeroneseError('unreadable-file', `the stream cannot be read: ${(thrown as Error).message}`, { cause: thrown });
  }
  return Buffer.concat(pieces);
}

async function bytesOf(place: string | URL): Promise<Uint8Array> {
  try {
    const found = await read(place);
    if (ArrayBuffer.isView(found)) return found as Uint8Array;
    if (found instanceof ArrayBuffer) return new Uint8Array(found);
    if (found.ok) return new Uint8Array(await found.arrayBuffer());
    throw new VeroneseError(
      found.status === 404 ? 'file-not-found' : 'unreadable-file',
      `${found.url} answered ${`${found.status} ${found.statusText}`.trim()}`,
    );
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw thrown;
    const { code, message } = thrown as NodeJS.ErrnoException;
    if (code === 'ENOENT') throw new VeroneseError('file-not-found', `there is no file '${String(place)}'`);
    throw new VeroneseError('unreadable-file', `'${String(place)}' cannot be read: ${message}`);
  }
}
