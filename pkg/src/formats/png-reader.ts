// The samples of a PNG, which its colours do not tell: in the DAVIS palette 7 and 128 are the same grey. Inflated by fflate and not by the
// host: Node and browsers have different calls for it, and those of browsers are asynchronous.

import { Unzlib } from 'fflate';
import { LONGEST_LABEL_SIDE, MOST_LABELS } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
/** By colour type, samples of a pixel: grey, colours, indices, grey with alpha, colours with alpha. */
const SAMPLES: Record<number, number> = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
const [GREY, INDEXED] = [0, 3];
/** The first column and row of each pass, and the steps between them: of a picture that is interlaced, and of one that is not. */
const INTERLACED = [
  [0, 0, 8, 8],
  [4, 0, 8, 8],
  [0, 4, 4, 8],
  [2, 0, 4, 4],
  [0, 2, 2, 4],
  [1, 0, 2, 2],
  [0, 1, 1, 2],
] as const;
const PLAIN = [[0, 0, 1, 1]] as const;
/** Compressed data are taken in pieces of this size, bytes: what is longer than the picture is noticed before it fills the memory. */
const PIECE = 65_536;

export interface Size {
  width: number;
  height: number;
}

/** A picture of any kind as it is in the file. */
export interface Samples extends Size {
  /** Of a pixel. */
  channels: number;
  /** Row by row. */
  samples: Uint8Array | Uint16Array;
  /** Bits of a sample. */
  depth: number;
  /** Red, green, blue of each index, where the samples are indices. */
  palette?: Uint8Array;
  /** Alpha of the first indices, if there is some. */
  alpha?: Uint8Array;
}

/** The samples of any PNG. Throws `unreadable-image`. */
export function decodePng(file: Uint8Array): Samples {
  const { width, height, depth, type, passes, data, palette, alpha } = opened(file);
  const channels = SAMPLES[type];
  const isKnown = channels !== undefined && ([8, 16].includes(depth) || (channels === 1 && [1, 2, 4].includes(depth)));
  if (!isKnown || !passes || (type === INDEXED && !palette)) throw damaged();
  const parts = passes
    .map(([left, top, across, down]) => ({
      left,
      top,
      across,
      down,
      width: Math.ceil((width - left) / across),
      height: Math.ceil((height - top) / down),
    }))
    .filter((part) => part.width > 0 && part.height > 0)
    .map((part) => ({ ...part, stride: Math.ceil((part.width * channels * depth) / 8) }));
  const length = parts.reduce((sum, part) => sum + (part.stride + 1) * part.height, 0);
  const all = inflated(data, length);
  if (all.length !== length) throw damaged();
  let samples: Uint8Array | Uint16Array = new Uint8Array();
  if (passes.length > 1) samples = depth === 16 ? new Uint16Array(width * height * channels) : new Uint8Array(width * height * channels);
  let at = 0;
  for (const { left, top, across, down, stride, ...part } of parts) {
    const bytes = unfiltered(all.subarray(at, (at += (stride + 1) * part.height)), stride, part.height, Math.ceil((depth * channels) / 8));
    const own = samplesOf(bytes, depth, part.width * channels, part.height);
    if (passes.length === 1) samples = own;
    else
      for (let y = 0, from = 0; y < part.height; y++) {
        for (let x = 0; x < part.width; x++, from += channels) {
          const to = ((top + y * down) * width + left + x * across) * channels;
          for (let channel = 0; channel < channels; channel++) samples[to + channel] = own[from + channel] as number;
        }
      }
  }
  return { width, height, depth, channels, samples, ...(type === INDEXED && palette && { palette, ...(alpha && { alpha }) }) };
}

/**
 * The labels in a PNG of this package: indices of 8 bits. `foreign`: other programs write labels with fewer bits or as grey levels too.
 * Throws `unreadable-image`, or `invalid-input` where it is a picture of another kind.
 */
export function decodeIndices(file: Uint8Array, { foreign = false } = {}): Size & { labels: Uint8Array; isGrey: boolean } {
  const { depth, type } = opened(file);
  const fits = foreign ? depth <= 8 && (type === GREY || type === INDEXED) : depth === 8 && type === INDEXED;
  if (!fits)
    throw new VeroneseError(
      'invalid-input',
      `it has no labels: it is not an ${foreign ? 'indexed or grey PNG of up to 8 bits' : '8-bit indexed PNG'}`,
    );
  const { width, height, samples } = decodePng(file);
  return { labels: samples as Uint8Array, isGrey: type === GREY, width, height };
}

/** The size, and whether the samples are grey levels of 16 bits. Throws as {@link decodePng} does. */
export function headOf(file: Uint8Array): Size & { isDeep: boolean } {
  const { width, height, depth, type } = opened(file);
  return { width, height, isDeep: depth === 16 && type === GREY };
}

