// Given masks in the forms that they come in: labels, pictures of labels, PNG files, run lengths. Loaded when there are some.

import type { LabelImage } from '../../../types/formats.js';
import { VeroneseError } from '../../common/errors.js';
import { labelsOfPixels, labelsOfPng, labelsOfRle } from '../../formats/reading/mask.js';
import { isObjectNumber, RANGE } from './edits.js';
import { bytesOf, checkedList, type LabelledFrame, type Wrong } from './annotations.js';

/** Masks of single objects in one frame become one. */
export function checkedMasks(masks: unknown, length: number): LabelledFrame[] {
  return checkedList('masks', '{ frame, labels }, { frame, png } or { frame, id, rle }', masks, length, (entry, wrong, before) => {
    const { id, rle, png } = entry;
    if (rle !== undefined) {
      if (!isObjectNumber(id)) throw wrong(`must have an id, ${RANGE}`);
      return over(before, placed('', wrong, () => labelsOfRle(rle, id)), wrong);
    }
    if (png !== undefined) {
      const bytes = bytesOf(png, 'png', wrong);
      return placed('has a png that ', wrong, () => labelsOfPng(bytes));
    }
    const { data, width, height } = Object(entry['labels']) as Record<string, unknown>;
    if (data === undefined) return { labels: bytesOf(entry['labels'], 'labels', wrong) };
    const bytes = bytesOf(data, 'pixels', wrong);
    return placed('', wrong, () => labelsOfPixels(bytes, width, height));
  });
}

/** What goes wrong is wrong with the entry. */
function placed<T>(what: string, wrong: Wrong, read: () => T): T {
  try {
    return read();
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw wrong(`${what}${thrown.message}`);
    throw thrown;
  }
}

/** The mask of an object over those of others in the same frame. */
function over(before: LabelledFrame | undefined, { labels, width }: LabelImage, wrong: Wrong): Omit<LabelledFrame, 'frame'> {
  if (!before) return { labels, width };
  if ((before.width ?? width) !== width || before.labels.length !== labels.length) throw wrong(`has another size than the mask of frame ${before.frame} before it`);
  return { labels: before.labels.map((label, at) => labels[at] || label), width };
}
