// Colours of labels: the palette of the DAVIS benchmark, which annotation tools know from indexed PNG masks.

import type { Colour } from '../../types/index.js';
import { isListOf, isNumber } from './checks.js';
import { VeroneseError } from './errors.js';

/** Number of colours that DAVIS takes from the PASCAL VOC pattern; grey levels follow. */
const PATTERNED = 22;

/**
 * The 256 colours. VOC spreads the bits of the index over the three channels, three bits at a time from the highest bit
 * down; DAVIS has 191 where that gives 192, and (k, k, k) from index 22 on.
 */
export function davisPalette(): [number, number, number][] {
  return Array.from({ length: 256 }, (_, index) => {
    if (index >= PATTERNED) return [index, index, index];
    const channel = (shift: number) => {
      const value = (((index >> shift) & 1) << 7) | (((index >> (shift + 3)) & 1) << 6);
      return value === 192 ? 191 : value;
    };
    return [channel(0), channel(1), channel(2)];
  });
}

/** Colours as bytes, one after another: three each, or four with alpha (255 where a colour has none). Throws `invalid-option`. */
export function colourBytes(colours: unknown, channels: 3 | 4): Uint8Array {
  if (!isListOf(colours, isColour)) {
    throw new VeroneseError('invalid-option', "option 'palette': must be a list of colours, each three or four numbers from 0 to 255");
  }
  const bytes = new Uint8ClampedArray(colours.length * channels);
  colours.forEach((colour, index) => {
    bytes.set(colour.slice(0, channels), index * channels);
    if (channels === 4 && colour.length === 3) bytes[index * channels + 3] = 255;
  });
  return new Uint8Array(bytes.buffer);
}

function isColour(value: unknown): value is Colour {
  return isListOf(value, isNumber) && (value.length === 3 || value.length === 4) && value.every((level) => level >= 0 && level <= 255);
}
