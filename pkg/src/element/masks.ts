// Label images in little memory, and as PNG files. Compressed by the browser: the element needs no encoder of its own.

import { davisPalette } from '../common/palette.js';
import { pngFile } from '../formats/png-file.js';

export interface Packed {
  width: number;
  height: number;
  /** The rows of a PNG, each after a byte for its filter, compressed. */
  rows: Uint8Array<ArrayBuffer>;
}

export async function packed(labels: Uint8Array, width: number, height: number): Promise<Packed> {
  const rows = new Uint8Array((width + 1) * height);
  for (let y = 0; y < height; y++) rows.set(labels.subarray(y * width, (y + 1) * width), y * (width + 1) + 1);
  return { width, height, rows: await through(new CompressionStream('deflate'), rows) };
}

export async function unpacked({ width, height, rows }: Packed): Promise<Uint8Array> {
  const bytes = await through(new DecompressionStream('deflate'), rows);
  const labels = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) labels.set(bytes.subarray(y * (width + 1) + 1, (y + 1) * (width + 1)), y * width);
  return labels;
}

/** An indexed PNG whose indices are the labels, with the DAVIS palette. */
export function fileOf({ width, height, rows }: Packed, name: string): File {
  const bytes = pngFile(width, height, rows, { palette: Uint8Array.from(davisPalette().flat()) });
  return new File([bytes], name, { type: 'image/png' });
}

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}
