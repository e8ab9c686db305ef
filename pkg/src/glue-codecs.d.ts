// The glue of the build with codecs: everything of the core, and files.

import type { CoreGlue } from './glue.js';

export interface CodecsGlue extends CoreGlue {
  decodeImage(file: Uint8Array): unknown;
  encodeIndexedPng(width: number, height: number, indices: Uint8Array, palette: Uint8Array): Uint8Array;
  encodeGreyPng(width: number, height: number, grey: Uint8Array): Uint8Array;
  encodeColourPng(width: number, height: number, pixels: Uint8Array): Uint8Array;
}

export const glue: CodecsGlue;
