// YouTube-VIS: COCO for a video. One annotation per label, with a mask per frame or null where it is not to be seen.

import type { ClipMeta, CocoVideoDocument, Encoded, LabelFrames } from '../../types/formats.js';
import { cocoRle } from './coco-rle.js';
import { type Frame, gathered, type Gathering, idOf } from './frames.js';

type Annotation = CocoVideoDocument['annotations'][number];

export function encodeCocoVideo<Frames extends LabelFrames>(frames: Frames, meta?: ClipMeta): Encoded<Frames, CocoVideoDocument> {
  return gathered(frames, meta, ({ classes = [], tracked }): Gathering<CocoVideoDocument> => {
    const file_names: string[] = [];
    const categories = new Map(classes.entries());
    const annotations = new Map<number, Annotation>();
    return {
      add(frame) {
        file_names.push(frame.image);
        for (const mask of frame.masks) {
          categories.set(mask.category, mask.name);
          const annotation = annotations.get(mask.label) ?? begun(mask.category, frame);
          annotations.set(mask.label, annotation);
          fillUp(annotation, frame.index);
          annotation.segmentations.push(cocoRle(mask, frame.width, frame.height));
          annotation.bboxes.push([mask.left, mask.top, mask.width, mask.height]);
          annotation.areas.push(mask.area);
        }
      },
      finish: ({ width, height, length }) => ({
        info: { description: 'Masks of what moves together' },
        videos: [{ id: 1, width, height, length, file_names }],
        categories: byNumber(categories).map(([category, name]) => ({ id: category + 1, name })),
        annotations: byNumber(annotations).map(([label, annotation], index) => {
          fillUp(annotation, length);
          return { ...annotation, id: tracked ? idOf(label) : index + 1 };
        }),
      }),
    };
  });
}

function begun(category: number, { width, height }: Frame): Annotation {
  return { id: 0, video_id: 1, category_id: category + 1, iscrowd: 0, width, height, segmentations: [], bboxes: [], areas: [] };
}

/** Null for the frames up to `index` in which the label was not seen. */
function fillUp({ segmentations, bboxes, areas }: Annotation, index: number): void {
  for (const list of [segmentations, bboxes, areas] as unknown[][]) while (list.length < index) list.push(null);
}

function byNumber<T>(map: ReadonlyMap<number, T>): [number, T][] {
  return [...map].sort(([a], [b]) => a - b);
}
