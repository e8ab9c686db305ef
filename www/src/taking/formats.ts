//! What can be taken away, as data: the menu is drawn from it, and each entry makes its file.

import { type Segmentation, groupLabels } from 'veronese';
import { type Mask, UNLABELLED, masksOf } from '../masks.js';
import { nameOf } from '../naming.js';
import { colourOfMask } from '../paint.js';
import type { Colour } from '../palette.js';
import type { Look, Result } from '../state.js';
import { ANNOTATIONS } from './annotations.js';
import { overlayPicture } from './overlay.js';
import { pngFromGrey, pngFromLabels } from './png.js';
import { atSize } from './full-size.js';
import { zipped } from './zip.js';

/** A result as it is taken away. */
export interface Taking {
  readonly result: Result;
  readonly look: Look;
  /** At the size of the file. */
  readonly segmentation: Segmentation;
  /** The number of each pixel's mask, {@link UNLABELLED} for none. */
  readonly labels: Uint8Array;
  readonly masks: readonly (Mask & { readonly name: string; readonly colour: Colour })[];
  /** Name of the first frame's file. */
  readonly image: string;
}

export interface Format {
  readonly id: string;
  readonly title: string;
  readonly file: string;
  readonly type: string;
  /** Who would want it. */
  readonly hint: string;
  make(taking: Taking): Promise<string | Uint8Array<ArrayBuffer> | Blob>;
}

export function takingOf(result: Result, look: Look): Taking {
  const segmentation = atSize(result.segmentation, result.pair.first.full);
  const labels = look.kind === 'groups' ? groupLabels(segmentation) : segmentation.labels;
  const masks = masksOf(segmentation, look.kind)
    .filter(({ id }) => id !== UNLABELLED)
    .map((mask) => ({ ...mask, name: nameOf(look, mask.id), colour: colourOfMask(mask.id, look) }));
  return { result, look, segmentation, labels, masks, image: result.pair.first.name };
}

/** 255 where the mask is, 0 elsewhere. */
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
  hint: 'Indexed, palette index = mask, in the colours of DAVIS.',
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
  hint: 'A grey PNG for each mask, the labels and the result.',
  async make(taking) {
    const { labels, segmentation, masks } = taking;
    const { width, height } = segmentation;
    const files: Record<string, Uint8Array> = {};
    for (const { id } of masks) files[`mask-${id}.png`] = await pngFromGrey(grey(labels, id), width, height);
    files[LABELS.file] = (await LABELS.make(taking)) as Uint8Array;
    files[RESULT.file] = new TextEncoder().encode((await RESULT.make(taking)) as string);
    return zipped(files);
  },
};

export const MASK: Format = {
  id: 'mask',
  title: 'The chosen mask',
  file: 'mask.png',
  type: PNG,
  hint: 'A grey PNG: white where the mask is that is chosen in the list.',
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
  hint: 'The first frame with its masks as they are shown.',
  make: ({ result, look }) => overlayPicture(result, look),
};

/** In the order of the menu. */
export const FORMATS: readonly Format[] = [LABELS, MASK, MASKS, OVERLAY, RESULT, ...ANNOTATIONS];
