//! The formats of clips as data. The encoders are the package's, the same that `veronese convert` uses. Loaded on first use.

import * as encoders from 'veronese/formats';
import type { FormatMeta, MotFiles } from 'veronese/formats';
import type { ClipExport, ClipFile, ClipFormat } from './clip-export.js';
import { pngFromLabels } from './png.js';

type Files = Record<string, string | Uint8Array>;

function json(value: unknown): string {
  return `${JSON.stringify(value)}\n`;
}

function lines(texts: readonly string[]): string {
  return texts.map((text) => `${text}\n`).join('');
}

/** What the encoders of one image take. */
function given({ meta: { names, labels } }: ClipExport, frame: ClipFile): readonly [Uint8Array, number, number, FormatMeta] {
  return [frame.labels, frame.width, frame.height, { image: frame.image, names, labels, motions: frame.motions ?? [] }];
}

/** A folder as MOTChallenge's sequences are. */
function sequence(folder: string, { gt, seqinfo, names }: MotFiles): Files {
  return { [`${folder}/gt/gt.txt`]: gt, [`${folder}/gt/labels.txt`]: lines(names), [`${folder}/seqinfo.ini`]: seqinfo };
}

async function labelImages(exported: ClipExport, path: (stem: string) => string): Promise<Files> {
  const files: Files = {};
  for await (const { labels, width, height, stem } of exported.frames()) files[path(stem)] = await pngFromLabels(labels, width, height);
  return files;
}

/** In the order of the menu. */
export const CLIP_FORMATS: readonly ClipFormat[] = [
  {
    id: 'cvat-video',
    title: 'CVAT, tracks',
    hint: 'CVAT for video 1.1: a track with polygons for each object.',
    make: async ({ clip, fromStart }) => ({ 'cvat-video.xml': await encoders.encodeCvatVideo(fromStart.frames(), { ...fromStart.meta, clip: clip.name }, { shape: 'polygon' }) }),
  },
  {
    id: 'cvat-mots',
    title: 'CVAT, MOTS PNG',
    hint: 'An archive to import into CVAT: exact masks, up to 64 objects.',
    make: async (exported) => ({ 'cvat-mots.zip': await encoders.encodeCvatMots(exported.frames(), exported.meta) }),
  },
  {
    id: 'youtube-vis',
    title: 'YouTube-VIS',
    hint: 'The objects of the clip as compressed run lengths in the form of COCO.',
    make: async (exported) => ({ 'youtube-vis.json': json(await encoders.encodeCocoVideo(exported.frames(), exported.meta)) }),
  },
  {
    id: 'coco',
    title: 'COCO, RLE',
    hint: 'Every frame is an image; objects have a track_id.',
    make: async (exported) => ({ 'coco.json': json(await encoders.encodeCocoImages(exported.frames(), exported.meta, { shape: 'rle' })) }),
  },
  {
    id: 'mots',
    title: 'MOTS',
    hint: 'The text form of MOTS, with the names of the classes.',
    make: async (exported) => sequence('mots', await encoders.encodeMots(exported.frames(), exported.meta)),
  },
  {
    id: 'mot',
    title: 'MOTChallenge',
    hint: 'Boxes of the objects in every frame.',
    make: async (exported) => sequence('mot', await encoders.encodeMotChallenge(exported.frames(), exported.meta)),
  },
  {
    id: 'davis',
    title: 'DAVIS',
    hint: 'An indexed PNG for each frame: the index is the number of the object.',
    make: async (exported) => ({
      ...(await labelImages(exported, (stem) => `davis/Annotations/480p/${exported.meta.clip}/${stem}.png`)),
      'davis/ImageSets/2017/val.txt': `${exported.meta.clip}\n`,
    }),
  },
  {
    id: 'yolo',
    title: 'YOLO segmentation',
    hint: 'A text file for each frame with a line per object, and the names of the classes.',
    make: async (exported) => {
      const { names, labels } = exported.meta;
      const classes = [...new Set(labels.map((label) => names[label]!))];
      const files: Files = {};
      for await (const frame of exported.frames()) files[`yolo/labels/${frame.stem}.txt`] = encoders.encodeYolo(...given(exported, frame), { classes }).text;
      return { ...files, 'yolo/names.txt': lines(classes) };
    },
  },
  {
    id: 'label-studio',
    title: 'Label Studio',
    hint: 'A task for each frame with brush labels as predictions.',
    make: async (exported) => {
      const tasks: unknown[] = [];
      for await (const frame of exported.frames()) tasks.push(encoders.encodeLabelStudio(...given(exported, frame), { shape: 'brush' }));
      return { 'label-studio.json': json(tasks) };
    },
  },
  {
    id: 'label-studio-video',
    title: 'Label Studio, video',
    hint: 'One task with boxes that follow the objects.',
    make: async ({ clip, fromStart }) => ({ 'label-studio-video.json': json([await encoders.encodeLabelStudioVideo(fromStart.frames(), { ...fromStart.meta, clip: clip.name })]) }),
  },
];
