// Supervisely: one file for each image, called by its name, with bitmaps. Objects have no numbers.

import { invalidInput, isObject } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices, inflated } from '../indexed-png.js';
import type { Canvas } from './canvas.js';
import { checkBox, checkSize, decoding, frameOfShapes, listOf, type ReadFrame, stemOf, Unnumbered } from './frame.js';

type Json = Record<string, unknown>;

/** Most bytes in the PNG of a bitmap: as many as the largest frame has pixels. */
const LARGEST = 2 ** 24;

export function readSupervisely({ size, objects }: Json, file: string): ReadFrame {
  const { width, height } = isObject(size) ? size : {};
  const unnumbered = new Unnumbered();
  const shapes = listOf(objects, 'objects').map(({ classTitle: name, geometryType: type, bitmap }) => {
    if (typeof name !== 'string') throw invalidInput('the class of an object must be text');
    const { data, origin } = isObject(bitmap) ? bitmap : {};
    if (type !== 'bitmap' || typeof data !== 'string' || !Array.isArray(origin)) throw invalidInput('it has an object that is no bitmap');
    return { key: unnumbered.keyOf(name), name, draw: (canvas: Canvas, label: number) => stamp(canvas, data, origin, label) };
  });
  return frameOfShapes({ name: stemOf(file.replace(/\.json$/i, '')), file, ...checkSize(width, height, 'the image') }, shapes);
}

function stamp(canvas: Canvas, data: string, [left, top]: readonly unknown[], label: number): void {
  const { indices, width, height } = decoding('a bitmap', () => decodeIndices(inflated([fromBase64(data)], LARGEST), { foreign: true }));
  canvas.stamp(indices, checkBox([left, top, width, height], canvas), label);
}
