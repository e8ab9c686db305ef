// "CVAT for images 1.1": images with a <mask> or <polygon> per part. Objects of a clip are groups, because images have no tracks.

import type { ClipMeta, Encoded, FormatMeta, FormatOptions, LabelFrames } from '../../types/formats.js';
import { type Frame, gathered, type Gathering, idOf } from './frames.js';
import { checkedMeta, checkedOptions, imageOf, type Mask, masksOf } from './input.js';
import { Outlines, points, type Ring } from './outline.js';
import { rowRuns } from './runs.js';
import { escaped } from './xml.js';

export function encodeCvatXml(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: FormatOptions<'mask' | 'polygon'>,
): string {
  const images = new Images(options, 'image', checkedMeta(meta));
  const masks = masksOf(labels, width, height, meta);
  images.add({ index: 0, image: imageOf(meta), width, height, masks });
  return images.finish();
}

export function encodeCvatImages<Frames extends LabelFrames>(
  frames: Frames,
  meta?: ClipMeta,
  options?: FormatOptions<'mask' | 'polygon'>,
): Encoded<Frames, string> {
  return gathered(frames, meta, (clip) => new Images(options, 'clip', clip));
}

class Images implements Gathering<string> {
  readonly #shape: 'mask' | 'polygon';
  readonly #outlines: Outlines;
  readonly #tracked: boolean;
  readonly #names: Set<string>;
  readonly #elements: string[] = [];
  #count = 0;

  constructor(options: unknown, kind: 'image' | 'clip', { classes, tracked = false }: Pick<ClipMeta, 'classes' | 'tracked'>) {
    const { shape, tolerance } = checkedOptions(options, ['mask', 'polygon']);
    this.#shape = shape;
    this.#outlines = new Outlines(tolerance, kind);
    this.#tracked = tracked;
    this.#names = new Set(classes);
  }

  add({ index, image, width, height, masks }: Frame): void {
    this.#count++;
    for (const { name } of masks) this.#names.add(name);
    this.#elements.push(`  <image id="${index}" name="${escaped(image)}" width="${width}" height="${height}">`);
    const elements =
      this.#shape === 'mask'
        ? masks.map((mask) => maskElement(mask, this.#tracked))
        : polygonElements(masks, this.#outlines.bridged({ masks, width, height }), this.#tracked);
    for (const element of elements) this.#elements.push(element);
    this.#elements.push('  </image>');
  }

  finish(): string {
    return [...cvatHead('annotation', this.#count, this.#names), ...this.#elements, '</annotations>', ''].join('\n');
  }
}

/** The document before the annotations. `more` are further elements of the task. */
export function cvatHead(mode: 'annotation' | 'interpolation', size: number, names: Iterable<string>, more: readonly string[] = []): string[] {
  return [
    '<?xml version="1.0" encoding="utf-8"?>',
    '<annotations>',
    '  <version>1.1</version>',
    '  <meta>',
    '    <task>',
    `      <size>${size}</size>`,
    `      <mode>${mode}</mode>`,
    '      <labels>',
    ...Array.from(new Set(names), (name) => `        <label><name>${escaped(name)}</name><attributes></attributes></label>`),
    '      </labels>',
    ...more.map((element) => `      ${element}`),
    '    </task>',
    '  </meta>',
  ];
}

function maskElement({ label, name, left, top, width, height, pixels }: Mask, grouped: boolean): string {
  const box = `left="${left}" top="${top}" width="${width}" height="${height}"`;
  const rest = `source="auto" occluded="0" rle="${rowRuns(pixels).join(', ')}" ${box} z_order="0"${groupOf(label, grouped)}`;
  return `    <mask label="${escaped(name)}" ${rest}></mask>`;
}

/** One polygon for each connected part, all of one group. */
function polygonElements(masks: readonly Mask[], rings: readonly Ring[][], grouped: boolean): string[] {
  return masks.flatMap(({ label, name }, at) => {
    const parts = rings[at] as Ring[];
    const group = groupOf(label, grouped || parts.length > 1);
    return parts.map((ring) => {
      const rest = `source="auto" occluded="0" points="${cvatPoints(ring)}" z_order="0"${group}`;
      return `    <polygon label="${escaped(name)}" ${rest}></polygon>`;
    });
  });
}

/** 0 would be no group. */
function groupOf(label: number, grouped: boolean): string {
  return grouped ? ` group_id="${idOf(label)}"` : '';
}

/** The vertices of a polygon. */
export function cvatPoints(ring: Ring): string {
  return points(ring).map((point) => point.map((value) => value.toFixed(2)).join()).join(';');
}
