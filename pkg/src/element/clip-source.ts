// The frames of a clip in the element: a list, a video, frames that can be read, or a stream.

import type { ClipFrames, FrameSource } from '../../types/element-class.js';
import type { Pixels, ClipFrames as ReadableFrames, StreamSource } from '../../types/index.js';
import { type Place, pixelsOf } from './sources.js';
import { Video } from './video.js';

export interface ClipSource {
  /** For `openClip`; undefined for a stream. */
  frames?: ReadableFrames;
  /** For `segmentStream`. */
  stream?: StreamSource;
  /** Reads any frame, or one of a stream that has come. */
  picture: (index: number) => Promise<Pixels>;
  close?: () => void;
}

export async function sourceOf(given: ClipFrames | string, place: Place): Promise<ClipSource> {
  const decoded = (index: number, source: FrameSource) => pixelsOf(`frame ${index}`, source, place);
  if (typeof given === 'string') {
    const video = new Video(new URL(given, place.base).href);
    await video.open();
    const picture = (index: number) => video.read(index);
    return { frames: { length: video.length, read: picture }, picture, close: () => video.close() };
  }
  if (Array.isArray(given) || 'read' in Object(given)) {
    const list = Array.isArray(given) ? listed(given.slice()) : (given as Readable);
    const picture = async (index: number) => decoded(index, await list.read(index));
    return { frames: { length: list.length, read: picture }, picture };
  }
  const pictures: Promise<Blob>[] = [];
  async function* once(frames: AsyncIterable<FrameSource>) {
    for await (const frame of frames) {
      const pixels = await decoded(pictures.length, frame);
      pictures.push(pictureOf(pixels));
      yield pixels;
    }
  }
  const isIterable = Symbol.asyncIterator in Object(given) || Symbol.iterator in Object(given);
  // `segmentStream` refuses frames that are no source.
  const stream = isIterable ? once(given as AsyncIterable<FrameSource>) : (given as never);
  return { stream, picture: async (index) => decoded(index, await (pictures[index] as Promise<Blob>)) };
}

type Readable = Extract<ClipFrames, { read: unknown }>;

function listed(frames: FrameSource[]): Readable {
  return { length: frames.length, read: (index) => frames[index] as FrameSource };
}

/** A frame of a stream, kept to be shown again: lossy, since nothing is computed from it. */
function pictureOf({ data, width, height }: Pixels): Promise<Blob> {
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')?.putImageData(new ImageData(new Uint8ClampedArray(data), width, height), 0, 0);
  return canvas.convertToBlob({ type: 'image/webp', quality: 0.9 });
}
