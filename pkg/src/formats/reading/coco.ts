// COCO's instances, of images and of videos as in YouTube-VIS.

import { invalidInput, isNumber, isObject } from '../../common/checks.js';
import type { Canvas } from './canvas.js';
import { decompressed } from './coco-rle.js';
import {
  checkSize,
  type Context,
  type Drawing,
  frameOfShapes,
  type Known,
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

/** Images of which nothing is annotated are left out: a list of images also has those at which nobody has looked. */
export function readCoco(document: Json, file: string, context: Context): ReadFrame[] {
  const categories = categoriesOf(document);
  const images = new Map<unknown, { image: Json; shapes: Shape[]; unnumbered: Unnumbered }>();
  for (const image of listOf(document['images'], 'images')) {
    if (images.has(idOf(image, 'an image'))) throw invalidInput(`two images have the id ${String(image['id'])}`);
    images.set(image['id'], { image, shapes: [], unnumbered: new Unnumbered() });
  }
  for (const annotation of listOf(document['annotations'], 'annotations')) {
    const { attributes, segmentation, bbox, id } = annotation;
    const which = `annotation ${quoted(id)}`;
    const found = images.get(annotation['image_id']);
    if (!found) throw invalidInput(`${which} is of the image ${quoted(annotation['image_id'])}, and there is none`);
    const track = (isObject(attributes) ? attributes['track_id'] : undefined) ?? annotation['track_id'];
    const name = categories.get(annotation['category_id']);
    const objectOf = once(() => known(isId(track) ? `track ${track}` : found.unnumbered.keyOf(name), track, name));
    found.shapes.push(...shapesOf(`image ${quoted(found.image['file_name'])}, ${which}`, objectOf, segmentation, bbox));
  }
  return [...images.values()].flatMap(({ image, shapes }) => {
    if (shapes.length === 0) return [];
    return within(`image ${quoted(image['id'])}`, () => {
      const size = checkSize(image['width'], image['height'], 'an image');
      return [frameOfShapes({ name: stemOf(image['file_name']), file, ...size }, shapes, context)];
    });
  });
}

/** Frames in which no object is are left out, as are images of {@link readCoco}. */
export function readYouTubeVis(document: Json, file: string, context: Context): ReadFrame[] {
  const categories = categoriesOf(document);
  const videos = new Map<unknown, { size: { width: number; height: number }; names: unknown[]; shapes: Map<number, Shape[]> }>();
  for (const video of listOf(document['videos'], 'videos')) {
    if (videos.has(idOf(video, 'a video'))) throw invalidInput(`two videos have the id ${String(video['id'])}`);
    const { width, height, file_names: names } = video;
    if (!Array.isArray(names)) throw invalidInput('"file_names" must be a list');
    videos.set(video['id'], { size: checkSize(width, height, 'a video'), names, shapes: new Map() });
  }
  const unnumbered = new Unnumbered();
  for (const annotation of listOf(document['annotations'], 'annotations')) {
    const { id, video_id: of, category_id: category, segmentations } = annotation;
    const video = videos.get(of);
    if (!video) throw invalidInput(`annotation ${quoted(id)} is of the video ${quoted(of)}, and there is none`);
    if (!Array.isArray(segmentations) || segmentations.length !== video.names.length) {
      throw invalidInput(
        `annotation ${quoted(id)}: "segmentations" must have an entry for each frame, null where the object is not to be seen`,
      );
    }
    const name = categories.get(category);
    const key = isId(id) ? `${videos.size > 1 ? String(of) : ''} track ${id}` : unnumbered.keyOf(name);
    for (const [index, segmentation] of segmentations.entries()) {
      if (segmentation === null || segmentation === undefined) continue;
      const shapes = video.shapes.get(index) ?? [];
      video.shapes.set(index, shapes);
      shapes.push(...shapesOf(`frame ${quoted(video.names[index])}, annotation ${quoted(id)}`, () => known(key, id, name), segmentation));
    }
  }
  return [...videos.values()].flatMap(({ size, names, shapes }) =>
    [...shapes].sort(([a], [b]) => a - b).map(([index, all]) => frameOfShapes({ name: stemOf(names[index]), file, ...size }, all, context)),
  );
}

function categoriesOf(document: Json): Map<unknown, string> {
  return new Map(
    listOf(document['categories'] ?? [], 'categories').map(({ id, name }) => {
      if (typeof name !== 'string') throw invalidInput('the name of a category must be text');
      return [id, name];
    }),
  );
}

function isId(id: unknown): id is number | string {
  return typeof id === 'number' || typeof id === 'string';
}

/** What a function gives the first time, each time. */
function once<T>(make: () => T): () => T {
  let made: { value: T } | undefined;
  return () => (made ??= { value: make() }).value;
}

function idOf({ id }: Json, what: string): number | string {
  if (isId(id)) return id;
  throw invalidInput(`${what} must have an id`);
}

function isBox(bbox: unknown): bbox is number[] {
  return Array.isArray(bbox) && bbox.length === 4;
}

/** The parts of an annotation. */
function shapesOf(place: string, objectOf: () => Known, segmentation: unknown, bbox?: unknown): Shape[] {
  const shape = (drawing: () => Drawing | LeftOut): Shape => placed(place, () => shapeOf(drawing(), objectOf));
  if (isObject(segmentation)) return [shape(() => ({ draw: (canvas, label) => columnsOf(canvas, segmentation, label) }))];
  // Some programs leave out the list around the only polygon, others write an empty one where there is a box alone.
  const rings: unknown[] =
    !Array.isArray(segmentation) || segmentation.length === 0 ? [] : segmentation.every(isNumber) ? [segmentation] : segmentation;
  const parts = rings.map((ring) =>
    shape(() => {
      if (Array.isArray(ring)) return polygonOf(ring);
      throw invalidInput('an annotation has no mask: its segmentation must be polygons or run lengths');
    }),
  );
  if (parts.some((part) => 'draw' in part)) return parts;
  if (isBox(bbox) && (parts.length === 0 || bbox.every((value, k) => k < 2 || value > 0)))
    return [...parts, shape(() => ({ box: bbox.map(Number) }))];
  return parts.length > 0 ? parts : [{ leftOut: 'annotations without a mask' }];
}

/** Run lengths with their size. */
function columnsOf(canvas: Canvas, { size, counts }: Json, label: number): void {
  const { width, height } = canvas;
  if (!Array.isArray(size) || size.length !== 2 || size[0] !== height || size[1] !== width) {
    throw invalidInput(`run lengths must be of the frame's size, [${height}, ${width}], not ${JSON.stringify(size)?.slice(0, 40)}`);
  }
  const list = typeof counts === 'string' ? decompressed(counts) : counts;
  if (!Array.isArray(list)) throw invalidInput('run lengths must be text or a list');
  canvas.columns(list, label);
}
