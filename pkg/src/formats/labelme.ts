// LabelMe: shapes of type mask are a PNG of the box, its corners inclusive; polygons are one per connected part.

import type { FormatMeta, FormatOptions, LabelMeDocument, LabelMeShape } from '../../types/formats.js';
import { base64 } from './base64.js';
import { checkedOptions, imageOf, type Mask, masksOf } from './input.js';
import { Outlines, points, type Ring } from './outline.js';
import { png } from './png.js';

/** The release whose files these are. */
const VERSION = '5.8.1';

export function encodeLabelMe(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: FormatOptions<'mask' | 'polygon'>,
): LabelMeDocument {
  const { shape, tolerance } = checkedOptions(options, ['mask', 'polygon']);
  const masks = masksOf(labels, width, height, meta);
  const shapes = shape === 'mask' ? masks.map(maskShape) : polygonShapes(masks, new Outlines(tolerance).bridged({ masks, width, height }));
  return {
    version: VERSION,
    flags: {},
    shapes,
    imagePath: imageOf(meta),
    imageData: null,
    imageHeight: height,
    imageWidth: width,
  };
}

function maskShape({ label, name, left, top, width, height, pixels }: Mask): LabelMeShape {
  const corners: [number, number][] = [[left, top], [left + width - 1, top + height - 1]];
  const mask = base64(png(width, height, pixels.map((set) => set * 255)));
  return { label: name, points: corners, group_id: label, description: '', shape_type: 'mask', flags: {}, mask };
}

function polygonShapes(masks: readonly Mask[], parts: readonly Ring[][]): LabelMeShape[] {
  return masks.flatMap(({ name, label }, at) => {
    const shared = { label: name, group_id: label, description: '', shape_type: 'polygon' as const, flags: {}, mask: null };
    return (parts[at] as Ring[]).map((ring) => ({ ...shared, points: points(ring) }));
  });
}
