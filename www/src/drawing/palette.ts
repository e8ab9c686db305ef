//! The colours of the masks: first those of Okabe and Ito, then bright ones, each as far as it can be from all before it, also to eyes that lack
//! one kind of cone. Grey is for the background, which is not painted: it is the colour of its arrows and strokes.

/** Red, green, blue, 0…255. */
export type Colour = readonly [number, number, number];

/** The colour of each label. Labels beyond the end start again at 1. */
export const PALETTE: readonly Colour[] = [
  [92, 99, 110], // slate
  [240, 160, 0], // orange
  [86, 180, 233], // sky blue
  [214, 110, 175], // purple
  [0, 168, 120], // green
  [240, 228, 66], // yellow
  [213, 84, 0], // vermilion
  [0, 104, 190], // blue
  [236, 236, 236], // white
  [150, 105, 255], // violet
  [75, 225, 165], // mint
  [210, 195, 255], // lilac
  [255, 90, 105], // coral
  [165, 255, 165], // pale green
  [225, 0, 150], // magenta
  [105, 120, 210], // indigo
  [165, 195, 105], // sage
  [210, 150, 165], // rose
  [135, 150, 255], // cornflower
  [180, 150, 0], // gold
  [120, 210, 210], // aqua
];

/** The colour of pixels without a label. */
export const UNKNOWN_COLOUR: Colour = [22, 22, 26];

export function colourOf(label: number): Colour {
  const index = label < PALETTE.length ? label : 1 + ((label - 1) % (PALETTE.length - 1));
  return PALETTE[index] ?? UNKNOWN_COLOUR;
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
