// Given masks in the forms that they come in: labels, pictures of labels, PNG files, run lengths. Loaded when there are some.

import { isListOf, isObject, isWhole, LONGEST_SIDE, UNLABELLED } from '../../common/checks.js';
import { veroneseError } from '../../common/errors.js';
import { davisPalette } from '../../common/palette.js';
import type { decodeIndices as Decode } from '../../formats/indexed-png.js';
import { decompressed } from '../../formats/reading/coco-rle.js';
import { checkCrisp, crispLevels } from '../../formats/reading/smoothed.js';
import { isObjectNumber, RANGE } from './edits.js';
import { bytesOf, checkedList, type LabelledFrame, type Wrong } from './annotations.js';

/** Masks of single objects in one frame become one. */
export async function checkedMasks(masks: unknown, length: number): Promise<LabelledFrame[]> {
  const isPng = ({ png }: Record<string, unknown>) => png !== undefined;
  // It needs an inflater, which not everybody has.
  const reader = isListOf(masks, isObject) && masks.some(isPng) ? await import('../../formats/indexed-png.js') : undefined;
  return checkedList('masks', '{ frame, labels }, { frame, png } or { frame, id, rle }', masks, length, (entry, wrong, before) => {
    if (entry['rle'] !== undefined) return withObject(entry, before, wrong);
    if (reader && isPng(entry)) return labelsOfPng(reader.decodeIndices, entry['png'], wrong);
    const { data, width, height } = Object(entry['labels']) as Record<string, unknown>;
    if (data === undefined) return { labels: bytesOf(entry['labels'], 'labels', wrong) };
    return { labels: labelsOfImage(data, width, height, wrong), width: width as number };
  });
}

function labelsOfPng(decodeIndices: typeof Decode, png: unknown, wrong: Wrong): Omit<LabelledFrame, 'frame'> {
  const bytes = bytesOf(png, 'png', wrong);
  try {
    const { indices, isGrey, width, height } = decodeIndices(bytes, { foreign: true });
    return { labels: isGrey ? crispLevels(indices, { width, height }, undefined) : indices, width };
  } catch (thrown) {
    throw wrong(`has a png that ${veroneseError(thrown).message}`);
  }
}

/** Grey levels if there is nothing else, otherwise indices of colours in the DAVIS palette. Transparent pixels have no label. */
function labelsOfImage(data: unknown, width: unknown, height: unknown, wrong: Wrong): Uint8Array {
  const rgba = bytesOf(data, 'pixels', wrong);
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE) || rgba.length !== 4 * width * height) {
    throw wrong('must have RGBA pixels that fill its width and height');
  }
  const byte = (p: number, channel: number) => rgba[4 * p + channel] as number;
  const colours = Int32Array.from({ length: width * height }, (_, p) => (byte(p, 3) === 0 ? -1 : numberOf([byte(p, 0), byte(p, 1), byte(p, 2)])));
  const greys = Array.from({ length: 256 }, (_, level) => numberOf([level, level, level]));
  const isGrey = colours.every((colour) => colour === -1 || colour === greys[colour & 255]);
  // Of colours that the palette has twice the lower index counts.
  const palette = isGrey ? greys : davisPalette().map(numberOf);
  if (isGrey) crisp(() => checkCrisp(colours.map((colour) => Math.max(0, colour) & 255), { width, height }, { channels: 1, ground: 0, white: UNLABELLED }), wrong);
  const labels = new Map(palette.map((colour, index) => [colour, index] as const).reverse()).set(-1, UNLABELLED);
  return Uint8Array.from(colours, (colour, p) => {
    const label = labels.get(colour);
    if (label !== undefined) return label;
    throw wrong(`has a pixel of a colour that is neither grey nor of the DAVIS palette, at ${p % width}, ${Math.floor(p / width)}`);
  });
}

function crisp(check: () => void, wrong: Wrong): void {
  try {
    check();
  } catch (thrown) {
    throw wrong(veroneseError(thrown).message);
  }
}

function numberOf([r, g, b]: readonly [number, number, number]): number {
  return (r << 16) | (g << 8) | b;
}

/** The mask of an object over those of others in the same frame. */
function withObject({ frame, id, rle }: Record<string, unknown>, before: LabelledFrame | undefined, wrong: Wrong): Omit<LabelledFrame, 'frame'> {
  if (!isObjectNumber(id)) throw wrong(`must have an id, ${RANGE}`);
  const { size, counts } = Object(rle) as Record<string, unknown>;
  const [height, width] = Array.isArray(size) && size.length === 2 ? (size as unknown[]) : [];
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE)) throw wrong('must have an rle with a size, [height, width]');
  const { labels = new Uint8Array(width * height), width: same = width } = before ?? {};
  if (same !== width || labels.length !== width * height) throw wrong(`has another size than the mask of frame ${String(frame)} before it`);
  let at = 0;
  for (const [k, count] of runsOf(counts, wrong).entries()) {
    if (!isWhole(count, 0, labels.length - at)) throw wrong('has run lengths that do not fill its size');
    // Column by column; every second run is of the object.
    for (const end = at + count; at < end; at++) if (k % 2 === 1) labels[(at % height) * width + Math.floor(at / height)] = id;
  }
  if (at !== labels.length) throw wrong('has run lengths that do not fill its size');
  return { labels, width };
}

function runsOf(counts: unknown, wrong: Wrong): unknown[] {
  if (Array.isArray(counts)) return counts;
  if (typeof counts !== 'string') throw wrong('must have an rle with counts, text or a list of numbers');
  try {
    return decompressed(counts);
  } catch (thrown) {
    throw wrong(`has an rle that cannot be read: ${veroneseError(thrown).message}`);
  }
}
