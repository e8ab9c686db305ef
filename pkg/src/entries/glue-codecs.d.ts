// The glue of the build with codecs: everything of the others, and files.

import type { PointsGlue } from '../module/glue-points.js';
import type { FramesGlue } from '../module/glue.js';

export interface CodecsGlue extends FramesGlue, PointsGlue {
  decodeImage(file: Uint8Array, allowDamaged: boolean, range: Uint16Array, large: boolean): unknown;
  encodeIndexedPng(width: number, height: number, indices: Uint8Array, palette: Uint8Array): Uint8Array;
  encodeGreyPng(width: number, height: number, grey: Uint8Array): Uint8Array;
  encodeColourPng(width: number, height: number, pixels: Uint8Array): Uint8Array;
}

export const glue: CodecsGlue;
