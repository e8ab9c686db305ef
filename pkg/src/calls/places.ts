// Frames that are given as something else than their pixels: files in Node, pictures in browsers and their workers.

import type { FrameFile, FrameInput, FramePicture, PairOptions, Pixels } from '../../types/index.js';

/** A call that takes two frames. */
export type PairCall<Frame, Options, Result> = (first: Frame, second: Frame, options?: Options) => Promise<Result>;

export interface Places {
  /** A frame, read unless it is pixels; one that is larger than `maxSize` may be scaled down. `name` is how errors call it. */
  frame(given: unknown, maxSize?: number, name?: string): Promise<unknown>;
  /** A call whose frames need not be pixels. */
  pair<Options extends PairOptions, Result>(call: PairCall<Pixels, Options, Result>): PairCall<FrameInput, Options, Result>;
}

/** `isOurs` tells what `read` gives the pixels of. */
export function placesBy<Given extends FrameFile | FramePicture>(
  isOurs: (frame: unknown) => frame is Given,
  read: (frame: Given, maxSize: number | undefined, name: string) => Promise<Pixels>,
): Places {
  const frame = async (given: unknown, maxSize?: number, name = 'the frame') => (isOurs(given) ? read(given, maxSize, name) : given);
  const pair =
    <Options extends PairOptions, Result>(call: PairCall<Pixels, Options, Result>): PairCall<FrameInput, Options, Result> =>
    (first, second, options) => {
      // Two frames of pixels are taken at once, and held no longer than by the call itself.
      if (![first, second].some(isOurs)) return call(first as Pixels, second as Pixels, options);
      const { maxSize } = Object(options) as PairOptions;
      const frames = [frame(first, maxSize, 'the first frame'), frame(second, maxSize, 'the second frame')];
      // Of two that fail the first is named, whichever fails sooner.
      const settled = Promise.allSettled(frames).then(() => Promise.all(frames));
      return settled.then(([one, other]) => call(one as Pixels, other as Pixels, options));
    };
  return { frame, pair };
}

/** The name of a value's class, the same in every realm. */
export function kindOf(value: unknown): string {
  try {
    return Object.prototype.toString.call(value).slice('[object '.length, -1);
  } catch {
    return ''; // A revoked proxy, which whoever takes it refuses.
  }
}

/** Whether it is a picture of the browser. */
export function isPicture(frame: unknown): frame is FramePicture {
  return /^(?:Blob|File|ImageBitmap|VideoFrame|OffscreenCanvas|HTML(?:Image|Canvas)Element)$/.test(kindOf(frame));
}

/** The pixels of a picture as it is now: its copy is made before what reads it is loaded. `name` is how errors call it. */
export async function pixelsOfPicture(name: string, picture: FramePicture): Promise<Pixels> {
  // Pixels as the file has them.
  const options = { imageOrientation: 'from-image', colorSpaceConversion: 'none', premultiplyAlpha: 'none' } as const;
  const copying = new Promise<ImageBitmap>((resolve) => resolve(createImageBitmap(picture as ImageBitmapSource, options)));
  const [bitmap] = await Promise.allSettled([copying]);
  return (await import('./pictures.js')).pixelsOfCopy(name, kindOf(picture), bitmap);
}

/** Those of browsers. */
export const pictures = placesBy(isPicture, (picture, _, name) => pixelsOfPicture(name, picture));
