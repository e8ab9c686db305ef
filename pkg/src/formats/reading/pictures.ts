// The size of a picture, from the beginning of its file.

import { headOf } from '../png-reader.js';
import { decoding, isPng } from './frame.js';

/** Of a PNG or JPEG file; undefined of another one, or if it is not within the bytes. */
export function sizeOfPicture(bytes: Uint8Array): { width: number; height: number } | undefined {
  if (isPng(bytes)) return decoding('it', () => headOf(bytes));
  const word = (at: number) => ((bytes[at] as number) << 8) | (bytes[at + 1] as number);
  // Segments of a JPEG: FF, what it is, its length. The one that begins a frame has the size.
  for (let at = 2; bytes[0] === 0xff && bytes[1] === 0xd8 && at + 9 < bytes.length; at += 2 + word(at + 2)) {
    while (bytes[at + 1] === 0xff) at++;
    const kind = bytes[at + 1] as number;
    if (bytes[at] !== 0xff) return undefined;
    if (kind >= 0xc0 && kind <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(kind)) return { width: word(at + 7), height: word(at + 5) };
  }
  return undefined;
}
