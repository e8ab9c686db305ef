// Label images in little memory, and as PNG files. Compressed by the browser: the element needs no encoder of its own.

import { davisPalette } from '../common/palette.js';
import { pngFile, rowsOf, samplesIn } from '../formats/png-writer.js';

export interface Packed {
  width: number;
  height: number;
  /** The rows of a PNG, compressed. */
  rows: Uint8Array<ArrayBuffer>;
}

export async function packed(labels: Uint8Array, width: number, height: number): Promise<Packed> {
  return { width, height, rows: await through(new CompressionStream('deflate'), rowsOf(labels, width, height)) };
}

export async function unpacked({ width, height, rows }: Packed): Promise<Uint8Array> {
  return samplesIn(await through(new DecompressionStream('deflate'), rows), width, height);
}

/** An indexed PNG whose indices are the labels, with the DAVIS palette. */
export function fileOf({ width, height, rows }: Packed, name: string): File {
  const bytes = pngFile(width, height, rows, Uint8Array.from(davisPalette().flat()));
  return new File([bytes], name, { type: 'image/png' });
}

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}
