// The indices of a PNG, which its colours do not tell: in the DAVIS palette 7 and 128 are the same grey.

import { inflateSync } from 'node:zlib';
import { LONGEST_SIDE } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';

const SIGNATURE = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
/** Of the header chunk: deflated, filtered row by row, not interlaced. */
const FORM = Buffer.from([0, 0, 0]);
const [GREY, INDEXED] = [0, 3];

export interface Indices {
  indices: Uint8Array;
  width: number;
  height: number;
}

/**
 * Throws `unreadable-image`, or `invalid-input` where it is a picture of another kind. The sentences follow the file's name. `foreign`:
 * other programs write labels with fewer bits or as grey levels too.
 */
export function decodeIndices(file: Uint8Array, { foreign = false } = {}): Indices {
  const bytes = Buffer.from(file.buffer, file.byteOffset, file.byteLength);
  if (!bytes.subarray(0, SIGNATURE.length).equals(SIGNATURE)) throw unreadable('is not a PNG');
  let header: Buffer | undefined;
  const data: Buffer[] = [];
  for (const { name, content } of chunks(bytes)) {
    if (name === 'IHDR') header = content;
    if (name === 'IDAT') data.push(content);
  }
  if (header?.length !== 13) throw unreadable('has no header');
  const [width, height] = [header.readUInt32BE(0), header.readUInt32BE(4)];
  const [depth, type] = [header.readUInt8(8), header.readUInt8(9)];
  const fits = foreign ? [1, 2, 4, 8].includes(depth) && [GREY, INDEXED].includes(type) : depth === 8 && type === INDEXED;
  if (!fits || !header.subarray(10).equals(FORM)) {
    const kind = foreign ? 'an indexed or grey PNG of up to 8 bits without interlacing' : 'an 8-bit indexed PNG';
    throw new VeroneseError('invalid-input', `has no labels: it is not ${kind}`);
  }
  if (width < 1 || height < 1 || Math.max(width, height) > LONGEST_SIDE) throw unreadable(`has ${width} × ${height} pixels`);
  const row = Math.ceil((width * depth) / 8);
  const rows = unfiltered(inflated(data, (row + 1) * height), row, height);
  return { indices: depth === 8 ? rows : unpacked(rows, row, depth, width, height), width, height };
}

/** Pixels of fewer than 8 bits, the first in the highest bits; every row begins with a byte of its own. */
function unpacked(rows: Uint8Array, row: number, depth: number, width: number, height: number): Uint8Array {
  const perByte = 8 / depth;
  return Uint8Array.from({ length: width * height }, (_, at) => {
    const x = at % width;
    const byte = rows[Math.floor(at / width) * row + Math.floor(x / perByte)] as number;
    return (byte >> (8 - depth * ((x % perByte) + 1))) & ((1 << depth) - 1);
  });
}

function unreadable(reason: string): VeroneseError {
  return new VeroneseError('unreadable-image', reason);
}

/** Each is its length, its name, as many bytes, and a checksum; the data have one of their own. */
function* chunks(bytes: Buffer): Generator<{ name: string; content: Buffer }, void, undefined> {
  for (let at = SIGNATURE.length; at + 12 <= bytes.length; ) {
    const length = bytes.readUInt32BE(at);
    yield { name: bytes.toString('latin1', at + 4, at + 8), content: bytes.subarray(at + 8, at + 8 + length) };
    at += 12 + length;
  }
}

function inflated(data: readonly Buffer[], length: number): Buffer {
  let rows: Buffer | undefined;
  try {
    rows = inflateSync(Buffer.concat(data), { maxOutputLength: length });
  } catch {
    // Cut off, damaged, or longer than the picture.
  }
  if (rows?.length === length) return rows;
  throw unreadable('is damaged');
}

/** Every row begins with the number of its filter, which adds what stands to the left, above or both. */
function unfiltered(rows: Buffer, width: number, height: number): Uint8Array {
  const indices = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) {
    const from = y * (width + 1);
    const filter = rows[from] as number;
    if (filter > 4) throw unreadable('is damaged');
    const start = y * width;
    for (let x = 0; x < width; x++) {
      const left = x > 0 ? (indices[start + x - 1] as number) : 0;
      const above = y > 0 ? (indices[start + x - width] as number) : 0;
      const corner = x > 0 && y > 0 ? (indices[start + x - width - 1] as number) : 0;
      // Assignment keeps the lowest eight bits.
      indices[start + x] = (rows[from + 1 + x] as number) + predicted(filter, left, above, corner);
    }
  }
  return indices;
}

function predicted(filter: number, left: number, above: number, corner: number): number {
  if (filter === 0) return 0;
  if (filter === 1) return left;
  if (filter === 2) return above;
  if (filter === 3) return (left + above) >> 1;
  const [toLeft, toAbove, toCorner] = [Math.abs(above - corner), Math.abs(left - corner), Math.abs(left + above - 2 * corner)];
  if (toLeft <= toAbove && toLeft <= toCorner) return left;
  return toAbove <= toCorner ? above : corner;
}
