//! PNG files that a canvas cannot write: indexed with the DAVIS palette, as the command line writes labels, and greyscale.

import { davisPalette } from 'veronese';

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];

/** The table of the CRC-32 of PNG (ISO 3309). */
const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb8_8320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});

function crc32(bytes: Uint8Array): number {
  let c = 0xffff_ffff;
  for (const byte of bytes) c = CRC_TABLE[(c ^ byte) & 255]! ^ (c >>> 8);
  return (c ^ 0xffff_ffff) >>> 0;
}

/** Length, type, content, checksum. */
function chunk(type: string, content: Uint8Array): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(content.length + 12);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, content.length);
  for (let i = 0; i < 4; i++) bytes[4 + i] = type.charCodeAt(i);
  bytes.set(content, 8);
  view.setUint32(8 + content.length, crc32(bytes.subarray(4, 8 + content.length)));
  return bytes;
}

/** An indexed PNG: the palette index is the label, the palette that of DAVIS. */
export function pngFromLabels(labels: Uint8Array, width: number, height: number): Promise<Uint8Array<ArrayBuffer>> {
  return png(labels, width, height, INDEXED, [chunk('PLTE', Uint8Array.from(davisPalette().flat()))]);
}

/** A greyscale PNG with 8 bits per pixel. */
export function pngFromGrey(grey: Uint8Array, width: number, height: number): Promise<Uint8Array<ArrayBuffer>> {
  return png(grey, width, height, GREY, []);
}

/** Colour types of PNG. */
const GREY = 0;
const INDEXED = 3;

async function png(bytes: Uint8Array, width: number, height: number, colourType: number, extra: Uint8Array[]): Promise<Uint8Array<ArrayBuffer>> {
  const header = new Uint8Array(13);
  const view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  header.set([8, colourType, 0, 0, 0], 8); // bit depth 8, deflate, adaptive filters, not interlaced
  const rows = new Uint8Array(height * (width + 1)); // each row starts with its filter type, 0: none
  for (let y = 0; y < height; y++) rows.set(bytes.subarray(y * width, (y + 1) * width), y * (width + 1) + 1);
  const deflated = new Blob([rows]).stream().pipeThrough(new CompressionStream('deflate'));
  const data = new Uint8Array(await new Response(deflated).arrayBuffer());
  const parts = [Uint8Array.from(SIGNATURE), chunk('IHDR', header), ...extra, chunk('IDAT', data), chunk('IEND', new Uint8Array())];
  return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
}
