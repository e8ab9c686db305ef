// Node: the pixels of an image file, named by a path or an address.

import type { Pixels } from '../../types/index.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { decodeImage } from './codecs.js';
import { read } from './reading.js';

/** Throws `file-not-found`, `unreadable-file` or `unreadable-image`, the file named. */
export async function decodeFile(place: string | URL): Promise<Pixels> {
  const bytes = await bytesOf(place);
  try {
    const { data, width, height } = await decodeImage(bytes);
    return { data, width, height };
  } catch (thrown) {
    const { code, message } = veroneseError(thrown);
    throw new VeroneseError(code, `'${String(place)}': ${message}`);
  }
}

async function bytesOf(place: string | URL): Promise<Uint8Array> {
  try {
    const found = await read(place);
    if (ArrayBuffer.isView(found)) return found as Uint8Array;
    if (found instanceof ArrayBuffer) return new Uint8Array(found);
    if (found.ok) return new Uint8Array(await found.arrayBuffer());
    throw new VeroneseError(found.status === 404 ? 'file-not-found' : 'unreadable-file', `${found.url} answered ${`${found.status} ${found.statusText}`.trim()}`);
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw thrown;
    const { code, message } = thrown as NodeJS.ErrnoException;
    if (code === 'ENOENT') throw new VeroneseError('file-not-found', `there is no file '${String(place)}'`);
    throw new VeroneseError('unreadable-file', `'${String(place)}' cannot be read: ${message}`);
  }
}
