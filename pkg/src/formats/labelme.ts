// LabelMe: shapes of type mask are a PNG of the box, its corners inclusive; polygons are one per connected part.

import type { FormatMeta, FormatOptions, LabelMeDocument, LabelMeShape } from '../../types/formats.js';
import { base64 } from './base64.js';
import { checkedOptions, imageOf, type Mask, masksOf } from './input.js';
import { bridgedRings } from './outline.js';
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
  return {
    version: VERSION,
    flags: {},
    shapes: masks.flatMap((mask) => (shape === 'mask' ? [maskShape(mask)] : polygonShapes(mask, tolerance))),
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

function polygonShapes({ label, name, ...mask }: Mask, tolerance: number): LabelMeShape[] {
  return bridgedRings({ label, name, ...mask }, tolerance).map((ring) => ({
    label: name,
    points: ring.flatMap((x, at): [number, number][] => (at % 2 === 0 ? [[x, ring[at + 1] as number]] : [])),
    group_id: label,
    description: '',
    shape_type: 'polygon',
    flags: {},
    mask: null,
  }));
}
