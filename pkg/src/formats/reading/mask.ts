// One mask in another form than labels: a PNG file, COCO's run lengths, or the pixels of a picture.

import type { LabelImage, Levels, MaskSource } from '../../../types/formats.js';
import { checkedBytes, entriesOf, invalidInput, invalidOption, isObject, isWhole, reading, UNLABELLED } from '../../common/checks.js';
import type { VeroneseError } from '../../common/errors.js';
import { davisPalette } from '../../common/palette.js';
import { countsOf } from '../coco-rle.js';
import { decodeIndices, type Size } from '../png-reader.js';
import { Canvas } from './canvas.js';
import { checkSize, within } from './frame.js';
import { crispLevels } from './smoothed.js';

export function readMask(source: MaskSource, options?: { levels?: Levels }): LabelImage {
  return reading(() => {
    const { levels } = entriesOf(options, ['levels']);
    if (levels !== undefined && !isLevels(levels)) throw wrongLevels(levels);
    if (!isObject(source)) throw invalidInput('a mask must be { png }, { rle } or { data, width, height }');
    const { png, rle, id = 1, data, width, height } = source as Record<string, unknown>;
    return within('the mask', () => {
      if (png !== undefined) return labelsOfPng(checkedBytes('its png', png), levels);
      if (rle === undefined) return labelsOfPixels(checkedBytes('its data', data), checkSize(width, height, 'its pixels'), levels);
      if (!isWhole(id, 1, UNLABELLED - 1)) throw invalidInput(`it must have an id from 1 to ${UNLABELLED - 1}, or none`);
      return labelsOfRle(rle, id);
    });
  });
}

export function isLevels(value: unknown): value is Levels {
  return value === 'exact' || isWhole(value, 1, 65_535);
}

export function wrongLevels(value: unknown): VeroneseError {
  return invalidOption('levels', "'exact' or a level from 1 to 65535", value);
}

/** Indices, or grey levels of up to 8 bits. */
export function labelsOfPng(bytes: Uint8Array, levels?: Levels): LabelImage {
  const { labels, isGrey, ...size } = decodeIndices(bytes, { foreign: true });
  return { labels: isGrey ? crispLevels(labels, size, levels) : labels, ...size };
}

/** Of RGBA pixels: grey levels if there is nothing else, otherwise indices of colours in the DAVIS palette. Transparent pixels have no label. */
function labelsOfPixels(rgba: Uint8Array, size: Size, levels?: Levels): LabelImage {
  const { width, height } = size;
  if (rgba.length !== 4 * width * height) throw invalidInput('it must have RGBA pixels that fill its width and height');
  const colours = Int32Array.from({ length: width * height }, (_, p) => (rgba[4 * p + 3] === 0 ? -1 : numberOf(rgba.subarray(4 * p))));
  const isGrey = colours.every((colour) => colour === -1 || colour === (colour & 255) * 0x010101);
  if (isGrey) {
    const greys = crispLevels(
      Uint8Array.from(colours, (colour) => (colour === -1 ? 0 : colour & 255)),
      size,
      levels,
    );
    return { labels: greys.map((level, p) => (colours[p] === -1 ? UNLABELLED : level)), ...size };
  }
  const palette = davisIndices();
  const labels = Uint8Array.from(colours, (colour, p) => {
    const index = colour === -1 ? UNLABELLED : palette.get(colour);
    if (index !== undefined) return index;
    throw invalidInput(
      `it has a pixel of a colour that is neither grey nor of the DAVIS palette, at ${p % width}, ${Math.floor(p / width)}`,
    );
  });
  return { labels, ...size };
}

function numberOf([red, green, blue]: ArrayLike<number> & Iterable<number>): number {
  return ((red as number) << 16) | ((green as number) << 8) | (blue as number);
}

/** By colour of 24 bits the index in the DAVIS palette; of colours that it has twice the lower one. */
export function davisIndices(): Map<number, number> {
  return new Map(
    davisPalette()
      .map((colour, index) => [numberOf(colour), index] as const)
      .reverse(),
  );
}

/** Of one object; 0 elsewhere. */
function labelsOfRle(rle: unknown, id: number): LabelImage {
  const { size, counts } = Object(rle) as Record<string, unknown>;
  if (!Array.isArray(size) || size.length !== 2) throw invalidInput('it must have an rle with a size, [height, width]');
  const { width, height } = checkSize(size[1], size[0], 'its rle');
  const canvas = new Canvas(width, height);
  canvas.columns(countsOf(counts), id);
  return { labels: canvas.labels, width, height };
}
