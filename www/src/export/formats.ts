//! The export formats as data: the menu lists them, and each makes its file.

import { ANNOTATIONS } from './annotations.js';
import type { Format } from './format.js';
import { overlayPicture } from './overlay.js';
import { pngFromGrey, pngFromLabels } from './png.js';
import { zipped } from './zip.js';

/** 255 inside the mask, 0 elsewhere. */
function grey(labels: Uint8Array, id: number): Uint8Array {
  return labels.map((label) => (label === id ? 255 : 0));
}

const PNG = 'image/png';
const JSON_TYPE = 'application/json';

export const LABELS: Format = {
  id: 'labels',
  title: 'Labels PNG',
  file: 'labels.png',
  type: PNG,
  hint: 'Indexed: the palette index is the number of the mask. DAVIS palette.',
  make: ({ labels, segmentation }) => pngFromLabels(labels, segmentation.width, segmentation.height),
};

export const RESULT: Format = {
  id: 'result',
  title: 'Result JSON',
  file: 'result.json',
  type: JSON_TYPE,
  hint: 'Motions, evidence and settings, as the command line prints them.',
  make: async ({ segmentation: { labels: _, ...report } }) => `${JSON.stringify(report)}\n`,
};

export const MASKS: Format = {
  id: 'masks',
  title: 'All masks',
  file: 'masks.zip',
  type: 'application/zip',
  hint: 'A greyscale PNG of each mask, the labels, and of motions the result.',
  async make(exported) {
    const { labels, segmentation, masks } = exported;
    const { width, height } = segmentation;
    const files: Record<string, Uint8Array> = {};
    for (const { id } of masks) files[`mask-${id}.png`] = await pngFromGrey(grey(labels, id), width, height);
    files[LABELS.file] = (await LABELS.make(exported)) as Uint8Array;
    if (exported.look.kind !== 'objects') files[RESULT.file] = new TextEncoder().encode((await RESULT.make(exported)) as string);
    return zipped(files);
  },
};

export const MASK: Format = {
  id: 'mask',
  title: 'Selected mask',
  file: 'mask.png',
  type: PNG,
  hint: 'A greyscale PNG: the mask selected in the list is white.',
  make: ({ labels, segmentation, look, masks }) => {
    const id = look.selected ?? masks[1]?.id ?? 0;
    return pngFromGrey(grey(labels, id), segmentation.width, segmentation.height);
  },
};

export const OVERLAY: Format = {
  id: 'overlay',
  title: 'Overlay',
  file: 'overlay.png',
  type: PNG,
  hint: 'The frame with its masks as shown.',
  make: ({ result, look }) => overlayPicture(result, look),
};

/** In the order of the menu. */
export const FORMATS: readonly Format[] = [LABELS, MASK, MASKS, OVERLAY, RESULT, ...ANNOTATIONS];
