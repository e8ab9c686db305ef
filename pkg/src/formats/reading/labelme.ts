// LabelMe: one file for each image. A group is an object, in all files.

import { invalidInput, isWhole } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices } from '../indexed-png.js';
import type { Canvas } from './canvas.js';
import {
  checkBox,
  checkSize,
  type Context,
  decoding,
  frameOfShapes,
  isObjectNumber,
  known,
  listOf,
  placed,
  quoted,
  type ReadFrame,
  type Shape,
  stemOf,
  Unnumbered,
} from './frame.js';

type Json = Record<string, unknown>;

/** Shapes with an inside; a rectangle says where an object is. */
const READ: unknown[] = ['polygon', 'mask', 'rectangle'];

export function readLabelMe({ imagePath, imageWidth, imageHeight, shapes }: Json, file: string, context: Context): ReadFrame {
  const size = checkSize(imageWidth, imageHeight, 'the image');
  const unnumbered = new Unnumbered();
  const all = listOf(shapes, 'shapes').flatMap((shape, at): Shape[] => {
    const { label: name, group_id: group, shape_type: type = 'polygon' } = shape;
    const place = `shape ${at + 1}, ${quoted(name)}`;
    if (typeof name !== 'string') throw invalidInput(`${place}: the label of a shape must be text`);
    if (!READ.includes(type)) {
      context.leaveOut(file, `shapes of type ${quoted(type)}`);
      return [];
    }
    const key = isWhole(group, 0, Number.MAX_SAFE_INTEGER) ? `group ${group} ${name}` : unnumbered.keyOf(name);
    return [placed(place, () => ({ ...known(key, isObjectNumber(group) ? group : undefined, name), ...drawing(shape) }))];
  });
  return frameOfShapes({ name: stemOf(imagePath), file, ...size }, all, context);
}

type Drawing = { draw: (canvas: Canvas, label: number) => void } | { box: number[] };

function drawing({ shape_type: type = 'polygon', points, mask }: Json): Drawing {
  const isPoint = (point: unknown): point is unknown[] => Array.isArray(point) && point.length === 2;
  if (!Array.isArray(points) || !points.every(isPoint)) throw invalidInput('the points of a shape must each be x and y');
  if (type === 'polygon') return { draw: (canvas, label) => canvas.polygon(points.flat(), label) };
  if (type === 'rectangle') {
    const [left = NaN, top = NaN, right = NaN, bottom = NaN] = points.flat().map(Number);
    return { box: [Math.min(left, right), Math.min(top, bottom), Math.abs(right - left), Math.abs(bottom - top)] };
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
