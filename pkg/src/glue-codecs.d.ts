// The glue of the build with codecs: everything of the others, and files.

import type { FramesGlue } from './glue.js';
import type { PointsGlue } from './glue-points.js';

export interface CodecsGlue extends FramesGlue, PointsGlue {
  decodeImage(file: Uint8Array): unknown;
  encodeIndexedPng(width: number, height: number, indices: Uint8Array, palette: Uint8Array): Uint8Array;
  encodeGreyPng(width: number, height: number, grey: Uint8Array): Uint8Array;
  encodeColourPng(width: number, height: number, pixels: Uint8Array): Uint8Array;
}

export const glue: CodecsGlue;
