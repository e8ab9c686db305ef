// A COCO instances file. Polygons are filled ring by ring and united there: holes hang on their outline by a bridge.

import type { ClipMeta, CocoDocument, CocoRle, Encoded, FormatMeta, FormatOptions, LabelFrames } from '../../types/formats.js';
import { cocoRle } from './coco-rle.js';
import { type Frame, gathered, type Gathering, idOf } from './frames.js';
import { checkedMeta, checkedOptions, imageOf, masksOf } from './input.js';
import { Outlines } from './outline.js';

export function encodeCoco(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: FormatOptions<'rle' | 'polygon'>,
): CocoDocument {
  const instances = new Instances(options, 'image', checkedMeta(meta));
  const masks = masksOf(labels, width, height, meta);
  instances.add({ index: 0, image: imageOf(meta), width, height, masks });
  return instances.finish();
}

export function encodeCocoImages<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'rle' | 'polygon'>,
): Encoded<Frames, CocoDocument> {
  return gathered(frames, meta, (clip) => new Instances(options, 'clip', clip));
}

class Instances implements Gathering<CocoDocument> {
  readonly #shape: 'rle' | 'polygon';
  readonly #outlines: Outlines;
  readonly #tracked: boolean;
  readonly #images: CocoDocument['images'] = [];
  readonly #annotations: CocoDocument['annotations'] = [];
  /** Names by number. */
  readonly #categories: Map<number, string>;

  constructor(options: unknown, kind: 'image' | 'clip', { classes = [], tracked = false }: Pick<ClipMeta, 'classes' | 'tracked'>) {
    const { shape, tolerance } = checkedOptions(options, ['rle', 'polygon']);
    this.#shape = shape;
    this.#outlines = new Outlines(tolerance, kind);
    this.#tracked = tracked;
    this.#categories = new Map(classes.entries());
  }

  add({ index, image, width, height, masks }: Frame): void {
    this.#images.push({ id: index + 1, file_name: image, width, height });
    const rle = this.#shape === 'rle';
    const segmentations = rle ? masks.map((mask) => cocoRle(mask, width, height)) : this.#outlines.bridged({ masks, width, height });
    for (const [at, mask] of masks.entries()) {
      this.#categories.set(mask.category, mask.name);
      const attributes = { ...(this.#tracked && { track_id: idOf(mask.label) }), ...(mask.motion && { matrix: mask.motion.matrix }) };
      this.#annotations.push({
        id: this.#annotations.length + 1,
        image_id: index + 1,
        category_id: mask.category + 1,
        iscrowd: 0,
        area: mask.area,
        bbox: [mask.left, mask.top, mask.width, mask.height],
        segmentation: segmentations[at] as CocoRle | number[][],
        ...(Object.keys(attributes).length > 0 && { attributes }),
      });
    }
  }

  finish(): CocoDocument {
    // COCO counts from 1: the first class is category 1, and without a list label 0.
    const categories = [...this.#categories].sort(([a], [b]) => a - b).map(([category, name]) => ({ id: category + 1, name }));
    return { info: { description: 'Masks of what moves together' }, images: this.#images, categories, annotations: this.#annotations };
  }
}
