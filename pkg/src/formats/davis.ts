// DAVIS: an 8-bit indexed PNG, the index is the label, in the palette of that benchmark.

import { colourBytes, davisPalette } from '../common/palette.js';
import { checkLabels } from './input.js';
import { png } from './png.js';

export function encodeDavis(labels: Uint8Array, width: number, height: number): Uint8Array {
  checkLabels(labels, width, height);
  return png(width, height, labels, { palette: colourBytes(davisPalette()) });
}
