//! Formats of annotation tools. The encoder is the package's.

import { type Format as ToolFormat, encode } from 'veronese/formats';
import { inFileNames } from '../common/naming.js';
import { type Export, type Format, TOLERANCE } from './format.js';
import { zipped } from './zip.js';

function entry(format: ToolFormat, id: string, title: string, file: string, hint: string): Format {
  const type = file.endsWith('.json') ? 'application/json' : file.endsWith('.xml') ? 'application/xml' : 'application/zip';
  return {
    id,
    title,
    file,
    type,
    hint,
    async make({ look, labels, segmentation: { width, height }, masks, annotated, image }: Export) {
      const names = Object.fromEntries(masks.map(({ id, name }) => [id, name]));
      // Those of objects are in the formats of clips.
      const motions = look.kind === 'objects' ? [] : masks.map(({ id, motions: [main] }) => ({ ...main!, label: id }));
      const isArchive = file.endsWith('.zip');
      const frame = { labels, width, height, motions, image: isArchive ? `${inFileNames(image)}.png` : image };
      const files = await encode(format, [frame], { names, labels: annotated, tracked: false, tolerance: TOLERANCE });
      return isArchive ? zipped(Object.fromEntries(files.map(({ name, content }) => [name, bytesOf(content)]))) : files[0]!.content;
    },
  };
}

function bytesOf(content: string | Uint8Array): Uint8Array {
  return typeof content === 'string' ? new TextEncoder().encode(content) : content;
}

export const ANNOTATIONS: readonly Format[] = [
  entry('coco', 'coco-rle', 'COCO, RLE', 'coco.json', 'Instances as compressed run lengths: exact, holes included.'),
  entry('coco-polygon', 'coco-polygons', 'COCO, polygons', 'coco-polygons.json', 'Instances as polygons.'),
  entry('cvat', 'cvat', 'CVAT', 'annotations.xml', 'CVAT for images 1.1, with masks.'),
  entry('label-studio', 'label-studio', 'Label Studio', 'label-studio.json', 'A task with brush labels as predictions, to import into a project.'),
  entry('yolo', 'yolo', 'YOLO segmentation', 'yolo.zip', 'A text file with one line per mask, and the class names.'),
];
