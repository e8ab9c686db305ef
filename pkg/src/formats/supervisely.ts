// Supervisely: objects of type bitmap, each a compressed PNG of the box and the corner where it lies.

import { zlibSync } from 'fflate';
import type { FormatMeta, SuperviselyAnnotation } from '../../types/formats.js';
import { base64 } from './base64.js';
import { masksOf } from './input.js';
import { png } from './png.js';

/** Black and white, black transparent: readers take the alpha. */
const PALETTE = Uint8Array.of(0, 0, 0, 255, 255, 255);
const ALPHA = Uint8Array.of(0, 255);

export function encodeSupervisely(labels: Uint8Array, width: number, height: number, meta: FormatMeta = {}): SuperviselyAnnotation {
  const objects = masksOf(labels, width, height, meta).map(({ name, left, top, width, height, pixels }) => {
    const file = png(width, height, pixels, { palette: PALETTE, alpha: ALPHA });
    const bitmap = { data: base64(zlibSync(file)), origin: [left, top] as [number, number] };
    return { classTitle: name, geometryType: 'bitmap' as const, description: '', tags: [], bitmap };
  });
  return { description: '', tags: [], size: { height, width }, objects };
}
