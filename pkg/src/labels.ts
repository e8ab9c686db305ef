// Label images, and pictures made of them. All row by row, one label per pixel.

import type { Segmentation } from '../types/index.js';
import { davisPalette } from './palette.js';

const UNLABELLED = 255;

export function groupLabels({ labels, motions }: Pick<Segmentation, 'labels' | 'motions'>): Uint8Array {
  const group = Uint8Array.from({ length: 256 }, () => UNLABELLED);
  for (const motion of motions) group[motion.label] = motion.group;
  return labels.map((label) => group[label] ?? UNLABELLED);
}

/** 255 where the pixel has the label, 0 elsewhere. */
export function maskOf(labels: Uint8Array, wanted: number): Uint8Array {
  return labels.map((label) => (label === wanted ? 255 : 0));
}

/**
 * RGB of the frame with every label but 0 tinted half and half in its colour; the dominant motion is left as it is, so that
 * what stands out is what moves.
 */
export function overlay(rgba: Uint8Array, labels: Uint8Array): Uint8Array {
  const palette = davisPalette();
  const rgb = new Uint8Array(labels.length * 3);
  labels.forEach((label, pixel) => {
    const colour = label === 0 ? undefined : palette[label];
    for (let channel = 0; channel < 3; channel++) {
      const value = rgba[pixel * 4 + channel] ?? 0;
      rgb[pixel * 3 + channel] = colour ? (value + (colour[channel] ?? 0)) >> 1 : value;
    }
  });
  return rgb;
}
