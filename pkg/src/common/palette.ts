// Colours of labels: the palette of the DAVIS benchmark, which annotation tools know from indexed PNG masks.

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

/** Colours as bytes, three each, one after another. Throws `invalid-option`. */
export function colourBytes(colours: unknown): Uint8Array {
  if (!isListOf(colours, isColour)) {
    throw new VeroneseError('invalid-option', "option 'palette': must be a list of colours, each three numbers from 0 to 255");
  }
  return Uint8Array.from(Uint8ClampedArray.from(colours.flat()));
}

function isColour(value: unknown): value is number[] {
  return isListOf(value, isNumber) && value.length === 3 && value.every((level) => level >= 0 && level <= 255);
}
