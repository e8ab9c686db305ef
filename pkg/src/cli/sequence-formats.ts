// The formats that `veronese convert` writes of many frames: a name, the files, and the encoder.

import type { ClipMeta, FormatMeta, MotFiles } from '../../types/formats.js';
import { maskOf } from '../calls/labels.js';
import { encodeGreyPng } from '../entries/codecs.js';
import * as formats from '../formats/index.js';
import type { Content, Write } from './output.js';
import type { Sequence, SequenceFrame } from './sequence.js';

export interface SequenceSettings {
  /** Shapes of tracks, where the format has a choice. */
  shapes: 'polygon' | 'box';
  /** Of polygons, pixels. */
  tolerance: number;
  /** Name of the video's file. */
  video?: string;
}

type Convert = (sequence: Sequence, settings: SequenceSettings, write: Write) => Promise<void>;

interface SequenceFormat {
  convert: Convert;
  /** Those of its files that have the same name whatever the frames are called. */
  files: readonly string[];
  /** Whether a label must be the same object in all frames. */
  tracks: boolean;
  /** Whether files say when frames are, or how many there are in a second. */
  timed?: boolean;
}

type Files = Pick<SequenceFormat, 'convert' | 'files'>;

const images = (files: Files): SequenceFormat => ({ ...files, tracks: false });
const tracks = (files: Files): SequenceFormat => ({ ...files, tracks: true });
const timed = (files: Files): SequenceFormat => ({ ...files, tracks: true, timed: true });

/** One file of all frames. */
function whole(name: string, encode: (sequence: Sequence, settings: SequenceSettings) => Promise<Content | object>): Files {
  const convert: Convert = async (sequence, settings, write) => {
    const document = await encode(sequence, settings);
    await write(name, typeof document === 'string' || document instanceof Uint8Array ? document : json(document));
  };
  return { convert, files: [name] };
}

type Encode<T> = (all: readonly [Uint8Array, number, number, FormatMeta], settings: SequenceSettings, index: number) => T;

/** One list in JSON, to which each frame adds. It is written as it comes: of a long clip it can be larger than the memory. */
function list(name: string, encode: Encode<readonly object[]>): Files {
  const convert: Convert = async (sequence, settings, write) => {
    await write(name, lines());
    async function* lines(): AsyncGenerator<string, void, undefined> {
      let [index, before] = [0, '['];
      for await (const frame of sequence) {
        for (const entry of encode(given(sequence, frame), settings, index)) {
          yield before + JSON.stringify(entry);
          before = ',\n';
        }
        index++;
      }
      yield before === '[' ? '[]\n' : ']\n';
    }
  };
  return { convert, files: [name] };
}

/** A file for each frame. */
function each(nameOf: (frame: SequenceFrame) => string, encode: Encode<Content | object>): Files {
  const convert: Convert = async (sequence, settings, write) => {
    let index = 0;
    for await (const frame of sequence) {
      const content = encode(given(sequence, frame), settings, index++);
      await write(nameOf(frame), typeof content === 'string' || content instanceof Uint8Array ? content : json(content));
    }
  };
  return { convert, files: [] };
}

/** A file for each frame that moves on to a next one. */
function flow(shape: 'flo' | 'npy'): Files {
  const convert: Convert = async (sequence, _, write) => {
    for await (const frame of sequence) {
      if ((frame.motions ?? []).length > 0) await write(`${shape}/${frame.stem}.${shape}`, formats.encodeFlow(...given(sequence, frame), { shape }));
    }
  };
  return { convert, files: [] };
}

/** Options of the encoders of videos. */
function videoMeta({ meta }: Sequence, { video }: SequenceSettings): ClipMeta {
  return { ...meta, clip: video ?? meta.clip };
}

/** Arguments of the encoders of one image. */
function given({ meta: { names, labels } }: Sequence, { labels: pixels, width, height, image, motions = [] }: SequenceFrame) {
  return [pixels, width, height, { image, names, labels, motions }] as const;
}

/** A folder as MOTChallenge's sequences are. */
function motFolder(folder: string, encode: (sequence: Sequence) => Promise<MotFiles>): Files {
  const files = ['gt/gt.txt', 'gt/labels.txt', 'seqinfo.ini'].map((name) => `${folder}/${name}`);
  const convert: Convert = async (sequence, _, write) => {
    const { gt, seqinfo, names } = await encode(sequence);
    for (const [k, content] of [gt, lines(names), seqinfo].entries()) await write(files[k] as string, content);
  };
  return { convert, files };
}

const DAVIS_CLIPS = 'davis/ImageSets/2017/val.txt';

async function davis(sequence: Sequence, _: SequenceSettings, write: Write): Promise<void> {
  const { clip } = sequence.meta;
  for await (const { labels, width, height, stem } of sequence) {
    await write(`davis/Annotations/480p/${clip}/${stem}.png`, formats.encodeDavis(labels, width, height));
  }
  await write(DAVIS_CLIPS, `${clip}\n`);
}

const YOLO_NAMES = 'yolo/names.txt';
const YOLO_DATA = 'yolo/data.yaml';

