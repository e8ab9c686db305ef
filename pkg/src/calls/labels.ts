// Label images, and pictures made of them. All row by row, one label per pixel.

import type { Segmentation } from '../../types/index.js';
import { checkedBytes, invalidInput, isListOf, isObject, isWhole, reading, UNLABELLED } from '../common/checks.js';
import { davisPalette } from '../common/palette.js';

/** Throws `invalid-input`. */
export function groupLabels(segmentation: Pick<Segmentation, 'labels' | 'motions'>): Uint8Array {
  return reading(() => {
    const { labels, motions } = Object(segmentation) as Partial<Segmentation>;
    if (!isListOf(motions, isGrouped)) throw invalidInput(`the motions must each have a label and a group from 0 to ${UNLABELLED - 1}`);
    const group = new Uint8Array(256).fill(UNLABELLED);
    for (const motion of motions) group[motion.label] = motion.group;
    const grouped = new Uint8Array(checkedBytes('the labels', labels));
    grouped.forEach((label, pixel) => (grouped[pixel] = group[label] as number));
    return grouped;
  });
}

function isGrouped(value: unknown): value is Pick<Segmentation['motions'][number], 'label' | 'group'> {
  return isObject(value) && isWhole(value.label, 0, UNLABELLED - 1) && isWhole(value.group, 0, UNLABELLED - 1);
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
