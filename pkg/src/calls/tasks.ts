// The calls as tasks: what callers hand in, checked and taken. The same for direct calls and for workers, so that both refuse the same.

import type {
  CallOptions,
  FitOptions,
  MotionFit,
  PairOptions,
  Pixels,
  PointMeasurements,
  Segmentation,
  SegmentOptions,
} from '../../types/index.js';
import {
  checkAttached,
  entriesOf,
  invalidInput,
  invalidOption,
  isArrayOf,
  isWhole,
  LONGEST_SIDE,
  reading,
  type TypedArray,
} from '../common/checks.js';
import { cancelled, VeroneseError } from '../common/errors.js';
import { scaled, scaledSize } from '../common/scaling.js';
import type { CallTask, Frames, Result, Settings } from './messages.js';
import { taken } from './taking.js';

/** Shortest side of a frame, pixels: what the core segments. */
const SHORTEST_SIDE = 16;
/** Longest side of a frame that is to be scaled down, pixels: as of files. */
const LARGE_SIDE = 4 * LONGEST_SIDE;

/** Frames that need not be pixels. */
const PICTURES = 'in browsers an ImageBitmap, VideoFrame, Blob, image or canvas, in Node a path, address, Blob or stream';

/** A task, how it is to be run, and what its result becomes for the caller. */
export interface Call<T> {
  task: CallTask;
  options: CallOptions;
  finish: (result: Result) => T;
}

/** Does a task, here or in a worker. */
export type Perform = (task: CallTask, options: CallOptions) => Promise<Result>;

/**
 * Checks and takes at once; what is thrown becomes a rejection. Not an `async` function: while it waited it would hold what it was
 * given, the caller's arrays.
 */
export function start<T>(prepare: () => Call<T>, perform: Perform): Promise<T> {
  try {
    const { task, options, finish } = reading(prepare);
    return perform(task, options).then(finish);
  } catch (thrown) {
    return Promise.reject(thrown);
  }
}

export function segmentCall(first: Pixels, second: Pixels, options?: SegmentOptions): Call<Segmentation> {
  const asked = parted(options, ['motions', 'quality', 'markUnknown', 'subject', 'confidence', 'maxSize']);
  const { maxSize } = asked;
  const frames = checkedFrames(first, second, maxSize);
  const own = takenFor(asked, dataOf(frames));
  const task: CallTask = { call: 'segmentPair', frames: framesWith(own, frames, maxSize), settings: asked.settings };
  return { task, options: asked.call, finish: (result) => result as Segmentation };
}

export function solveCall(before: Pixels, frame: Pixels, options?: PairOptions): Call<Uint8Array> {
  const asked = parted(options, ['motions', 'quality', 'subject', 'maxSize']);
  const frames = checkedFrames(before, frame, asked.maxSize);
  const own = takenFor(asked, dataOf(frames));
  const task: CallTask = { call: 'solvePair', frames: framesWith(own, frames, asked.maxSize), settings: asked.settings };
  return { task, options: asked.call, finish: (result) => result as Uint8Array };
}

export function fitCall(measurements: PointMeasurements, options?: FitOptions): Call<MotionFit> {
  const asked = parted(options, ['motions', 'method', 'seed']);
  const { positions, derivatives } = Object(measurements) as Partial<PointMeasurements>;
  const whole = [
    checkedArray('the positions', positions, 'Float64Array', 'of x and y of each measurement'),
    checkedArray('the derivatives', derivatives, 'Float64Array', 'of I_x, I_y and I_t of each measurement'),
  ];
  const [xy, ixyt] = takenFor(asked, whole) as [Float64Array, Float64Array];
  const task: CallTask = { call: 'fitMotions', measurements: { positions: xy, derivatives: ixyt }, settings: asked.settings };
  return { task, options: asked.call, finish: (result) => result as MotionFit };
}

interface Asked {
  call: CallOptions;
  transfer: boolean;
  /** Longest side to which frames are scaled down. */
  maxSize: number | undefined;
  settings: Settings;
}

