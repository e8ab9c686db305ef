// Supervisely: one file for each image, called by its name, with bitmaps. Objects have no numbers.

import { invalidInput, isListOf, isObject } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices, inflated } from '../indexed-png.js';
import type { Canvas } from './canvas.js';
import { checkBox, checkSize, type Context, decoding, frameOfShapes, listOf, placed, quoted, type ReadFrame, type Shape, stemOf, Unnumbered } from './frame.js';

type Json = Record<string, unknown>;

/** What has an inside; a rectangle says where an object is. */
const READ: unknown[] = ['bitmap', 'polygon', 'rectangle'];
/** Most bytes in the PNG of a bitmap: as many as the largest frame has pixels. */
const LARGEST = 2 ** 24;

export function readSupervisely({ size, objects }: Json, file: string, context: Context): ReadFrame {
  const { width, height } = isObject(size) ? size : {};
  const unnumbered = new Unnumbered();
  const shapes = listOf(objects, 'objects').flatMap((object, at): Shape[] => {
    const { classTitle: name, geometryType: type } = object;
    const place = `object ${at + 1}, ${quoted(name)}`;
    if (typeof name !== 'string') throw invalidInput(`${place}: the class of an object must be text`);
    if (!READ.includes(type)) {
      context.leaveOut(file, `objects of type ${quoted(type)}`);
      return [];
    }
    return [placed(place, () => ({ key: unnumbered.keyOf(name), name, ...drawing(object) }))];
  });
  return frameOfShapes({ name: stemOf(file.replace(/\.json$/i, '')), file, ...checkSize(width, height, 'the image') }, shapes, context);
}

function drawing({ geometryType: type, bitmap, points }: Json): { draw: (canvas: Canvas, label: number) => void } | { box: number[] } {
  if (type === 'bitmap') {
    const { data, origin } = isObject(bitmap) ? bitmap : {};
    if (typeof data !== 'string' || !Array.isArray(origin)) throw invalidInput('it is a bitmap without data');
    return { draw: (canvas, label) => stamp(canvas, data, origin, label) };
  }
  const { exterior, interior = [] } = isObject(points) ? points : {};
  const isRing = (ring: unknown): ring is unknown[][] => Array.isArray(ring) && ring.every((point) => Array.isArray(point) && point.length === 2);
  if (!isRing(exterior) || !isListOf(interior, isRing)) throw invalidInput('its points must be lists of x and y');
  if (type === 'polygon') {
    // A way to each hole and back has no width. Points are pixels, and these have their middle half a pixel from the corner.
    const ring = [exterior, ...interior].flatMap((part) => [...part, ...part.slice(0, 1), ...exterior.slice(0, 1)]);
    return { draw: (canvas, label) => canvas.polygon(ring.flat().map((value) => Number(value) + 0.5), label) };
  }
  const [x, y] = [0, 1].map((axis) => exterior.map((point) => Number(point[axis]))) as [number[], number[]];
  const [left, top] = [Math.min(...x), Math.min(...y)];
  return { box: [left, top, Math.max(...x) + 1 - left, Math.max(...y) + 1 - top] };
}

function stamp(canvas: Canvas, data: string, [left, top]: readonly unknown[], label: number): void {
  const { indices, width, height } = decoding('a bitmap', () => decodeIndices(inflated([fromBase64(data)], LARGEST), { foreign: true }));
  canvas.stamp(indices, checkBox([left, top, width, height], canvas), label);
}
