// YouTube-VIS: COCO for a video. One annotation per label, with a mask per frame or null where it is not to be seen.

import type { CocoVideoDocument, FormatMeta, LabelFrame } from '../../types/formats.js';
import { cocoRle } from './coco-rle.js';
import { checkFrames, imageOf, type Mask, masksOf, nameOf } from './input.js';

export function encodeCocoVideo(frames: readonly LabelFrame[], meta: FormatMeta = {}): CocoVideoDocument {
  const { width, height } = checkFrames(frames);
  const perFrame = frames.map(({ labels }) => new Map(masksOf(labels, width, height, meta).map((mask) => [mask.label, mask])));
  const present = [...new Set(perFrame.flatMap((masks) => [...masks.keys()]))].sort((a, b) => a - b);
  return {
    info: { description: 'Masks of what moves together' },
    videos: [
      {
        id: 1,
        width,
        height,
        length: frames.length,
        file_names: frames.map(({ image }, index) => image ?? (index === 0 ? imageOf(meta) : `frame-${index}.png`)),
      },
    ],
    categories: present.map((label) => ({ id: label + 1, name: nameOf(label, meta) })),
    annotations: present.map((label, index) => {
      const masks = perFrame.map((masks) => masks.get(label));
      const each = <T>(value: (mask: Mask) => T) => masks.map((mask) => (mask ? value(mask) : null));
      return {
        id: index + 1,
        video_id: 1,
        category_id: label + 1,
        iscrowd: 0,
        width,
        height,
        segmentations: each((mask) => cocoRle(mask, width, height)),
        bboxes: each(({ left, top, width, height }): [number, number, number, number] => [left, top, width, height]),
        areas: each(({ area }) => area),
      };
    }),
  };
}
