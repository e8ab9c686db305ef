// A COCO instances file. Polygons are filled ring by ring and united there: holes hang on their outline by a bridge.

import type { CocoDocument, FormatMeta, FormatOptions } from '../../types/formats.js';
import { cocoRle } from './coco-rle.js';
import { checkedOptions, imageOf, type Mask, masksOf } from './input.js';
import { Outlines } from './outline.js';

export function encodeCoco(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: FormatOptions<'rle' | 'polygon'>,
): CocoDocument {
  const { shape, tolerance } = checkedOptions(options, ['rle', 'polygon']);
  const masks = masksOf(labels, width, height, meta);
  const outlines = new Outlines(tolerance);
  return {
    info: { description: 'Masks of what moves together' },
    images: [{ id: 1, file_name: imageOf(meta), width, height }],
    categories: cocoCategories(masks),
    annotations: masks.map((mask, index) => ({
      id: index + 1,
      image_id: 1,
      category_id: mask.label + 1,
      iscrowd: 0,
      area: mask.area,
      bbox: [mask.left, mask.top, mask.width, mask.height],
      segmentation: shape === 'rle' ? cocoRle(mask, width, height) : outlines.bridged(mask),
      ...(mask.motion && { attributes: { matrix: mask.motion.matrix } }),
    })),
  };
}

/** COCO counts from 1: label 0 is category 1. */
export function cocoCategories(masks: readonly Mask[]): { id: number; name: string }[] {
  return masks.map(({ label, name }) => ({ id: label + 1, name }));
}
