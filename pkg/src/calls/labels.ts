// Label images, row by row, one label per pixel.

import type { Segmentation } from '../../types/index.js';
import { checkedBytes, invalidInput, isListOf, isObject, isWhole, reading, UNLABELLED } from '../common/checks.js';

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
