// LabelMe: one file for each image. A group is an object, in all files.

import { invalidInput, isWhole } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices } from '../indexed-png.js';
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

export function readLabelMe({ imagePath, imageWidth, imageHeight, shapes }: Json, file: string, context: Context): ReadFrame {
  const size = checkSize(imageWidth, imageHeight, 'the image');
  const unnumbered = new Unnumbered();
  const all = listOf(shapes, 'shapes').map((shape, at): Shape => {
    const { label: name, group_id: group } = shape;
    const place = `shape ${at + 1}, ${quoted(name)}`;
    if (typeof name !== 'string') throw invalidInput(`${place}: the label of a shape must be text`);
    const keyOf = () => (isWhole(group, 0, Number.MAX_SAFE_INTEGER) ? `group ${group} ${name}` : unnumbered.keyOf(name));
    return placed(place, () => shapeOf(drawing(shape), () => known(keyOf(), group, name)));
  });
  return frameOfShapes({ name: stemOf(imagePath), file, ...size }, all, context);
}

function drawing({ shape_type: type = 'polygon', points, mask }: Json): Drawing | LeftOut {
  if (typeof type !== 'string' || !['polygon', 'mask', 'rectangle', 'rotation', 'circle'].includes(type)) return { leftOut: `shapes of type ${quoted(type)}` };
  const isPoint = (point: unknown): point is unknown[] => Array.isArray(point) && point.length === 2;
  if (!Array.isArray(points) || !points.every(isPoint)) throw invalidInput('the points of a shape must each be x and y');
  if (type === 'polygon') return polygonOf(points.flat());
  // Two corners; all four, upright or turned, of other programs.
  if (['rectangle', 'rotation'].includes(type)) return { box: boxAround(points.length === 1 ? [] : points) };
  if (type === 'circle') {
    const [x, y, right, bottom] = points.flat().map(Number) as [number, number, number, number];
    const radius = Math.hypot(right - x, bottom - y);
    return { draw: (canvas, label) => canvas.ellipse([x, y, radius, radius], label) };
  }
  const isMask = type === 'mask' && points.length === 2;
  if (isMask && typeof mask === 'string') return { draw: (canvas, label) => stamp(canvas, points.flat(), mask, label) };
  throw invalidInput(`it is a shape of type ${quoted(type)} without its picture and its two corners`);
}

/** The corners are those of pixels inside; other programs write fractions. */
function stamp(canvas: Canvas, corners: readonly unknown[], mask: string, label: number): void {
  const { indices, width, height } = decoding('a mask', () => decodeIndices(fromBase64(mask), { foreign: true }));
  const whole = corners.map((value) => (typeof value === 'number' ? Math.round(value) : NaN));
  const [left, top, right, bottom] = whole as [number, number, number, number];
  const box = checkBox([left, top, right - left + 1, bottom - top + 1], canvas);
  if (box.width !== width || box.height !== height) {
    throw invalidInput(`a mask has ${width} × ${height} pixels, and its corners are those of ${box.width} × ${box.height}`);
  }
  canvas.stamp(indices, box, label);
}
