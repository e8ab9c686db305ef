//! A format of the export menu, and the result that it is given.

import { type Segmentation, groupLabels } from 'veronese';
import { nameOf } from '../common/naming.js';
import { colourOfMask } from '../drawing/paint.js';
import type { Colour } from '../drawing/palette.js';
import { UNLABELLED, type Mask, masksOf } from '../result/masks.js';
import type { Look, Result } from '../state/state.js';
import { atSize } from './full-size.js';

/** Of polygons: the distance in pixels by which they may leave a mask's border, as of `veronese convert`. */
export const TOLERANCE = 0.5;

/** A result as it is exported. */
export interface Export {
  readonly result: Result;
  readonly look: Look;
  /** At the full size of the frames. */
  readonly segmentation: Segmentation;
  /** The number of each pixel's mask, {@link UNLABELLED} for none. */
  readonly labels: Uint8Array;
  readonly masks: readonly (Mask & { readonly name: string; readonly colour: Colour })[];
  /** The numbers of the masks that become annotations: all, but the background only if it is asked for. */
  readonly annotated: readonly number[];
  /** File name of the first frame. */
  readonly image: string;
}

export interface Format {
  readonly id: string;
  readonly title: string;
  readonly file: string;
  readonly type: string;
  /** A sentence about the file. */
  readonly hint: string;
  make(exported: Export): Promise<string | Uint8Array<ArrayBuffer> | Blob>;
}

/** Of objects those that are ticked. */
export function exportOf(result: Result, look: Look, background = false): Export {
  const segmentation = atSize(result.segmentation, result.pair.first.full);
  const isOut = (id: number): boolean => look.kind === 'objects' && look.hidden.has(id);
  const labels = look.kind === 'groups' ? groupLabels(segmentation) : segmentation.labels.map((label) => (isOut(label) ? 0 : label));
  const masks = masksOf(segmentation, look.kind)
    .filter(({ id }) => id !== UNLABELLED && !isOut(id))
    .map((mask) => ({ ...mask, name: nameOf(look, mask.id), colour: colourOfMask(mask.id, look) }));
  const annotated = masks.map(({ id }) => id).filter((id) => id > 0 || background);
  return { result, look, segmentation, labels, masks, annotated, image: result.pair.first.name };
}
