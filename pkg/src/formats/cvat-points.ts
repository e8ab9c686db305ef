// Shapes as CVAT's REST interface and SDK take them: row-major runs over the box, then its corners, both inclusive.

import type { CvatShape, FormatMeta } from '../../types/formats.js';
import { masksOf } from './input.js';
import { rowRuns } from './runs.js';

export function encodeCvatPoints(labels: Uint8Array, width: number, height: number, meta: FormatMeta = {}): CvatShape[] {
  return masksOf(labels, width, height, meta).map(({ name, left, top, width, height, pixels }) => ({
    type: 'mask',
    label: name,
    frame: 0,
    occluded: false,
    source: 'auto',
    points: [...rowRuns(pixels), left, top, left + width - 1, top + height - 1],
  }));
}
