// COCO's instances, of images and of videos as in YouTube-VIS.

import { invalidInput, isNumber, isObject } from '../../common/checks.js';
import { countsOf } from '../coco-rle.js';
import {
  addTo,
  checkSize,
  type Context,
  type Drawing,
  frameOfShapes,
  known,
  listOf,
  polygonOf,
  quoted,
  type ReadFrame,
  type Shape,
  shapesOf,
  stemOf,
  Unnumbered,
  within,
} from './frame.js';

type Json = Record<string, unknown>;

/** Images of which nothing is annotated are left out: a list of images also has those at which nobody has looked. */
export function readCoco(document: Json, file: string, context: Context): ReadFrame[] {
  const categories = categoriesOf(document);
  const images = byId(listOf(document['images'], 'images'), 'image', (image) => ({
    image,
    shapes: [] as Shape[],
    unnumbered: new Unnumbered(),
  }));
  for (const { attributes, segmentation, bbox, id, image_id: of, category_id: category, track_id: own } of annotationsOf(document)) {
    const found = images.get(of);
    if (!found) throw invalidInput(`annotation ${quoted(id)} is of the image ${quoted(of)}, and there is none`);
    const track = (isObject(attributes) ? attributes['track_id'] : undefined) ?? own;
    const name = categories.get(category);
    const place = `image ${quoted(found.image['file_name'])}, annotation ${quoted(id)}`;
    const object = () => known(isId(track) ? `track ${track}` : found.unnumbered.keyOf(name), track, name);
    found.shapes.push(...shapesOf(place, () => drawingsOf(segmentation, bbox), object));
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
  const videos = byId(listOf(document['videos'], 'videos'), 'video', ({ width, height, file_names: names }) => {
    if (!Array.isArray(names)) throw invalidInput('"file_names" must be a list');
    return { size: checkSize(width, height, 'a video'), names: names as unknown[], shapes: new Map<number, Shape[]>() };
  });
  const unnumbered = new Unnumbered();
  for (const { id, video_id: of, category_id: category, segmentations } of annotationsOf(document)) {
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
      const place = `frame ${quoted(video.names[index])}, annotation ${quoted(id)}`;
      addTo(
        video.shapes,
        index,
        ...shapesOf(
          place,
          () => drawingsOf(segmentation),
          () => known(key, id, name),
        ),
      );
    }
  }
  return [...videos.values()].flatMap(({ size, names, shapes }) =>
    [...shapes].sort(([a], [b]) => a - b).map(([index, all]) => frameOfShapes({ name: stemOf(names[index]), file, ...size }, all, context)),
  );
}

function annotationsOf(document: Json): Json[] {
  return listOf(document['annotations'], 'annotations');
}

function categoriesOf(document: Json): Map<unknown, string> {
  return new Map(
    listOf(document['categories'] ?? [], 'categories').map(({ id, name }) => {
      if (typeof name !== 'string') throw invalidInput('the name of a category must be text');
      return [id, name];
    }),
  );
}

function byId<T>(list: readonly Json[], what: string, read: (entry: Json) => T): Map<unknown, T> {
  const all = new Map<unknown, T>();
  for (const entry of list) {
    const { id } = entry;
    if (!isId(id)) throw invalidInput(`each ${what} must have an id`);
    if (all.has(id)) throw invalidInput(`two ${what}s have the id ${id}`);
    all.set(id, read(entry));
  }
  return all;
}

function isId(id: unknown): id is number | string {
  return typeof id === 'number' || typeof id === 'string';
}

/** The parts of an annotation. */
function drawingsOf(segmentation: unknown, bbox?: unknown): Drawing[] {
  if (isObject(segmentation)) return [runLengthsOf(segmentation)];
  // Some programs leave out the list around the only polygon, others write an empty one where there is a box alone.
  const list: unknown[] = Array.isArray(segmentation) ? segmentation : [];
  const rings = list.length > 0 && list.every(isNumber) ? [list] : list;
  const parts = rings.map((ring) => {
    if (Array.isArray(ring)) return polygonOf(ring);
    throw invalidInput('an annotation has no mask: its segmentation must be polygons or run lengths');
  });
  const isBox = Array.isArray(bbox) && bbox.length === 4 && (parts.length === 0 || bbox.every((value, k) => k < 2 || value > 0));
  if (isBox && !parts.some((part) => 'draw' in part)) return [...parts, { box: bbox.map(Number) }];
  return parts.length > 0 ? parts : [{ leftOut: 'annotations without a mask' }];
}

/** Run lengths with their size. */
function runLengthsOf({ size, counts }: Json): Drawing {
  return {
    draw(canvas, label) {
      const { width, height } = canvas;
      if (!Array.isArray(size) || size.length !== 2 || size[0] !== height || size[1] !== width) {
        throw invalidInput(`run lengths must be of the frame's size, [${height}, ${width}], not ${quoted(size)}`);
      }
      canvas.columns(countsOf(counts), label);
    },
  };
}
