// Image files under Node: the WebAssembly build that has everything of the others and reads and writes files.

import { glue } from './glue-codecs.js';
import type { Picture } from '../types/codecs.js';
import { Api } from './api.js';
import { Core } from './core.js';
import { VeroneseError } from './errors.js';
import { colourBytes } from './palette.js';
import { read } from './reading.js';

/** The build's own core, for threads that share its compiled module. */
export const core = new Core(glue, read, new URL('../wasm/codecs/veronese_codecs_bg.wasm', import.meta.url));

/** The calls of the package on this build: what decodes also segments, so the command line loads one module only. */
export const api = new Api(core, core);

export async function decodeImage(file: Uint8Array): Promise<Picture> {
  const bytes = checkedBytes('the file', file);
  return (await core.call((glue) => glue.decodeImage(bytes))) as Picture;
}

export async function encodeIndexedPng(
  width: number,
  height: number,
  indices: Uint8Array,
  palette: readonly (readonly [number, number, number])[],
): Promise<Uint8Array> {
  checkedSize(width, height);
  const bytes = checkedBytes('the indices', indices);
  return core.call((glue) => glue.encodeIndexedPng(width, height, bytes, colourBytes(palette, 3)));
}

export async function encodeGreyPng(width: number, height: number, grey: Uint8Array): Promise<Uint8Array> {
  checkedSize(width, height);
  const bytes = checkedBytes('the pixels', grey);
  return core.call((glue) => glue.encodeGreyPng(width, height, bytes));
}

export async function encodeColourPng(width: number, height: number, pixels: Uint8Array): Promise<Uint8Array> {
  checkedSize(width, height);
  const bytes = checkedBytes('the pixels', pixels);
  return core.call((glue) => glue.encodeColourPng(width, height, bytes));
}

function checkedBytes(which: string, bytes: Uint8Array): Uint8Array {
  if (ArrayBuffer.isView(bytes)) return new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  throw new VeroneseError('invalid-input', `${which} must be a Uint8Array`);
}

function checkedSize(width: number, height: number): void {
  if (Number.isInteger(width) && Number.isInteger(height) && width > 0 && height > 0) return;
  throw new VeroneseError('invalid-input', 'width and height must be whole numbers of pixels');
}
