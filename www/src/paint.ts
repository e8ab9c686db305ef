//! Labels to colours: the fill and the outlines of the masks, one RGBA word per pixel. No canvas here, so that it can be tested
//! and moved to a worker.

import type { Segmentation } from 'veronese';
import { UNKNOWN_COLOUR, colourOf, wordFromColour } from './palette.js';
import type { Look } from './state.js';

export const UNLABELLED = 255;

/** What decides how labels are painted. */
export type Painting = Pick<Look, 'colouring' | 'hidden' | 'solo'>;

/** The number whose colour a label bears: its own, or its group's. */
export function classOf(label: number, segmentation: Segmentation, colouring: Look['colouring']): number {
  return colouring === 'groups' ? (segmentation.motions[label]?.group ?? label) : label;
}

export function isShown(label: number, { hidden, solo }: Pick<Look, 'hidden' | 'solo'>): boolean {
  return solo === null ? !hidden.has(label) : solo === label;
}

/** The RGBA word of every label; 0, transparent, for one that is not shown. */
function wordsByLabel(segmentation: Segmentation, painting: Painting): Uint32Array {
  const words = new Uint32Array(256);
  for (const { label } of segmentation.motions) {
    if (isShown(label, painting)) words[label] = wordFromColour(colourOf(classOf(label, segmentation, painting.colouring)));
  }
  if (isShown(UNLABELLED, painting)) words[UNLABELLED] = wordFromColour(UNKNOWN_COLOUR);
  return words;
}

/** Every pixel in the colour of its label, opaque, or fully transparent. */
export function fillOf(segmentation: Segmentation, painting: Painting): Uint32Array<ArrayBuffer> {
  const words = wordsByLabel(segmentation, painting);
  const { labels } = segmentation;
  const pixels = new Uint32Array(labels.length);
  for (let i = 0; i < labels.length; i++) pixels[i] = words[labels[i]!]!;
  return pixels;
}

/** How light an outline is drawn: the mask's colour, this far on the way to white, so that it stands out from the fill. */
const LIGHTER = 0.45;

function lighter(word: number): number {
  const channel = (shift: number): number => {
    const value = (word >>> shift) & 255;
    return Math.round(value + (255 - value) * LIGHTER) << shift;
  };
  return word === 0 ? 0 : ((255 << 24) | channel(16) | channel(8) | channel(0)) >>> 0;
}

/**
 * The rim of every shown mask: its pixels that touch, within `thickness` pixels along a row or column, a pixel of another colour.
 * The largest motion gets none: its rim would run along all the others'.
 */
export function outlinesOf(segmentation: Segmentation, painting: Painting, thickness: number): Uint32Array<ArrayBuffer> {
  const words = wordsByLabel(segmentation, painting);
  const classes = Uint8Array.from({ length: 256 }, (_, label) => classOf(label, segmentation, painting.colouring));
  const rims = words.map((word, label) => (classes[label] === 0 && painting.solo === null ? 0 : lighter(word)));
  const { labels, width, height } = segmentation;
  const pixels = new Uint32Array(labels.length);
  /** Paints from `start` on, as long as the colour stays and `limit` allows. */
  const paint = (start: number, step: number, limit: number): void => {
    const own = classes[labels[start]!];
    for (let k = 0, i = start; k < limit && classes[labels[i]!] === own; k++, i += step) pixels[i] = rims[labels[i]!]!;
  };
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i++) {
      const own = classes[labels[i]!];
      if (x > 0 && classes[labels[i - 1]!] !== own) {
        paint(i, 1, Math.min(thickness, width - x));
        paint(i - 1, -1, Math.min(thickness, x));
      }
      if (y > 0 && classes[labels[i - width]!] !== own) {
        paint(i, width, Math.min(thickness, height - y));
        paint(i - width, -width, Math.min(thickness, y));
      }
    }
  }
  return pixels;
}
