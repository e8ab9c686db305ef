// Datumaro's own JSON: items with masks, polygons and boxes. A track or a group is an object, in all items.

import { invalidInput, isListOf, isNumber, isObject, isWhole } from '../../common/checks.js';
import { columnsOf, isId } from './coco.js';
import {
  checkSize,
  type Context,
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
  within,
} from './frame.js';

type Json = Record<string, unknown>;

/** Annotations of a whole image. */
const REMARKS: unknown[] = ['label', 'caption'];

/** Items without shapes are left out: a data set also has those at which nobody has looked. */
export function readDatumaro({ items, categories }: Json, file: string, context: Context): ReadFrame[] {
  const names = namesOf(categories);
  return listOf(items, 'items').flatMap((item) => within(`item ${quoted(item['id'])}`, () => frameOf(item, names, file, context)));
}

function frameOf({ id, annotations, image, media = image }: Json, names: readonly unknown[], file: string, context: Context): ReadFrame[] {
  const unnumbered = new Unnumbered();
  const shapes = listOf(annotations ?? [], 'annotations').flatMap((annotation, at): (Shape & { z: number })[] => {
    const { type, group, attributes, label_id: label, z_order: z } = annotation;
    if (REMARKS.includes(type)) return [];
    const name = names[Number(label)];
    const called = typeof name === 'string' ? name : undefined;
    const track = isObject(attributes) ? attributes['track_id'] : undefined;
    const number = track ?? (isWhole(group, 1, Number.MAX_SAFE_INTEGER) ? group : undefined);
    const keyOf = () => (isId(number) ? `${track === undefined ? 'group' : 'track'} ${number}` : unnumbered.keyOf(called));
    const shape = placed(`annotation ${quoted(annotation['id'] ?? at)}`, () => shapeOf(drawing(annotation), () => known(keyOf(), number, called)));
    return [{ ...shape, z: Number(z) || 0 }];
  });
  if (shapes.length === 0) return [];
  const [height, width] = isObject(media) && Array.isArray(media['size']) ? (media['size'] as unknown[]) : [];
  const path = isObject(media) && typeof media['path'] === 'string' && media['path'] !== '' ? media['path'] : id;
  return [frameOfShapes({ name: stemOf(path), file, ...checkSize(width, height, 'the image') }, shapes.sort((a, b) => a.z - b.z), context)];
}

function drawing({ type, rle, points, bbox }: Json): Drawing | LeftOut {
  if (type === 'mask') {
    if (!isObject(rle)) throw invalidInput('a mask must have run lengths');
    return { draw: (canvas, label) => columnsOf(canvas, rle, label) };
  }
  if (type === 'polygon') return polygonOf(Array.isArray(points) ? points : []);
  if (type === 'ellipse' && isListOf(points, isNumber) && points.length === 4) {
    const [left, top, right, bottom] = points as [number, number, number, number];
    return { draw: (canvas, label) => canvas.ellipse([(left + right) / 2, (top + bottom) / 2, (right - left) / 2, (bottom - top) / 2], label) };
  }
  if (type !== 'bbox') return { leftOut: `annotations of type ${quoted(type)}` };
  if (!isListOf(bbox, isNumber) || bbox.length !== 4) throw invalidInput('a box must have four numbers');
  return { box: bbox };
}

function namesOf(categories: unknown): unknown[] {
  const { label } = isObject(categories) ? categories : {};
  return listOf((isObject(label) ? label['labels'] : undefined) ?? [], 'labels').map(({ name }) => name);
}
