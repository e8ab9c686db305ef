//! Formats of annotation tools. The encoders are the package's.

import { encodeCoco, encodeCvatXml, encodeLabelMe, encodeLabelStudio, encodeYolo, type FormatMeta } from 'veronese/formats';
import { type Export, type Format, TOLERANCE } from './format.js';
import { zipped } from './zip.js';

/** The arguments of the encoders. */
function argumentsFor({ look, labels, segmentation: { width, height }, masks, annotated, image }: Export): readonly [Uint8Array, number, number, FormatMeta] {
  const names = Object.fromEntries(masks.map(({ id, name }) => [id, name]));
  // Those of objects are in the formats of clips.
  const motions = look.kind === 'objects' ? [] : masks.map(({ id, motions: [main], pixels, share }) => ({ ...main!, label: id, pixels, share }));
  return [labels, width, height, { image, names, motions, labels: annotated }];
}

function entry(
  id: string,
  title: string,
  file: string,
  hint: string,
  encode: (exported: Export) => unknown,
): Format {
  const type = file.endsWith('.json') ? 'application/json' : file.endsWith('.xml') ? 'application/xml' : 'application/zip';
  return {
    id,
    title,
    file,
    type,
    hint,
    async make(exported) {
      const made = await encode(exported);
      if (typeof made === 'string') return made;
      return made instanceof Uint8Array ? new Uint8Array(made) : `${JSON.stringify(made)}\n`;
    },
  };
}

export const ANNOTATIONS: readonly Format[] = [
  entry('coco-rle', 'COCO, RLE', 'coco.json', 'Instances as compressed run lengths: exact, holes included.', (exported) =>
    encodeCoco(...argumentsFor(exported), { shape: 'rle' }),
  ),
  entry('coco-polygons', 'COCO, polygons', 'coco-polygons.json', 'Instances as polygons.', (exported) =>
    encodeCoco(...argumentsFor(exported), { shape: 'polygon', tolerance: TOLERANCE }),
  ),
  entry('cvat', 'CVAT', 'annotations.xml', 'CVAT for images 1.1, with masks.', (exported) =>
    encodeCvatXml(...argumentsFor(exported), { shape: 'mask' }),
  ),
  entry('label-studio', 'Label Studio', 'label-studio.json', 'A task with brush labels as predictions, to import into a project.', (exported) => [
    encodeLabelStudio(...argumentsFor(exported), { shape: 'brush' }),
  ]),
  entry('labelme', 'LabelMe', 'labelme.json', 'Mask shapes; save the file next to the image.', (exported) =>
    encodeLabelMe(...argumentsFor(exported), { shape: 'mask' }),
  ),
  entry('yolo', 'YOLO segmentation', 'yolo.zip', 'A text file with one line per mask, and the class names.', (exported) => {
    const { text, names } = encodeYolo(...argumentsFor(exported), { tolerance: TOLERANCE });
    const list = names.map((name, k) => `  ${k}: ${JSON.stringify(name)}\n`).join('');
    const bytes = (content: string): Uint8Array => new TextEncoder().encode(content);
    const stem = exported.image.replace(/\.[^.]*$/, '').replace(/[\\/:*?"<>|#]/g, '_');
    return zipped({ [`labels/${stem}.txt`]: bytes(text), 'data.yaml': bytes(`names:\n${list}`) });
  }),
];
