//! Labels to colours: the fill and the outlines of the masks, one RGBA word per pixel. 0 is the background: it is not painted, so
//! that the picture keeps its colours. No canvas is needed, so painting can be tested in Node and done in pieces.

import { type Labels, UNLABELLED } from '../result/masks.js';
import { UNKNOWN_COLOUR, type Colour, colourOf, wordFromColour } from './palette.js';

/** The choices that decide how labels are painted. */
export interface Painting {
  readonly hidden: ReadonlySet<number>;
  /** The only mask shown, if any. */
  readonly solo: number | null;
  /** Colours that the user gave to masks, by number. */
  readonly colours: Readonly<Record<number, Colour>>;
}

export function isShown(mask: number, { hidden, solo }: Pick<Painting, 'hidden' | 'solo'>): boolean {
  return solo === null ? !hidden.has(mask) : solo === mask;
}

/** The colour of a mask: the user's, or that of the palette. */
export function colourOfMask(mask: number, { colours }: Pick<Painting, 'colours'>): Colour {
  return colours[mask] ?? (mask === UNLABELLED ? UNKNOWN_COLOUR : colourOf(mask));
}

/** The RGBA word of each label; 0 (transparent) for the background and for what is hidden. */
export function wordsByLabel(painting: Painting): Uint32Array {
  return Uint32Array.from({ length: 256 }, (_, label) => (label !== 0 && isShown(label, painting) ? wordFromColour(colourOfMask(label, painting)) : 0));
}

/** Rows `from` to `to` of the fill: each pixel has the opaque colour of its mask, or is transparent. */
export function fillOf({ labels, width, height }: Labels, painting: Painting, from = 0, to = height): Uint32Array<ArrayBuffer> {
  const words = wordsByLabel(painting);
  const pixels = new Uint32Array((to - from) * width);
  for (let i = 0, p = from * width; i < pixels.length; i++, p++) pixels[i] = words[labels[p]!]!;
  return pixels;
}

/** The line of an outline is lighter than the fill: the share of white mixed into the colour of the mask. */
const LIGHTER = 0.45;
/** Its edge, nearly black. */
const EDGE = 0xe018_1210; // little-endian RGBA

function lighter(word: number): number {
  const channel = (shift: number): number => {
    const value = (word >>> shift) & 255;
    return Math.round(value + (255 - value) * LIGHTER) << shift;
  };
  return word === 0 ? 0 : ((255 << 24) | channel(16) | channel(8) | channel(0)) >>> 0;
}

/**
 * Rows `from` to `to` of the outlines, inside the masks: along every border a dark edge and next to it a light line, each `thickness` pixels
 * wide along rows and columns. One of the two stands out from any picture, and the edges part masks that touch without relying on hue.
 */
export function outlinesOf({ labels, width, height }: Labels, painting: Painting, thickness: number, from = 0, to = height): Uint32Array<ArrayBuffer> {
  const lines = wordsByLabel(painting).map(lighter);
  const first = from * width;
  const pixels = new Uint32Array((to - from) * width);
  const reach = 2 * thickness;
  /** Paints up to `limit` pixels from `start` on, until the mask ends. */
  const paint = (start: number, step: number, limit: number): void => {
    const line = lines[labels[start]!]!;
    if (line === 0) return;
    const own = labels[start]!;
    for (let k = 0, i = start; k < limit && labels[i] === own; k++, i += step) {
      if (i < first || i - first >= pixels.length) continue;
      if (k < thickness) pixels[i - first] = EDGE;
      else if (pixels[i - first] === 0) pixels[i - first] = line;
    }
  };
  // Borders just above and below reach into these rows.
  const [top, bottom] = [Math.max(0, from - reach), Math.min(height, to + reach)];
  for (let y = top, i = top * width; y < bottom; y++) {
    for (let x = 0; x < width; x++, i++) {
      const own = labels[i];
      if (x > 0 && labels[i - 1] !== own) {
        paint(i, 1, Math.min(reach, width - x));
        paint(i - 1, -1, Math.min(reach, x));
      }
      if (y > 0 && labels[i - width] !== own) {
        paint(i, width, Math.min(reach, height - y));
        paint(i - width, -width, Math.min(reach, y));
      }
    }
  }
  return pixels;
}