/** Parts what concerns the call from what goes to the core, which checks its values. */
export function parted(options: unknown, known: readonly string[]): Asked {
  const { signal, onProgress, transfer = false, maxSize, ...settings } = entriesOf(options, [...known, 'signal', 'onProgress', 'transfer']);
  if (signal !== undefined && !isSignal(signal)) throw new VeroneseError('invalid-option', "option 'signal': must be an AbortSignal");
  if (onProgress !== undefined && typeof onProgress !== 'function') throw invalidOption('onProgress', 'a function', onProgress);
  if (typeof transfer !== 'boolean') throw invalidOption('transfer', 'true or false', transfer);
  if (maxSize !== undefined && !isWhole(maxSize, SHORTEST_SIDE, LONGEST_SIDE)) {
    throw invalidOption('maxSize', `a whole number of pixels from ${SHORTEST_SIDE} to ${LONGEST_SIDE}`, maxSize);
  }
  for (const [name, value] of Object.entries(settings)) {
    // Not all of these reach a worker, and no option is one of them.
    if (/object|function|symbol/.test(typeof value) && value !== null) throw invalidOption(name, 'a plain value', value);
  }
  return { call: { signal, onProgress: onProgress as CallOptions['onProgress'] }, transfer, maxSize, settings };
}

/** Whatever works like one: other realms and older environments have classes of their own. */
function isSignal(value: unknown): value is AbortSignal {
  // oxlint-disable-next-line typescript/unbound-method -- only looked at, never called
  const { aborted, addEventListener, removeEventListener } = Object(value) as AbortSignal;
  return typeof aborted === 'boolean' && typeof addEventListener === 'function' && typeof removeEventListener === 'function';
}

/** Nothing is taken for a call that will not be made. */
function takenFor({ call: { signal }, transfer }: Asked, arrays: readonly TypedArray[]): TypedArray[] {
  if (signal?.aborted) throw cancelled(signal);
  return taken(arrays, transfer);
}

function checkedFrames(first: unknown, second: unknown, maxSize?: number): Pixels[] {
  return [checkedPixels('the first frame', first, maxSize), checkedPixels('the second frame', second, maxSize)];
}

/** A frame of the right shape and size, in the core's words; whether it has the size of the others is the core's question. */
export function checkedPixels(which: string, pixels: unknown, maxSize?: number): Pixels {
  const { data, width, height } = Object(pixels) as Partial<Pixels>;
  if (!isArrayOf(data, 'Uint8Array', 'Uint8ClampedArray')) {
    if (isNamed(pixels))
      throw invalidInput(`${which} is a path, an address or a stream: only 'veronese' in Node reads these, decode it first`);
    throw invalidInput(`${which} must be { data, width, height } with RGBA bytes, like ImageData, or a picture: ${PICTURES}`);
  }
  if (!isWhole(width, 0, Infinity) || !isWhole(height, 0, Infinity)) {
    throw invalidInput(`${which}: width and height must be whole numbers of pixels`);
  }
  const size = `a frame of ${width}×${height} pixels`;
  const now = scaledSize({ width, height }, maxSize);
  if (Math.max(width, height) > LARGE_SIDE || ![now.width, now.height].every((side) => isWhole(side, SHORTEST_SIDE, LONGEST_SIDE))) {
    const remedy = maxSize === undefined && Math.max(width, height) > LONGEST_SIDE ? "; option 'maxSize' scales larger ones down" : '';
    const sides = `both sides must be between ${SHORTEST_SIDE} and ${LONGEST_SIDE} pixels${remedy}`;
    throw new VeroneseError('frame-size-unsupported', `${size} cannot be processed: ${sides}`);
  }
  checkAttached(which, data);
  const needed = 4 * width * height;
  if (data.length !== needed) throw new VeroneseError('pixel-count-mismatch', `${size} needs ${needed} RGBA bytes, found ${data.length}`);
  return { data, width, height };
}

/** Whether it stands for pixels that are elsewhere. */
function isNamed(frame: unknown): boolean {
  return (
    typeof frame === 'string' ||
    frame instanceof URL ||
    typeof (Object(frame) as Partial<AsyncIterable<unknown>>)[Symbol.asyncIterator] === 'function'
  );
}

const dataOf = (frames: readonly Pixels[]) => frames.map(({ data }) => data);

function framesWith(arrays: readonly TypedArray[], sizes: readonly Pixels[], maxSize?: number): Frames {
  return sizes.map(({ width, height }, k) => scaled({ data: arrays[k] as Uint8Array, width, height }, maxSize)) as unknown as Frames;
}

function checkedArray(which: string, array: unknown, kind: string, of: string): TypedArray {
  if (!isArrayOf(array, kind)) throw invalidInput(`${which} must be a ${kind} ${of}`);
  checkAttached(which, array);
  return array;
}
