// One mask in another form than labels: a PNG file, COCO's run lengths, or the pixels of a picture.

import type { LabelImage, Levels, MaskSource } from '../../../types/formats.js';
import {
  checkedBytes,
  entriesOf,
  invalidInput,
  invalidOption,
  isObject,
  isWhole,
  LONGEST_SIDE,
  reading,
  UNLABELLED,
} from '../../common/checks.js';
import { VeroneseError, veroneseError } from '../../common/errors.js';
import { davisPalette } from '../../common/palette.js';
import { decodeIndices } from '../png-reader.js';
import { decompressed } from './coco-rle.js';
import { checkCrisp, crispLevels } from './smoothed.js';

export function readMask(source: MaskSource, options?: { levels?: Levels }): LabelImage {
  return reading(() => {
    const { levels } = entriesOf(options, ['levels']);
    if (levels !== undefined && !isLevels(levels)) throw wrongLevels(levels);
    if (!isObject(source)) throw invalidInput('a mask must be { png }, { rle } or { data, width, height }');
    const { png, rle, id = 1, data, width, height } = source as Record<string, unknown>;
    try {
      if (png !== undefined) return labelsOfPng(checkedBytes('its png', png), levels);
      if (rle === undefined) return labelsOfPixels(checkedBytes('its data', data), width, height, levels);
      if (!isWhole(id, 1, UNLABELLED - 1)) throw invalidInput(`must have an id from 1 to ${UNLABELLED - 1}, or none`);
      return labelsOfRle(rle, id);
    } catch (thrown) {
      if (thrown instanceof VeroneseError) throw new VeroneseError(thrown.code, `the mask: ${thrown.message}`);
      throw thrown;
    }
  });
}

export function isLevels(value: unknown): value is Levels {
  return value === 'exact' || isWhole(value, 1, 65_535);
}

export function wrongLevels(value: unknown): VeroneseError {
  return invalidOption('levels', "'exact' or a level from 1 to 65535", value);
}

// The sentences of errors follow what they are about.

/** Indices, or grey levels of up to 8 bits. */
export function labelsOfPng(bytes: Uint8Array, levels?: Levels): LabelImage {
  const { indices, isGrey, ...size } = decodeIndices(bytes, { foreign: true });
  return { labels: isGrey ? crispLevels(indices, size, levels) : indices, ...size };
}

/** Of RGBA pixels: grey levels if there is nothing else, otherwise indices of colours in the DAVIS palette. Transparent pixels have no label. */
export function labelsOfPixels(rgba: Uint8Array, width: unknown, height: unknown, levels?: Levels): LabelImage {
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE) || rgba.length !== 4 * width * height) {
    throw invalidInput('must have RGBA pixels that fill its width and height');
  }
  const byte = (p: number, channel: number) => rgba[4 * p + channel] as number;
  const colours = Int32Array.from({ length: width * height }, (_, p) =>
    byte(p, 3) === 0 ? -1 : numberOf([byte(p, 0), byte(p, 1), byte(p, 2)]),
  );
  const greys = Array.from({ length: 256 }, (_, level) => numberOf([level, level, level]));
  const isGrey = colours.every((colour) => colour === -1 || colour === greys[colour & 255]);
  // Of colours that the palette has twice the lower index counts.
  const palette = isGrey ? greys : davisPalette().map(numberOf);
  if (isGrey && levels === undefined)
    checkCrisp(
      colours.map((colour) => Math.max(0, colour) & 255),
      { width, height },
      { what: 'level', ground: 0, white: UNLABELLED },
    );
  const meaning = new Map(
    palette.map((colour, index) => [colour, isGrey && typeof levels === 'number' ? Number(index >= levels) : index] as const).reverse(),
  ).set(-1, UNLABELLED);
  const labels = Uint8Array.from(colours, (colour, p) => {
    const label = meaning.get(colour);
    if (label !== undefined) return label;
    throw invalidInput(`has a pixel of a colour that is neither grey nor of the DAVIS palette, at ${p % width}, ${Math.floor(p / width)}`);
  });
  return { labels, width, height };
}

function numberOf([r, g, b]: readonly [number, number, number]): number {
  return (r << 16) | (g << 8) | b;
}

/** Of one object; 0 elsewhere. */
export function labelsOfRle(rle: unknown, id: number): LabelImage {
  const { size, counts } = Object(rle) as Record<string, unknown>;
  const [height, width] = Array.isArray(size) && size.length === 2 ? (size as unknown[]) : [];
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE))
    throw invalidInput('must have an rle with a size, [height, width]');
  const labels = new Uint8Array(width * height);
  let at = 0;
  for (const [k, count] of runsOf(counts).entries()) {
    if (!isWhole(count, 0, labels.length - at)) throw invalidInput('has run lengths that do not fill its size');
    // Column by column; every second run is of the object.
    for (const end = at + count; at < end; at++) if (k % 2 === 1) labels[(at % height) * width + Math.floor(at / height)] = id;
  }
  if (at !== labels.length) throw invalidInput('has run lengths that do not fill its size');
  return { labels, width, height };
}

function runsOf(counts: unknown): unknown[] {
  if (Array.isArray(counts)) return counts;
  if (typeof counts !== 'string') throw invalidInput('must have an rle with counts, text or a list of numbers');
  try {
    return decompressed(counts);
  } catch (thrown) {
    throw invalidInput(`has an rle that cannot be read: ${veroneseError(thrown).message}`);
  }
}
