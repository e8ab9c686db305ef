// YOLO segmentation: one line per label, its class and one ring in shares of the image's sides.

import type { FormatMeta, YoloFiles } from '../../types/formats.js';
import { checkedOptions, masksOf } from './input.js';
import { singleRing } from './outline.js';

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
  const lines = masks.map((mask, index) => {
    const shares = singleRing(mask, tolerance).map((value, at) => (value / (at % 2 === 0 ? width : height)).toFixed(DECIMALS));
    return `${index} ${shares.map((share) => Number(share)).join(' ')}\n`;
  });
  return { text: lines.join(''), names: masks.map(({ name }) => name) };
}
