// "CVAT for images 1.1": one image with a <mask> or <polygon> per part.

import type { FormatMeta, FormatOptions } from '../../types/formats.js';
import { checkedOptions, imageOf, type Mask, masksOf } from './input.js';
import { Outlines, points } from './outline.js';
import { rowRuns } from './runs.js';
import { escaped } from './xml.js';

export function encodeCvatXml(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: FormatOptions<'mask' | 'polygon'>,
): string {
  const { shape, tolerance } = checkedOptions(options, ['mask', 'polygon']);
  const masks = masksOf(labels, width, height, meta);
  const outlines = new Outlines(tolerance);
  const shapes = masks.flatMap((mask) => (shape === 'mask' ? [maskElement(mask)] : polygonElements(mask, outlines)));
  return [
    '<?xml version="1.0" encoding="utf-8"?>',
    '<annotations>',
    '  <version>1.1</version>',
    '  <meta>',
    '    <task>',
    '      <size>1</size>',
    '      <mode>annotation</mode>',
    '      <labels>',
    ...masks.map(({ name }) => `        <label><name>${escaped(name)}</name><attributes></attributes></label>`),
    '      </labels>',
    '    </task>',
    '  </meta>',
    `  <image id="0" name="${escaped(imageOf(meta))}" width="${width}" height="${height}">`,
    ...shapes,
    '  </image>',
    '</annotations>',
    '',
  ].join('\n');
}

function maskElement({ name, left, top, width, height, pixels }: Mask): string {
  const box = `left="${left}" top="${top}" width="${width}" height="${height}"`;
  return `    <mask label="${escaped(name)}" source="auto" occluded="0" rle="${rowRuns(pixels).join(', ')}" ${box} z_order="0"></mask>`;
}

/** One polygon for each connected part, all of one group. */
function polygonElements(mask: Mask, outlines: Outlines): string[] {
  const parts = outlines.bridged(mask);
  const group = parts.length > 1 ? ` group_id="${mask.label + 1}"` : '';
  return parts.map((ring) => {
    const vertices = points(ring).map(([x, y]) => `${x}.00,${y}.00`);
    const rest = `source="auto" occluded="0" points="${vertices.join(';')}" z_order="0"${group}`;
    return `    <polygon label="${escaped(mask.name)}" ${rest}></polygon>`;
  });
}
