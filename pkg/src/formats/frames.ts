// The frames of a clip, one after another: each is checked and encoded before the next is asked for, so that one is held at a time.

import type { ClipMeta, Encoded, FormatMeta, LabelFrame, LabelFrames } from '../../types/formats.js';
import { invalidInput, isFrameRate, isObject, isRising, reading, UNLABELLED, unreadable } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { checkedMeta, checkLabels, imageOf, isFinite, isText, type Mask, masksOf } from './input.js';

/** Metadata of a clip, checked. */
export interface Clip extends FormatMeta {
  name: string;
  tracked: boolean;
  /** Frames per second. */
  rate: number;
  /** How many frames have a time, if any. */
  times: number | undefined;
  /** The time of a frame in seconds. */
  time(index: number): number;
  /** Seconds to the end of the last of so many frames. */
  duration(length: number): number;
}

export interface Frame {
  index: number;
  /** Name of its file. */
  image: string;
  width: number;
  height: number;
  masks: Mask[];
}

/** The size of the frames, and how many there were. */
export interface Extent {
  width: number;
  height: number;
  length: number;
}

/** The content of a document, frame by frame. */
export interface Gathering<Document> {
  add(frame: Frame): void;
  finish(extent: Extent): Document;
}

type Start<Document> = () => { add: (frame: LabelFrame) => void; finish: () => Document };

/** Frames per second where none are given and a format has to have them. */
export const USUAL_RATE = 25;

/**
 * The document of all frames. Throws, or rejects with, `invalid-input` where there is none or one is no frame, and
 * `frame-size-mismatch`.
 */
export function gathered<Frames extends LabelFrames, Document>(
  frames: Frames,
  meta: unknown,
  begin: (clip: Clip) => Gathering<Document>,
): Encoded<Frames, Document> {
  const start: Start<Document> = () => {
    const clip = checkedClip(meta);
    const gathering = begin(clip);
    let extent: Extent | undefined;
    return {
      add(given) {
        const frame = checkedFrame(given, extent, clip);
        gathering.add(frame);
        extent = { width: frame.width, height: frame.height, length: frame.index + 1 };
      },
      finish() {
        if (!extent) throw invalidInput('there must be one frame at least');
        return gathering.finish(extent);
      },
    };
  };
  return (isAsync(frames) ? fromAsync(frames, start) : fromSync(frames, start)) as Encoded<Frames, Document>;
}

function isAsync(frames: LabelFrames): frames is AsyncIterable<LabelFrame> {
  return reading(() => isObject(frames) && Symbol.asyncIterator in frames);
}

function fromSync<Document>(frames: Iterable<LabelFrame>, start: Start<Document>): Document {
  const { add, finish } = start();
  reading(() => {
    if (typeof Object(frames)[Symbol.iterator] !== 'function') throw noFrames();
    for (const frame of frames) add(frame);
  });
  return finish();
}

async function fromAsync<Document>(frames: AsyncIterable<LabelFrame>, start: Start<Document>): Promise<Document> {
  const { add, finish } = start();
  try {
    for await (const frame of frames) add(frame);
  } catch (thrown) {
    throw unreadable(thrown);
  }
  return finish();
}

/** The frame after those of the `extent`. */
function checkedFrame(given: unknown, extent: Extent | undefined, clip: Clip): Frame {
  const index = extent?.length ?? 0;
  if (!isObject(given)) throw noFrames();
  const { labels, width, height, image, motions } = given as unknown as LabelFrame;
  checkLabels(labels, width, height);
  if (!isText(image)) throw invalidInput("a frame's image must be text, the name of its file");
  if (clip.times !== undefined && index >= clip.times) throw invalidInput('timestamps must have a number for each frame');
  if (!isFinite(clip.duration(index + 1))) throw invalidInput('the times of the frames are too large');
  if (extent && (width !== extent.width || height !== extent.height)) {
    throw new VeroneseError('frame-size-mismatch', 'the frames must have one size');
  }
  const { names, classes, labels: wanted, motions: always } = clip;
  const meta = { names, classes, labels: wanted, motions: motions === undefined ? always : motions };
  const masks = masksOf(labels, width, height, meta as FormatMeta);
  return { index, image: image ?? (index === 0 ? imageOf(clip) : `frame-${index}.png`), width, height, masks };
}

function noFrames(): VeroneseError {
  return invalidInput('the frames must be a list of { labels, width, height }, or what gives one after another');
}

function checkedClip(meta: unknown): Clip {
  const known = checkedMeta(meta, ['clip', 'frameRate', 'timestamps', 'tracked']);
  return reading(() => {
    const given = (meta ?? {}) as ClipMeta;
    const { clip = 'clip', frameRate, timestamps, tracked = false } = given;
    if (typeof clip !== 'string') throw invalidInput('clip must be text, a name');
    if (typeof tracked !== 'boolean') throw invalidInput('tracked must be true or false');
    if (frameRate !== undefined && !(isFinite(frameRate) && frameRate > 0)) throw invalidInput('frameRate must be a number above 0');
    if (timestamps !== undefined && !isRising(timestamps)) throw invalidInput('timestamps must be numbers, none below the one before it');
    const rate = rateOf(given) ?? USUAL_RATE;
    const time = (index: number) => timestamps?.[index] ?? index / rate;
    return { ...known, name: clip, tracked, rate, times: timestamps?.length || undefined, time, duration: (length) => (timestamps ? time(length - 1) - time(0) + 1 / rate : length / rate) };
  });
}

/** The number of frames per second, the mean where only times are given. */
export function rateOf({ frameRate, timestamps = [] }: Pick<ClipMeta, 'frameRate' | 'timestamps'>): number | undefined {
  if (frameRate !== undefined) return frameRate;
  const [first, last] = [timestamps[0], timestamps.at(-1)];
  const rate = (timestamps.length - 1) / ((last ?? 0) - (first ?? 0));
  return isFrameRate(rate) ? rate : undefined;
}

/** A label as a number where 0 means none: no mask has 255. */
export function idOf(label: number): number {
  return label === 0 ? UNLABELLED : label;
}

/** Gives each entry that is new the next number, from 1. */
export class Numbering {
  readonly entries: string[] = [];

  constructor(first: readonly string[] = []) {
    for (const entry of first) this.of(entry);
  }

  of(entry: string): number {
    const found = this.entries.indexOf(entry);
    return found < 0 ? this.entries.push(entry) : found + 1;
  }
}
