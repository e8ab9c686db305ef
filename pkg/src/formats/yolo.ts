// YOLO segmentation: one line per label, its class and one ring in shares of the image's sides.

import type { FormatMeta, YoloFiles } from '../../types/formats.js';
import { checkedOptions, masksOf } from './input.js';
import { Outlines } from './outline.js';

/** Enough for an error far below a thousandth of a pixel. */
const DECIMALS = 8;

export function encodeYolo(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: { tolerance?: number },
): YoloFiles {
  const { tolerance } = checkedOptions(options, []);
  const masks = masksOf(labels, width, height, meta);
  const outlines = new Outlines(tolerance);
  const [shareX, shareY] = [shares(width), shares(height)];
  const rings = masks.map((mask) => outlines.single(mask));
  const lines = rings.map((ring, index) => {
    return `${index} ${ring.map((value, at) => (at % 2 === 0 ? shareX : shareY)[value]).join(' ')}\n`;
  });
  return { text: lines.join(''), names: masks.map(({ name }) => name) };
}

/** What the whole numbers up to a side are of it, as text: once each and not for every vertex. */
function shares(side: number): string[] {
  return Array.from({ length: side + 1 }, (_, value) => String(Number((value / side).toFixed(DECIMALS))));
}
