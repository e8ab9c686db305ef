//! The formats of clips as data. The encoders are the package's, the same that `veronese convert` uses. Loaded on first use.

import * as encoders from 'veronese/formats';
import type { FormatMeta, MotFiles } from 'veronese/formats';
import type { ClipExport, ClipFile, ClipFormat } from './clip-export.js';
import { videoFormats } from './clip-video.js';
import { TOLERANCE } from './format.js';
import { pngFromLabels } from './png.js';

type Files = Record<string, string | Uint8Array>;

function json(value: unknown): string {
  return `${JSON.stringify(value)}\n`;
}

function lines(texts: readonly string[]): string {
  return texts.map((text) => `${text}\n`).join('');
}

/** The arguments of the encoders of one image. */
function given({ meta: { names, classes, labels } }: ClipExport, frame: ClipFile): readonly [Uint8Array, number, number, FormatMeta] {
  return [frame.labels, frame.width, frame.height, { image: frame.image, names, ...(classes && { classes }), labels, motions: frame.motions ?? [] }];
}

/** How a format makes one file. */
function file(name: string, content: (exported: ClipExport) => Promise<string | Uint8Array>): Pick<ClipFormat, 'names' | 'make'> {
  return { names: () => [name], make: async (exported) => ({ [name]: await content(exported) }) };
}

/** How a format makes a file for each frame, and others after them. */
function fileForEach(
  path: (exported: ClipExport, stem: string) => string,
  content: (exported: ClipExport, frame: ClipFile) => string | Promise<Uint8Array>,
  others: (exported: ClipExport) => Files,
): Pick<ClipFormat, 'names' | 'make'> {
  return {
    names: (exported) => [...exported.stems.map((stem) => path(exported, stem)), ...Object.keys(others(exported))],
    make: async (exported) => {
      const files: Files = {};
      for await (const frame of exported.frames()) files[path(exported, frame.stem)] = await content(exported, frame);
      return { ...files, ...others(exported) };
    },
  };
}

/** A folder as MOTChallenge's sequences are. */
function sequence(folder: string, encode: (exported: ClipExport) => Promise<MotFiles>): Pick<ClipFormat, 'names' | 'make'> {
  const paths = [`${folder}/gt/gt.txt`, `${folder}/gt/labels.txt`, `${folder}/seqinfo.ini`] as const;
  return {
    names: () => paths,
    make: async (exported) => {
      const { gt, seqinfo, names } = await encode(exported);
      return { [paths[0]]: gt, [paths[1]]: lines(names), [paths[2]]: seqinfo };
    },
  };
}

/** The names of the classes, each once: those of the list, then others. */
function classesOf({ meta: { names, classes = [], labels } }: ClipExport): string[] {
  return [...new Set([...classes, ...labels.map((label) => names[label]!)])];
}

/** All formats that this browser can write, in the order of the menu. */
export async function clipFormats(): Promise<readonly ClipFormat[]> {
  return [...FORMATS, ...(await videoFormats())];
}

const FORMATS: readonly ClipFormat[] = [
  {
    id: 'cvat-video',
    title: 'CVAT, tracks',
    hint: 'CVAT for video 1.1: a track with polygons for each object.',
    ...file('cvat-video.xml', async ({ clip, fromStart }) => await encoders.encodeCvatVideo(fromStart.frames(), { ...fromStart.meta, clip: clip.name }, { shape: 'polygon', tolerance: TOLERANCE })),
  },
  {
    id: 'cvat-mots',
    title: 'CVAT, MOTS PNG',
    hint: 'An archive to import into CVAT: exact masks, up to 64 objects.',
    ...file('cvat-mots.zip', async (exported) => await encoders.encodeCvatMots(exported.frames(), exported.meta)),
  },
  {
    id: 'youtube-vis',
    title: 'YouTube-VIS',
    hint: 'The objects of the clip as compressed run lengths in the form of COCO.',
    ...file('youtube-vis.json', async (exported) => json(await encoders.encodeCocoVideo(exported.frames(), exported.meta))),
  },
  {
    id: 'coco',
    title: 'COCO, RLE',
    hint: 'Every frame is an image; objects have a track_id.',
    ...file('coco.json', async (exported) => json(await encoders.encodeCocoImages(exported.frames(), exported.meta, { shape: 'rle' }))),
  },
  {
    id: 'mots',
    title: 'MOTS',
    hint: 'The text form of MOTS, with the names of the classes.',
    ...sequence('mots', (exported) => encoders.encodeMots(exported.frames(), exported.meta)),
  },
  {
    id: 'mot',
    title: 'MOTChallenge',
    hint: 'Boxes of the objects in every frame.',
    ...sequence('mot', (exported) => encoders.encodeMotChallenge(exported.frames(), exported.meta)),
  },
  {
    id: 'davis',
    title: 'DAVIS',
    hint: 'An indexed PNG for each frame: the index is the number of the object.',
    ...fileForEach(
      ({ meta }, stem) => `davis/Annotations/480p/${meta.clip}/${stem}.png`,
      (_exported, { labels, width, height }) => pngFromLabels(labels, width, height),
      ({ meta }) => ({ 'davis/ImageSets/2017/val.txt': `${meta.clip}\n` }),
    ),
  },
  {
    id: 'yolo',
    title: 'YOLO segmentation',
    hint: 'A text file for each frame with a line per object, and the names of the classes.',
    ...fileForEach(
      (_exported, stem) => `yolo/labels/${stem}.txt`,
      (exported, frame) => encoders.encodeYolo(...given(exported, frame), { classes: classesOf(exported), tolerance: TOLERANCE }).text,
      (exported) => ({ 'yolo/names.txt': lines(classesOf(exported)) }),
    ),
  },
  {
    id: 'label-studio',
    title: 'Label Studio',
    hint: 'A task for each frame with brush labels as predictions.',
    ...file('label-studio.json', async (exported) => {
      const tasks: unknown[] = [];
      for await (const frame of exported.frames()) tasks.push(encoders.encodeLabelStudio(...given(exported, frame), { shape: 'brush' }));
      return json(tasks);
    }),
  },
  {
    id: 'label-studio-video',
    title: 'Label Studio, video',
    hint: 'One task with boxes that follow the objects.',
    ...file('label-studio-video.json', async ({ clip, fromStart }) => json([await encoders.encodeLabelStudioVideo(fromStart.frames(), { ...fromStart.meta, clip: clip.name })])),
  },
];
