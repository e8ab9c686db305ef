// Supervisely: one file for each image, called by its name, with bitmaps. Objects have no numbers.

import { invalidInput, isListOf, isObject } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices, inflated } from '../indexed-png.js';
import type { Canvas } from './canvas.js';
import {
  boxAround,
  checkBox,
  checkSize,
  type Context,
  decoding,
  type Drawing,
  frameOfShapes,
  known,
  type LeftOut,
  listOf,
  placed,
  polygonOf,
  quoted,
  type ReadFrame,
  type Shape,
  shapeOf,
  stemOf,
  Unnumbered,
} from './frame.js';

type Json = Record<string, unknown>;

/** Most bytes in the PNG of a bitmap: as many as the largest frame has pixels. */
const LARGEST = 2 ** 24;

export function readSupervisely({ size, objects }: Json, file: string, context: Context): ReadFrame {
  const { width, height } = isObject(size) ? size : {};
  const unnumbered = new Unnumbered();
  const shapes = listOf(objects, 'objects').map((object, at): Shape => {
    const { classTitle: name } = object;
    const place = `object ${at + 1}, ${quoted(name)}`;
    if (typeof name !== 'string') throw invalidInput(`${place}: the class of an object must be text`);
    return placed(place, () => shapeOf(drawing(object), () => known(unnumbered.keyOf(name), undefined, name)));
  });
  return frameOfShapes({ name: stemOf(file.replace(/\.json$/i, '')), file, ...checkSize(width, height, 'the image') }, shapes, context);
}

function drawing({ geometryType: type, bitmap, points }: Json): Drawing | LeftOut {
  if (type === 'bitmap') {
    const { data, origin } = isObject(bitmap) ? bitmap : {};
    if (typeof data !== 'string' || !Array.isArray(origin)) throw invalidInput('it is a bitmap without data');
    return { draw: (canvas, label) => stamp(canvas, data, origin, label) };
  }
  if (type !== 'polygon' && type !== 'rectangle') return { leftOut: `objects of type ${quoted(type)}` };
  const { exterior, interior = [] } = isObject(points) ? points : {};
  const isRing = (ring: unknown): ring is unknown[][] => Array.isArray(ring) && ring.every((point) => Array.isArray(point) && point.length === 2);
  if (!isRing(exterior) || !isListOf(interior, isRing)) throw invalidInput('its points must be lists of x and y');
  if (type === 'polygon') {
    // Points are pixels, which have their middle half a pixel from the corner.
    const middle = (part: readonly unknown[][]) => part.flat().map((value) => Number(value) + 0.5);
    if (interior.length === 0 || exterior.length < 3) return polygonOf(middle(exterior));
    // A way to each hole and back has no width.
    return polygonOf(middle([exterior, ...interior].flatMap((part) => [...part, ...part.slice(0, 1), ...exterior.slice(0, 1)])));
  }
  const [left, top, width, height] = boxAround(exterior);
  return { box: [left, top, width + 1, height + 1] };
}

function stamp(canvas: Canvas, data: string, [left, top]: readonly unknown[], label: number): void {
  const { indices, width, height } = decoding('a bitmap', () => decodeIndices(inflated([fromBase64(data)], LARGEST), { foreign: true }));
  canvas.stamp(indices, checkBox([left, top, width, height], canvas), label);
}