interface Png extends Size {
  depth: number;
  type: number;
  /** None where it is compressed or filtered in an unknown way. */
  passes: readonly (readonly [left: number, top: number, across: number, down: number])[] | undefined;
  data: Uint8Array[];
  palette?: Uint8Array;
  alpha?: Uint8Array;
}

function opened(file: Uint8Array): Png {
  if (!SIGNATURE.every((byte, at) => file[at] === byte)) throw unreadable('it is not a PNG');
  let header: Uint8Array | undefined;
  const data: Uint8Array[] = [];
  const colours: Pick<Png, 'palette' | 'alpha'> = {};
  for (const { name, content } of chunks(file)) {
    if (name === 'IHDR') header = content;
    if (name === 'IDAT') data.push(content);
    if (name === 'PLTE') colours.palette = content;
    if (name === 'tRNS') colours.alpha = content;
  }
  if (header?.length !== 13) throw unreadable('it has no header');
  const view = viewOf(header);
  const [width, height] = [view.getUint32(0), view.getUint32(4)];
  if (width < 1 || height < 1 || Math.max(width, height) > LONGEST_LABEL_SIDE || width * height > MOST_LABELS)
    throw unreadable(`it has ${width} × ${height} pixels`);
  const [depth, type, compression, filter, interlacing] = header.subarray(8) as unknown as [number, number, number, number, number];
  const passes = compression === 0 && filter === 0 ? [PLAIN, INTERLACED][interlacing] : undefined;
  return { width, height, depth, type, passes, data, ...colours };
}

function viewOf({ buffer, byteOffset, byteLength }: Uint8Array): DataView {
  return new DataView(buffer, byteOffset, byteLength);
}

/** Samples of rows that each begin with a byte of their own: of fewer than 8 bits, the first in the highest bits; of 16, most significant byte first. */
function samplesOf(rows: Uint8Array, depth: number, width: number, height: number): Uint8Array | Uint16Array {
  if (depth === 8) return rows;
  if (depth === 16)
    return Uint16Array.from({ length: rows.length / 2 }, (_, at) => ((rows[2 * at] as number) << 8) | (rows[2 * at + 1] as number));
  const perByte = 8 / depth;
  const stride = rows.length / height;
  return Uint8Array.from({ length: width * height }, (_, at) => {
    const x = at % width;
    const byte = rows[Math.floor(at / width) * stride + Math.floor(x / perByte)] as number;
    return (byte >> (8 - depth * ((x % perByte) + 1))) & ((1 << depth) - 1);
  });
}

function unreadable(reason: string): VeroneseError {
  return new VeroneseError('unreadable-image', reason);
}

function damaged(): VeroneseError {
  return unreadable('it is damaged');
}

/** Each is its length, its name, as many bytes, and a checksum; the data have one of their own. */
function* chunks(file: Uint8Array): Generator<{ name: string; content: Uint8Array }, void, undefined> {
  const view = viewOf(file);
  for (let at = SIGNATURE.length; at + 12 <= file.length;) {
    const length = view.getUint32(at);
    yield { name: String.fromCharCode(...file.subarray(at + 4, at + 8)), content: file.subarray(at + 8, at + 8 + length) };
    at += 12 + length;
  }
}

/** The content of a zlib stream in pieces. Throws `unreadable-image` where that is more than `most` bytes, or damaged. */
function inflated(data: readonly Uint8Array[], most: number): Uint8Array {
  const whole = new Uint8Array(most);
  let filled = 0;
  const inflater = new Unzlib((piece) => {
    whole.set(piece, filled);
    filled += piece.length;
  });
  try {
    for (const content of data) for (let at = 0; at < content.length; at += PIECE) inflater.push(content.subarray(at, at + PIECE));
    inflater.push(new Uint8Array(), true);
  } catch {
    // Cut off, damaged, or longer than the place for it.
    throw damaged();
  }
  return whole.subarray(0, filled);
}

/** Every row begins with the number of its filter, which adds what stands to the left, above or both; `step` bytes are a pixel. */
function unfiltered(rows: Uint8Array, width: number, height: number, step: number): Uint8Array {
  const bytes = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) {
    const from = y * (width + 1);
    const filter = rows[from] as number;
    if (filter > 4) throw damaged();
    const start = y * width;
    for (let x = 0; x < width; x++) {
      const left = x >= step ? (bytes[start + x - step] as number) : 0;
      const above = y > 0 ? (bytes[start + x - width] as number) : 0;
      const corner = x >= step && y > 0 ? (bytes[start + x - width - step] as number) : 0;
      // Assignment keeps the lowest eight bits.
      bytes[start + x] = (rows[from + 1 + x] as number) + predicted(filter, left, above, corner);
    }
  }
  return bytes;
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