/** The classes have the same numbers in all frames. */
async function yolo(sequence: Sequence, { tolerance }: SequenceSettings, write: Write): Promise<void> {
  const { names, labels } = sequence.meta;
  const classes = [...new Set(labels.map((label) => names[label] as string))];
  for await (const frame of sequence) {
    const { text } = formats.encodeYolo(...given(sequence, frame), { tolerance, classes });
    await write(`yolo/labels/${frame.stem}.txt`, text);
  }
  await write(YOLO_NAMES, lines(classes));
  // Labels are looked for in the folder beside that of the images, where the frames belong. Quoted as JSON, names are YAML too.
  const numbered = classes.map((name, number) => `  ${number}: ${JSON.stringify(name)}`);
  await write(YOLO_DATA, lines(['train: images', 'val: images', 'names:', ...numbered]));
}

async function masks(sequence: Sequence, _: SequenceSettings, write: Write): Promise<void> {
  const wanted = new Set(sequence.meta.labels);
  for await (const { labels, width, height, stem } of sequence) {
    for (const label of new Set(labels)) {
      if (wanted.has(label)) await write(`masks/${label}/${stem}.png`, await encodeGreyPng(width, height, maskOf(labels, label)));
    }
  }
}

export const SEQUENCE_FORMATS = {
  coco: images(whole('coco.json', (frames) => formats.encodeCocoImages(frames, frames.meta, { shape: 'rle' }))),
  'coco-polygon': images(
    whole('coco-polygon.json', (frames, { tolerance }) => formats.encodeCocoImages(frames, frames.meta, { shape: 'polygon', tolerance })),
  ),
  'youtube-vis': tracks(whole('youtube-vis.json', (frames) => formats.encodeCocoVideo(frames, frames.meta))),
  cvat: images(whole('cvat.xml', (frames) => formats.encodeCvatImages(frames, frames.meta, { shape: 'mask' }))),
  'cvat-polygon': images(
    whole('cvat-polygon.xml', (frames, { tolerance }) => formats.encodeCvatImages(frames, frames.meta, { shape: 'polygon', tolerance })),
  ),
  'cvat-video': tracks(
    whole('cvat-video.xml', (frames, settings) =>
      formats.encodeCvatVideo(frames, videoMeta(frames, settings), { shape: settings.shapes, tolerance: settings.tolerance }),
    ),
  ),
  'cvat-points': images(list('cvat-points.json', (all, _, frame) => formats.encodeCvatPoints(...all).map((shape) => ({ ...shape, frame })))),
  'cvat-mots': tracks(whole('cvat-mots.zip', (frames) => formats.encodeCvatMots(frames, frames.meta))),
  mots: timed(motFolder('mots', (frames) => formats.encodeMots(frames, frames.meta))),
  mot: timed(motFolder('mot', (frames) => formats.encodeMotChallenge(frames, frames.meta))),
  'label-studio': images(list('label-studio.json', (all) => [formats.encodeLabelStudio(...all, { shape: 'brush' })])),
  'label-studio-polygon': images(
    list('label-studio-polygon.json', (all, { tolerance }) => [formats.encodeLabelStudio(...all, { shape: 'polygon', tolerance })]),
  ),
  'label-studio-video': timed(
    whole('label-studio-video.json', async (frames, settings) => [await formats.encodeLabelStudioVideo(frames, videoMeta(frames, settings))]),
  ),
  labelme: images(each(({ stem }) => `labelme/${stem}.json`, (all) => formats.encodeLabelMe(...all, { shape: 'mask' }))),
  'labelme-polygon': images(
    each(({ stem }) => `labelme-polygon/${stem}.json`, (all, { tolerance }) => formats.encodeLabelMe(...all, { shape: 'polygon', tolerance })),
  ),
  yolo: images({ convert: yolo, files: [YOLO_NAMES, YOLO_DATA] }),
  davis: images({ convert: davis, files: [DAVIS_CLIPS] }),
  flo: images(flow('flo')),
  npy: images(flow('npy')),
  supervisely: images(each(({ image }) => `supervisely/ann/${image}.json`, (all) => formats.encodeSupervisely(...all))),
  'web-annotation': images(
    list('web-annotation.json', (all, { tolerance }) =>
      formats.encodeWebAnnotation(...all, { tolerance }).map((annotation) => ({ ...annotation, id: `${all[3].image}${annotation.id}` })),
    ),
  ),
  veronese: images(each(({ stem }) => `veronese/${stem}.json`, (all) => formats.encodeVeronese(...all))),
  masks: images({ convert: masks, files: [] }),
} satisfies Record<string, SequenceFormat>;

export type SequenceFormatName = keyof typeof SEQUENCE_FORMATS;

export function isSequenceFormatName(name: string): name is SequenceFormatName {
  return Object.hasOwn(SEQUENCE_FORMATS, name);
}

function json(value: object): string {
  return `${JSON.stringify(value)}\n`;
}

function lines(texts: readonly string[]): string {
  return texts.map((text) => `${text}\n`).join('');
}
