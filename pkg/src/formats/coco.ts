// A COCO instances file. Polygons are filled ring by ring and united there: holes hang on their outline by a bridge.

import { cocoRle } from './coco-rle.js';
import { type Encoder, idOf, json } from './frames.js';
import type { Settings } from './metadata.js';
import { Outlines } from './outline.js';

const INFO = { description: 'Masks of what moves together' };

/** The document of many images. */
export function cocoImages(file: string, shape: 'rle' | 'polygon') {
  return ({ one, classes, tracked, tolerance }: Settings): Encoder => {
    const outlines = new Outlines(tolerance, one ? 'image' : 'clip');
    const images: object[] = [];
    const annotations: object[] = [];
    const categories = new Categories(classes);
    return {
      add(frame) {
        const { index, image, width, height, masks } = frame;
        images.push({ id: index + 1, file_name: image, width, height });
        const segmentations = shape === 'rle' ? masks.map((mask) => cocoRle(mask, frame)) : outlines.bridged(frame);
        for (const [at, mask] of masks.entries()) {
          const attributes = { ...(tracked && { track_id: idOf(mask.label) }), ...(mask.motion && { matrix: mask.motion.matrix }) };
          annotations.push({
            id: annotations.length + 1,
            image_id: index + 1,
            category_id: categories.idOf(mask),
            iscrowd: 0,
            area: mask.area,
            bbox: [mask.left, mask.top, mask.width, mask.height],
            segmentation: segmentations[at],
            ...(Object.keys(attributes).length > 0 && { attributes }),
          });
        }
      },
      finish: () => [json(file, { info: INFO, images, categories: categories.all, annotations })],
    };
  };
}

interface Annotation {
  id: number;
  video_id: number;
  category_id: number;
  iscrowd: 0;
  width: number;
  height: number;
  segmentations: (object | null)[];
  bboxes: (number[] | null)[];
  areas: (number | null)[];
}

/** YouTube-VIS: COCO for a video. One annotation per label, with a mask for each frame, or null where it is not to be seen. */
export function cocoVideo({ classes, tracked }: Settings): Encoder {
  const names: string[] = [];
  const categories = new Categories(classes);
  const annotations = new Map<number, Annotation>();
  return {
    add(frame) {
      const { index, image, width, height, masks } = frame;
      names.push(image);
      for (const mask of masks) {
        const seen = { segmentations: [], bboxes: [], areas: [] };
        const annotation = annotations.get(mask.label) ?? {
          id: 0,
          video_id: 1,
          category_id: categories.idOf(mask),
          iscrowd: 0,
          width,
          height,
          ...seen,
        };
        annotations.set(mask.label, annotation);
        fillUp(annotation, index);
        annotation.segmentations.push(cocoRle(mask, frame));
        annotation.bboxes.push([mask.left, mask.top, mask.width, mask.height]);
        annotation.areas.push(mask.area);
      }
    },
    finish({ width, height, length }) {
      const videos = [{ id: 1, width, height, length, file_names: names }];
      const all = byNumber(annotations).map(([label, annotation], at) => {
        fillUp(annotation, length);
        return { ...annotation, id: tracked ? idOf(label) : at + 1 };
      });
      return [json('youtube-vis.json', { info: INFO, videos, categories: categories.all, annotations: all })];
    },
  };
}

/** Null for the frames up to `index` in which the label was not seen. */
function fillUp({ segmentations, bboxes, areas }: Annotation, index: number): void {
  for (const list of [segmentations, bboxes, areas]) while (list.length < index) list.push(null);
}

/** COCO counts from 1: the first class is category 1, and without a list label 0. */
class Categories {
  readonly #names: Map<number, string>;

  constructor(classes: readonly string[]) {
    this.#names = new Map(classes.entries());
  }

  idOf({ category, name }: { category: number; name: string }): number {
    this.#names.set(category, name);
    return category + 1;
  }

  get all(): { id: number; name: string }[] {
    return byNumber(this.#names).map(([category, name]) => ({ id: category + 1, name }));
  }
}

function byNumber<T>(map: ReadonlyMap<number, T>): [number, T][] {
  return [...map].sort(([a], [b]) => a - b);
}
