// The one door to write: labels as the files of an annotation tool.

import type { EncodedFile, Format, LabelFrame, LabelFrames, Metadata } from '../../types/formats.js';
import { invalidInput, invalidOption, isObject, reading, unreadable } from '../common/checks.js';
import { cocoImages, cocoVideo } from './coco.js';
import { cvatImages } from './cvat-images.js';
import { cvatVideo } from './cvat-video.js';
import { type Encoder, type Extent, frameOf, noFrames } from './frames.js';
import { labelStudio } from './label-studio.js';
import { type Settings, settingsOf } from './metadata.js';
import { mots } from './mots.js';
import { davis, masks } from './pictures.js';
import { yolo } from './yolo.js';

interface FormatEntry {
  begin: (settings: Settings) => Encoder;
  /** The files of a clip that have the same names whatever its frames are called. */
  files: readonly string[];
  /** Whether it holds tracks: a label must be the same object in all frames. */
  tracks?: boolean;
  /** Whether it says how many frames there are in a second. */
  timed?: boolean;
}

export const FORMATS: Readonly<Record<Format, FormatEntry>> = {
  coco: { begin: cocoImages('coco.json', 'rle'), files: ['coco.json'] },
  'coco-polygon': { begin: cocoImages('coco-polygon.json', 'polygon'), files: ['coco-polygon.json'] },
  'youtube-vis': { begin: cocoVideo, files: ['youtube-vis.json'], tracks: true },
  cvat: { begin: cvatImages('cvat.xml', 'mask'), files: ['cvat.xml'] },
  'cvat-polygon': { begin: cvatImages('cvat-polygon.xml', 'polygon'), files: ['cvat-polygon.xml'] },
  'cvat-video': { begin: cvatVideo, files: ['cvat-video.xml'], tracks: true },
  mots: { begin: mots, files: ['mots/gt/gt.txt', 'mots/gt/labels.txt', 'mots/seqinfo.ini'], tracks: true, timed: true },
  'label-studio': { begin: labelStudio('label-studio.json', 'brush'), files: ['label-studio.json'] },
  'label-studio-polygon': { begin: labelStudio('label-studio-polygon.json', 'polygon'), files: ['label-studio-polygon.json'] },
  yolo: { begin: yolo, files: ['yolo/names.txt', 'yolo/data.yaml'] },
  davis: { begin: davis, files: ['davis/ImageSets/2017/val.txt'] },
  masks: { begin: masks, files: [] },
};

export function isFormat(name: unknown): name is Format {
  return typeof name === 'string' && Object.hasOwn(FORMATS, name);
}

/** Encodes frames as they come: `add` returns the files of a frame, `finish` those about all of them. */
export class FrameEncoder {
  readonly #settings: Settings;
  readonly #encoder: Encoder;
  #extent: Extent | undefined;

  /** `one`: there is a single frame, and no clip. */
  constructor(format: unknown, metadata: unknown, one: boolean) {
    if (!isFormat(format)) throw invalidOption('format', `one of ${Object.keys(FORMATS).join(', ')}`, format);
    this.#settings = settingsOf(metadata, one);
    this.#encoder = FORMATS[format].begin(this.#settings);
  }

  add(given: unknown): EncodedFile[] {
    const frame = frameOf(given, this.#extent, this.#settings);
    const files = this.#encoder.add(frame) ?? [];
    this.#extent = { width: frame.width, height: frame.height, length: frame.index + 1 };
    return files;
  }

  finish(): EncodedFile[] {
    if (!this.#extent) throw invalidInput('there must be one frame at least');
    return this.#encoder.finish(this.#extent);
  }
}

/** What is given at once is read before this returns. */
export async function encode(format: Format, frames: LabelFrame | LabelFrames, metadata?: Metadata): Promise<EncodedFile[]> {
  const kind = reading(() => kindOf(frames));
  const encoder = new FrameEncoder(format, metadata, kind === 'frame');
  const files: EncodedFile[] = [];
  const add = (frame: unknown) => void files.push(...encoder.add(frame));
  try {
    if (kind === 'frame') add(frames);
    else if (kind === 'iterable') for (const frame of frames as Iterable<LabelFrame>) add(frame);
    else for await (const frame of frames as AsyncIterable<LabelFrame>) add(frame);
  } catch (thrown) {
    throw unreadable(thrown);
  }
  return [...files, ...encoder.finish()];
}

function kindOf(frames: unknown): 'frame' | 'iterable' | 'async' {
  if (typeof frames !== 'object' || frames === null) throw noFrames();
  if (Symbol.asyncIterator in frames) return 'async';
  if (Symbol.iterator in frames) return 'iterable';
  if (isObject(frames) && 'labels' in frames) return 'frame';
  throw noFrames();
}
