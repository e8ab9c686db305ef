//! The colours of the masks, as the package has them. Grey is for the background, which is not painted: it is the colour of its arrows and strokes.

import { objectColour } from 'veronese/colours';

/** Red, green, blue, 0…255. */
export type Colour = readonly [number, number, number];

const SLATE: Colour = [92, 99, 110];

/** The colour of each label up to 254. */
export const PALETTE: readonly Colour[] = Array.from({ length: 255 }, (_, label) => (label === 0 ? SLATE : objectColour(label)));

/** The colour of pixels without a label. */
export const UNKNOWN_COLOUR: Colour = [22, 22, 26];

export function colourOf(label: number): Colour {
  return PALETTE[label] ?? UNKNOWN_COLOUR;
}

export function cssColour([r, g, b]: Colour): string {
  return `rgb(${r} ${g} ${b})`;
}

/** The colour as one little-endian RGBA word of an `ImageData`, opaque. */
export function wordFromColour([r, g, b]: Colour): number {
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

/** `#rrggbb`, the value of a colour input. */
export function hexColour(colour: Colour): string {
  return `#${colour.map((channel) => channel.toString(16).padStart(2, '0')).join('')}`;
}

export function colourFromHex(hex: string): Colour {
  const value = Number.parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}
