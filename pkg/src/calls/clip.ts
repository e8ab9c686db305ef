// Clips: frames in, labelled frames and tracks out. Direct calls and workers share this.

import type { Clip, ClipFrame, ClipOptions, ClipProgress, ClipSource, Pixels } from '../../types/index.js';
import { invalidInput, isWhole, reading } from '../common/checks.js';
import { cancelled, VeroneseError } from '../common/errors.js';
import type { ClipEnd, Result, Settings } from './messages.js';
import { inOrder } from './ordered.js';
import { taken } from './taking.js';
import { checkedPixels, parted, type Perform } from './tasks.js';
import { Tracks } from './tracks.js';

/** Default look-ahead of a stream, frames: the longest there is. */
const LOOK_AHEAD_OF_STREAMS = 8;

/** Where a clip is kept between its frames: in this thread, or in a worker reserved for it. */
export interface Place {
  perform: Perform;
  release: () => void;
}

/** Number of clips so far. Each number is used once, because a module that replaces another after a panic must not find a clip under it. */
let clips = 0;

/** `reserve` finds a place for the clip. Arguments are checked when the first frame is requested, as generators do. */
export function clipOf(frames: ClipSource, options: ClipOptions | undefined, reserve: (signal?: AbortSignal) => Promise<Place>): Clip {
  const tracks = new Tracks();
  return Object.assign(segmented(frames, options, reserve, tracks), { tracks: () => tracks.value() });
}

async function* segmented(
  frames: ClipSource,
  options: ClipOptions | undefined,
  reserve: (signal?: AbortSignal) => Promise<Place>,
  tracks: Tracks,
): AsyncGenerator<ClipFrame, void, undefined> {
  const { source, of, signal, onProgress, transfer, settings } = reading(() => asked(frames, options));
  if (signal?.aborted) throw cancelled(signal);
  const { perform, release } = await reserve(signal);
  const clip = clips++;
  let open = false;
  let size: Pixels | undefined;
  /** Whether the clip cannot continue, because a step of it failed and not a frame. */
  let lost = false;

  const work = async (input: unknown, index: number): Promise<Answer> => {
    try {
      const frame = reading(() => takenFrame(input, index, size, transfer));
      size ??= frame;
      lost = true;
      onProgress?.({ frame: index, of });
      const answer = { frame: found(await perform({ call: 'pushClip', clip, frame }, { signal })) as ClipFrame | undefined };
      lost = false;
      return answer;
    } catch (thrown) {
      return { failure: { thrown } };
    }
  };

  try {
    await perform({ call: 'beginClip', clip, settings }, { signal }).catch((thrown) => {
      // The worker may still begin a clip that was cancelled.
      open = signal?.aborted === true;
      throw thrown;
    });
    open = true;
    let failure: Answer['failure'];
    try {
      for await (const answer of inOrder(source, work, { room: 1, signal, stop: () => cancelled(signal) })) {
        if (answer.failure) throw answer.failure.thrown;
        if (answer.frame) yield tracks.add(answer.frame);
      }
    } catch (thrown) {
      if (lost || signal?.aborted) throw thrown;
      failure = { thrown };
    }
    // If the source failed, the frames before come first.
    const { frames: rest, dropped } = found(await perform({ call: 'finishClip', clip }, { signal })) as ClipEnd;
    open = false;
    tracks.dropped = dropped;
    for (const frame of rest) {
      if (signal?.aborted) throw cancelled(signal);
      yield tracks.add(frame);
    }
    if (failure) throw failure.thrown;
  } finally {
    // Not awaited. If it fails, the clip is gone already.
    if (open) void perform({ call: 'endClip', clip }, {}).catch(() => undefined).finally(release);
    else release();
  }
}

interface Answer {
  frame?: ClipFrame | undefined;
  failure?: { thrown: unknown };
}

interface Asked {
  source: Iterable<unknown> | AsyncIterable<unknown>;
  /** Number of frames, if known. */
  of: number | undefined;
  signal: AbortSignal | undefined;
  onProgress: ((progress: ClipProgress) => void) | undefined;
  transfer: boolean;
  settings: Settings;
}

function asked(frames: unknown, options: unknown): Asked {
  const { call, transfer, settings } = parted(options, ['motions', 'quality', 'seed', 'lookAhead']);
  const rest = { signal: call.signal, onProgress: call.onProgress as Asked['onProgress'], transfer };
  const { length, read } = Object(frames) as { length: unknown; read: unknown };
  if (typeof read === 'function') {
    if (!isWhole(length, 0, Infinity)) throw invalidInput("the frames: 'length' must be a whole number");
    return { source: readEach(frames as Parameters<typeof readEach>[0], length), of: length, settings: { lookAhead: 'all', ...settings }, ...rest };
  }
  const source = Object(frames) as Partial<Iterable<unknown> & AsyncIterable<unknown>>;
  if (typeof source[Symbol.asyncIterator] !== 'function' && typeof source[Symbol.iterator] !== 'function') {
    throw invalidInput('the frames must be an iterable or async iterable of pixels, or { length, read(index) }');
  }
  return { source: source as Asked['source'], of: undefined, settings: { lookAhead: LOOK_AHEAD_OF_STREAMS, ...settings }, ...rest };
}

function* readEach(frames: { read: (index: number) => unknown }, length: number): Generator<unknown, void, undefined> {
  for (let index = 0; index < length; index++) yield frames.read(index);
}

/** A copy of a frame, checked against the size of the frames before. */
function takenFrame(input: unknown, index: number, size: Pixels | undefined, transfer: boolean): Pixels {
  const { data, width, height } = checkedPixels(`frame ${index}`, input);
  if (size && (width !== size.width || height !== size.height)) {
    const sizes = `${width}×${height} pixels, those before have ${size.width}×${size.height}`;
    throw new VeroneseError('frame-size-mismatch', `frame ${index} has ${sizes}`);
  }
  return { data: taken([data], transfer)[0] as Uint8Array, width, height };
}

/** The result of a step, if its clip still exists. */
function found(result: Result): Result {
  if (result === null) throw new VeroneseError('internal', 'the clip was lost when another call failed');
  return result;
}
