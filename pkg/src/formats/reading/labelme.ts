// LabelMe: one file for each image. A group is an object, in all files.

import { invalidInput, isWhole } from '../../common/checks.js';
import { fromBase64 } from '../base64.js';
import { decodeIndices } from '../indexed-png.js';
import type { Canvas } from './canvas.js';
import {
  checkBox,
  checkSize,
  decoding,
  frameOfShapes,
  isObjectNumber,
  known,
  listOf,
  type ReadFrame,
  type Shape,
  stemOf,
  Unnumbered,
} from './frame.js';

type Json = Record<string, unknown>;

export function readLabelMe({ imagePath, imageWidth, imageHeight, shapes }: Json, file: string): ReadFrame {
  const size = checkSize(imageWidth, imageHeight, 'the image');
  const unnumbered = new Unnumbered();
  const all = listOf(shapes, 'shapes').map((shape): Shape => {
    const { label: name, group_id: group } = shape;
    if (typeof name !== 'string') throw invalidInput('the label of a shape must be text');
    const key = isWhole(group, 0, Number.MAX_SAFE_INTEGER) ? `group ${group} ${name}` : unnumbered.keyOf(name);
    return { ...known(key, isObjectNumber(group) ? group : undefined, name), draw: drawing(shape) };
  });
  return frameOfShapes({ name: stemOf(imagePath), file, ...size }, all);
}

function drawing({ shape_type: type = 'polygon', points, mask }: Json): Shape['draw'] {
  const isPoint = (point: unknown): point is unknown[] => Array.isArray(point) && point.length === 2;
  if (!Array.isArray(points) || !points.every(isPoint)) throw invalidInput('the points of a shape must each be x and y');
  if (type === 'polygon') return (canvas, label) => canvas.polygon(points.flat(), label);
  const isMask = type === 'mask' && points.length === 2;
  if (isMask && typeof mask === 'string') return (canvas, label) => stamp(canvas, points.flat(), mask, label);
  const kind = JSON.stringify(type)?.slice(0, 40);
  throw invalidInput(`it has a shape of type ${kind}, and only masks and polygons say which pixels an object has`);
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
