//! Labels to colours: the fill and the outlines of the masks, one RGBA word per pixel. Mask 0 is the background: it is not painted, so
//! that the picture keeps its colours. No canvas is needed, so painting can be tested in Node and done in pieces.

import type { Segmentation } from 'veronese';
import { UNLABELLED, type Kind, keyOf, maskTable } from '../result/masks.js';
import { UNKNOWN_COLOUR, type Colour, colourOf, wordFromColour } from './palette.js';

/** The choices that decide how labels are painted. */
export interface Painting {
  readonly kind: Kind;
  readonly hidden: ReadonlySet<number>;
  /** The only mask shown, if any. */
  readonly solo: number | null;
  /** Colours that the user gave to masks, by `keyOf`. */
  readonly colours: Readonly<Record<string, Colour>>;
}

export function isShown(mask: number, { hidden, solo }: Pick<Painting, 'hidden' | 'solo'>): boolean {
  return solo === null ? !hidden.has(mask) : solo === mask;
}

/** The colour of a mask: the user's, or that of the palette. */
export function colourOfMask(mask: number, { kind, colours }: Pick<Painting, 'kind' | 'colours'>): Colour {
  return colours[keyOf(kind, mask)] ?? (mask === UNLABELLED ? UNKNOWN_COLOUR : colourOf(mask));
}

/** The RGBA word of each label; 0 (transparent) for the background and for what is hidden. */
export function wordsByLabel(segmentation: Segmentation, painting: Painting): Uint32Array {
  const masks = maskTable(segmentation, painting.kind);
  const words = new Uint32Array(256);
  for (const label of [...segmentation.motions.map((motion) => motion.label), UNLABELLED]) {
    const mask = masks[label]!;
    if (mask !== 0 && isShown(mask, painting)) words[label] = wordFromColour(colourOfMask(mask, painting));
  }
  return words;
}

/** Rows `from` to `to` of the fill: each pixel has the opaque colour of its mask, or is transparent. */
export function fillOf(segmentation: Segmentation, painting: Painting, from = 0, to = segmentation.height): Uint32Array<ArrayBuffer> {
  const words = wordsByLabel(segmentation, painting);
  const { labels, width } = segmentation;
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
export function outlinesOf(
  segmentation: Segmentation,
  painting: Painting,
  thickness: number,
  from = 0,
  to = segmentation.height,
): Uint32Array<ArrayBuffer> {
  const masks = maskTable(segmentation, painting.kind);
  const lines = wordsByLabel(segmentation, painting).map(lighter);
  const { labels, width, height } = segmentation;
  const first = from * width;
  const pixels = new Uint32Array((to - from) * width);
  const reach = 2 * thickness;
  /** Paints up to `limit` pixels from `start` on, until the mask ends. */
  const paint = (start: number, step: number, limit: number): void => {
    const line = lines[labels[start]!]!;
    if (line === 0) return;
    const own = masks[labels[start]!];
    for (let k = 0, i = start; k < limit && masks[labels[i]!] === own; k++, i += step) {
      if (i < first || i - first >= pixels.length) continue;
      if (k < thickness) pixels[i - first] = EDGE;
      else if (pixels[i - first] === 0) pixels[i - first] = line;
    }
  };
  // Borders just above and below reach into these rows.
  const [top, bottom] = [Math.max(0, from - reach), Math.min(height, to + reach)];
  for (let y = top, i = top * width; y < bottom; y++) {
    for (let x = 0; x < width; x++, i++) {
      const own = masks[labels[i]!];
      if (x > 0 && masks[labels[i - 1]!] !== own) {
        paint(i, 1, Math.min(reach, width - x));
        paint(i - 1, -1, Math.min(reach, x));
      }
      if (y > 0 && masks[labels[i - width]!] !== own) {
        paint(i, width, Math.min(reach, height - y));
        paint(i - width, -width, Math.min(reach, y));
      }
    }
  }
  return pixels;
}
