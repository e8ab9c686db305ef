// The formats that `veronese convert` writes of one image: a name, the files, and the encoder.

import type { FormatMeta } from '../../types/formats.js';
import * as formats from '../formats/index.js';
import type { OutputFile } from './files.js';

/** One labelled image and what is known of it. */
export interface Masks {
  labels: Uint8Array;
  width: number;
  height: number;
  meta: FormatMeta;
}

/** `tolerance`: of polygons, pixels. */
type Encode = (masks: Masks, tolerance: number) => OutputFile[];

const json = (name: string, encode: (masks: Masks, tolerance: number) => unknown): Encode => {
  return (masks, tolerance) => [text(name, `${JSON.stringify(encode(masks, tolerance))}\n`)];
};
const text = (name: string, content: string): OutputFile => ({ name, bytes: new TextEncoder().encode(content) });
const all = ({ labels, width, height, meta }: Masks) => [labels, width, height, meta] as const;

export const FORMATS = {
  coco: json('coco.json', (m) => formats.encodeCoco(...all(m), { shape: 'rle' })),
  'coco-polygon': json('coco-polygon.json', (m, tolerance) => formats.encodeCoco(...all(m), { shape: 'polygon', tolerance })),
  'youtube-vis': json('youtube-vis.json', (m) => formats.encodeCocoVideo([frame(m)], m.meta)),
  cvat: (m) => [text('cvat.xml', formats.encodeCvatXml(...all(m), { shape: 'mask' }))],
  'cvat-polygon': (m, tolerance) => [text('cvat-polygon.xml', formats.encodeCvatXml(...all(m), { shape: 'polygon', tolerance }))],
  'cvat-points': json('cvat-points.json', (m) => formats.encodeCvatPoints(...all(m))),
  'cvat-mots': (m) => [{ name: 'cvat-mots.zip', bytes: formats.encodeCvatMots([frame(m)], m.meta) }],
  'label-studio': json('label-studio.json', (m) => [formats.encodeLabelStudio(...all(m), { shape: 'brush' })]),
  'label-studio-polygon': json('label-studio-polygon.json', (m, tolerance) => [formats.encodeLabelStudio(...all(m), { shape: 'polygon', tolerance })]),
  labelme: json('labelme.json', (m) => formats.encodeLabelMe(...all(m), { shape: 'mask' })),
  'labelme-polygon': json('labelme-polygon.json', (m, tolerance) => formats.encodeLabelMe(...all(m), { shape: 'polygon', tolerance })),
  yolo: (m, tolerance) => {
    const { text: lines, names } = formats.encodeYolo(...all(m), { tolerance });
    return [text('yolo.txt', lines), text('yolo-names.txt', names.map((name) => `${name}\n`).join(''))];
  },
  davis: (m) => [{ name: 'davis.png', bytes: formats.encodeDavis(m.labels, m.width, m.height) }],
  flo: (m) => [{ name: 'flow.flo', bytes: formats.encodeFlow(...all(m)) }],
  npy: (m) => [{ name: 'flow.npy', bytes: formats.encodeFlow(...all(m), { shape: 'npy' }) }],
  supervisely: json('supervisely.json', (m) => formats.encodeSupervisely(...all(m))),
  'web-annotation': json('web-annotation.json', (m, tolerance) => formats.encodeWebAnnotation(...all(m), { tolerance })),
  veronese: json('veronese.json', (m) => formats.encodeVeronese(...all(m))),
} satisfies Record<string, Encode>;

export type FormatName = keyof typeof FORMATS;

export function isFormatName(name: string): name is FormatName {
  return Object.hasOwn(FORMATS, name);
}

function frame({ labels, width, height, meta: { image } }: Masks) {
  return { labels, width, height, ...(image !== undefined && { image }) };
}
